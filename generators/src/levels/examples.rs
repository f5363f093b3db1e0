//! What a game's own levels are like, so that new ones can be like them: sizes, numbers, where things stand, how walls run.

use super::grid::Grid;
use super::layout::Patterns;
use super::palette::Palette;
use engine::analysis::Role;
use engine::{Analysis, Game, Level, Sampler, SpriteType};

/// Parts into which a board is divided each way for [`Stance`].
const BANDS: usize = 5;
/// The weight of a cell to which nothing speaks for or against; see [`Stance::weigh`].
pub(crate) const USUAL: u32 = 16;

/// What a game's own levels are like.
#[derive(Clone, Debug, PartialEq)]
pub struct Examples {
    boards: Vec<Sketch>,
    /// By type: where it stands.
    stances: Vec<Stance>,
    /// How walls run.
    patterns: Patterns,
    /// The border is wall.
    closed: bool,
}

/// One example in numbers.
#[derive(Clone, Debug, PartialEq)]
struct Sketch {
    columns: usize,
    rows: usize,
    /// Share of all cells with more than floor.
    cover: f64,
    /// Share of the cells inside the border that are wall.
    walls: f64,
    /// By type: how many sprites.
    counts: Vec<usize>,
}

/// Where sprites of a type stand, as shares of their number in bands of the board.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Stance {
    seen: usize,
    across: [usize; BANDS],
    down: [usize; BANDS],
    /// How many of them stand on the border of a closed board.
    on_border: usize,
}

/// What one new level is to be like: something between two examples.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    pub(crate) grid: Grid,
    /// Share of the cells inside the border that are wall.
    pub(crate) walls: f64,
    /// By type: how many sprites, with the fewest and the most of all examples.
    pub(crate) counts: Vec<(usize, usize, usize)>,
}

impl Examples {
    /// Looks at a game's own levels. None if there are none, or if the game has no character to start with.
    ///
    /// Cost: one analysis, and O(cells) for each level.
    pub fn of(game: &Game, levels: &[Level]) -> Option<Examples> {
        let analysis = Analysis::of(game);
        let palette = Palette::of(&analysis)?;
        if levels.is_empty() {
            return None;
        }
        let mut stances = vec![Stance::default(); game.sprite_types().count()];
        let mut patterns = Patterns::default();
        let mut boards = Vec::new();
        let (mut edge, mut edge_walls) = (0, 0);
        for level in levels {
            let grid = Grid { columns: level.columns(), rows: level.rows() };
            let wall: Vec<bool> =
                level.cells().iter().map(|&symbol| is_wall(&analysis, &palette, symbol)).collect();
            patterns.learn(grid, &wall);
            let border = || (0..grid.len()).filter(|&cell| grid.on_border(cell));
            let walls_there = border().filter(|&cell| wall[cell]).count();
            let closed = walls_there * 10 >= border().count() * 8;
            edge += border().count();
            edge_walls += walls_there;
            let mut counts = vec![0; stances.len()];
            for (cell, &symbol) in level.cells().iter().enumerate() {
                for &stype in game.places(symbol) {
                    counts[stype.index()] += 1;
                    stances[stype.index()].see(grid, cell, closed);
                }
            }
            let inner = || (0..grid.len()).filter(|&cell| !grid.on_border(cell));
            boards.push(Sketch {
                columns: grid.columns,
                rows: grid.rows,
                cover: cover(&analysis, level),
                walls: inner().filter(|&cell| wall[cell]).count() as f64 / inner().count().max(1) as f64,
                counts,
            });
        }
        let closed = palette.wall.is_some() && edge_walls * 10 >= edge * 8;
        Some(Examples { boards, stances, patterns, closed })
    }

    /// Columns, from and to.
    pub fn columns(&self) -> (usize, usize) {
        range(self.boards.iter().map(|board| board.columns))
    }

    /// Rows, from and to.
    pub fn rows(&self) -> (usize, usize) {
        range(self.boards.iter().map(|board| board.rows))
    }

    /// The share of cells that hold more than floor, from and to.
    pub fn cover(&self) -> (f64, f64) {
        let covers = self.boards.iter().map(|board| board.cover);
        covers
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), cover| (low.min(cover), high.max(cover)))
    }

    /// The share of the cells inside the border that are wall, from and to.
    pub fn walls(&self) -> (f64, f64) {
        let walls = self.boards.iter().map(|board| board.walls);
        walls.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), walls| (low.min(walls), high.max(walls)))
    }

    /// Sprites of a type in a level: the fewest, the median, the most.
    pub fn count(&self, stype: SpriteType) -> (usize, usize, usize) {
        let mut counts: Vec<usize> = self.boards.iter().map(|board| board.counts[stype.index()]).collect();
        counts.sort_unstable();
        (counts[0], counts[counts.len() / 2], counts[counts.len() - 1])
    }

    /// Whether the border is wall.
    pub(crate) fn is_closed(&self) -> bool {
        self.closed
    }

    pub(crate) fn stance(&self, stype: SpriteType) -> &Stance {
        &self.stances[stype.index()]
    }

    pub(crate) fn patterns(&self) -> &Patterns {
        &self.patterns
    }

    /// Draws what a level of the given size, or of a size between those of two examples, is to be like.
    pub(crate) fn draw(
        &self,
        columns: (usize, usize),
        rows: (usize, usize),
        sampler: &mut Sampler,
    ) -> Target {
        let (one, two) = (sampler.choose(&self.boards), sampler.choose(&self.boards));
        let share = sampler.unit();
        let between = |from: f64, to: f64| from + (to - from) * share;
        let nearest = |from: usize, to: usize| (between(from as f64, to as f64) + 0.5) as usize;
        let grid = Grid {
            columns: nearest(one.columns, two.columns).clamp(columns.0, columns.1),
            rows: nearest(one.rows, two.rows).clamp(rows.0, rows.1),
        };
        let own = between((one.columns * one.rows) as f64, (two.columns * two.rows) as f64);
        // A board of another size than the examples holds more or less, in proportion; but not fewer than one.
        let scale = if own > 0.0 { grid.len() as f64 / own } else { 1.0 };
        let scale = if (0.8..=1.25).contains(&scale) { 1.0 } else { scale };
        let scaled = |count: usize| (count as f64 * scale + 0.5) as usize;
        let counts = (0..self.stances.len()).map(|at| {
            let count = nearest(one.counts[at], two.counts[at]);
            let (least, _, most) = self.count(SpriteType(at as u16));
            let drawn = scaled(count).max(usize::from(count > 0));
            (drawn, scaled(least), scaled(most).max(drawn))
        });
        Target { grid, walls: between(one.walls, two.walls), counts: counts.collect() }
    }
}

impl Stance {
    fn see(&mut self, grid: Grid, cell: usize, closed: bool) {
        self.seen += 1;
        self.across[band(grid.x(cell), grid.columns)] += 1;
        self.down[band(grid.y(cell), grid.rows)] += 1;
        self.on_border += usize::from(closed && grid.on_border(cell));
    }

    /// How well a cell agrees with where the examples have such sprites; [`USUAL`] on the mean. Never 0: examples are few.
    pub(crate) fn weigh(&self, grid: Grid, cell: usize) -> u32 {
        if self.seen == 0 {
            return USUAL;
        }
        let share = |counts: &[usize; BANDS], at: usize| {
            (counts[at] as f64 + 0.3) * BANDS as f64 / (self.seen as f64 + 0.3 * BANDS as f64)
        };
        let across = share(&self.across, band(grid.x(cell), grid.columns));
        let down = share(&self.down, band(grid.y(cell), grid.rows));
        ((f64::from(USUAL) * across * down) as u32).max(1)
    }

    /// Whether such sprites are let into the walls around the board.
    pub(crate) fn is_on_border(&self) -> bool {
        self.on_border * 2 > self.seen
    }
}

fn band(at: usize, of: usize) -> usize {
    (at * BANDS / of.max(1)).min(BANDS - 1)
}

fn range(values: impl Iterator<Item = usize> + Clone) -> (usize, usize) {
    (values.clone().min().unwrap_or(0), values.max().unwrap_or(0))
}

/// The share of a level's cells that hold more than floor. Cost: O(cells).
pub fn cover(analysis: &Analysis, level: &Level) -> f64 {
    let covered = level.cells().iter().filter(|&&symbol| is_cover(analysis, symbol)).count();
    covered as f64 / level.cells().len().max(1) as f64
}

/// Whether a character places more than floor.
pub(crate) fn is_cover(analysis: &Analysis, symbol: u8) -> bool {
    analysis.game().places(symbol).iter().any(|&stype| analysis.role(stype) != Role::Floor)
}

fn is_wall(analysis: &Analysis, palette: &Palette, symbol: u8) -> bool {
    let wall = |stype: &SpriteType| {
        analysis.role(*stype) == Role::Wall
            || palette.wall == palette.symbol(*stype) && palette.wall.is_some()
    };
    analysis.game().places(symbol).iter().any(wall)
}
