//! Statistics of a game's own levels, which new levels should resemble in size, in the number and placement of sprites,
//! and in the structure of walls.

use super::grid::Grid;
use super::palette::Palette;
use super::placement::{NOOKS, Placement, Scene, nook};
use crate::levels::construct::layout::Patterns;
use base::Sampler;
use engine::analysis::{Motion, Role};
use engine::{Analysis, Game, Level, SpriteType};

/// Statistics of a game's own levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Examples {
    boards: Vec<Sketch>,
    /// The placement of each type.
    placements: Vec<Placement>,
    /// The structure of the walls.
    pub(crate) patterns: Patterns,
    /// `true` if the border consists of walls.
    pub(crate) closed: bool,
    /// The number of examples with left-right symmetric walls.
    mirrored: usize,
    /// The character of empty cells; `None` if it is the character that the rules suggest.
    pub(crate) base: Option<u8>,
    /// The number of open cells, by the arrangement of surrounding walls; see [`nook`].
    pub(crate) nooks: [usize; NOOKS],
    /// The visible types that have no meaning in the rules.
    decor: Vec<SpriteType>,
}

/// The statistics of one example.
#[derive(Clone, Debug, PartialEq)]
struct Sketch {
    columns: usize,
    rows: usize,
    /// The fraction of cells that contain more than floor.
    cover: f64,
    /// The fraction of the cells inside the border that are walls.
    walls: f64,
    /// The number of sprites per type.
    counts: Vec<usize>,
    /// The number of sprites per type in [`Examples::decor`].
    decor: Vec<usize>,
}

/// The desired properties of one new level, interpolated between two examples.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    pub(crate) grid: Grid,
    /// The example whose placement of sprites the level should follow.
    pub(crate) model: usize,
    /// The fraction of the cells inside the border that should be walls.
    pub(crate) walls: f64,
    /// For each type, the desired number of sprites, and the minimum, median and maximum over all examples.
    pub(crate) counts: Vec<(usize, [usize; 3])>,
    /// The types without meaning in the rules, and the number of sprites of each.
    pub(crate) decor: Vec<(SpriteType, usize)>,
}

impl Examples {
    /// Analyses a game's own levels. Returns `None` if there are no levels, or if no level character in the game
    /// places exactly one avatar.
    ///
    /// Cost: one analysis, O(types × cells) per level, and a few milliseconds for the wall structure.
    pub fn of(game: &Game, levels: &[Level]) -> Option<Examples> {
        let analysis = Analysis::of(game);
        let mut palette = Palette::of(&analysis)?;
        let known = levels.iter().any(|level| level.cells().contains(&palette.base));
        let base = if known { None } else { commonest(&analysis, levels) };
        if let Some(base) = base {
            palette = Palette::on(&analysis, base)?;
        }
        let decor = decor(&analysis, &palette, levels);
        let mut examples = Examples {
            boards: Vec::new(),
            placements: vec![Placement::default(); game.sprite_types().count()],
            patterns: Patterns::default(),
            closed: false,
            mirrored: 0,
            base,
            nooks: [0; NOOKS],
            decor: decor.iter().map(|(_, stype)| *stype).collect(),
        };
        let closed = levels.iter().filter(|level| examples.add(&analysis, &palette, &decor, level)).count();
        examples.closed = 2 * closed > levels.len();
        examples.patterns.conclude();
        let cells: usize = levels.iter().map(|level| level.cells().len()).sum();
        let boards = &examples.boards;
        let total = |stype: SpriteType| boards.iter().map(|board| board.counts[stype.index()]).sum::<usize>();
        for placement in &mut examples.placements {
            placement.conclude(cells, &total, |stype| {
                let still = analysis.facts(stype).motion == Motion::Still;
                let plain = matches!(analysis.role(stype), Role::Wall | Role::Floor);
                !still || plain || palette.ground.contains(&stype)
            });
        }
        (!levels.is_empty()).then_some(examples)
    }

    /// Analyses one level. Returns `true` if the level's border consists of walls, except for a few cells.
    fn add(
        &mut self,
        analysis: &Analysis,
        palette: &Palette,
        decor: &[(u8, SpriteType)],
        level: &Level,
    ) -> bool {
        let game = analysis.game();
        let grid = Grid { columns: level.columns(), rows: level.rows() };
        let cells = level.cells();
        let wall: Vec<bool> = cells.iter().map(|&symbol| is_wall(analysis, palette, symbol)).collect();
        let border = || (0..grid.len()).filter(|&cell| grid.on_border(cell));
        let closed = palette.wall.is_some()
            && border().filter(|&cell| wall[cell]).count() * 10 >= border().count() * 8;
        // A thing that is set into the wall around a board does not count as a hole in it.
        let let_in = |cell: usize| closed && grid.on_border(cell) && cells[cell] != palette.base;
        let whole: Vec<bool> = (0..grid.len()).map(|cell| wall[cell] || let_in(cell)).collect();
        self.patterns.learn(grid, &whole);
        for cell in (0..grid.len()).filter(|&cell| !wall[cell]) {
            self.nooks[nook(grid, &wall, cell)] += 1;
        }
        let scene = Scene { grid, wall: &wall, closed, game, cells };
        for stype in game.sprite_types() {
            self.placements[stype.index()].see(&scene, stype);
        }
        let turned = |cell: usize| grid.at(grid.columns - 1 - grid.x(cell), grid.y(cell));
        let alike = (0..grid.len()).filter(|&cell| wall[cell] == wall[turned(cell)]).count();
        self.mirrored += usize::from(alike * 20 >= grid.len() * 19);
        let mut counts = vec![0; self.placements.len()];
        for &stype in cells.iter().flat_map(|&symbol| game.places(symbol)) {
            counts[stype.index()] += 1;
        }
        let number = |symbol: u8| cells.iter().filter(|&&other| other == symbol).count();
        let inner = || (0..grid.len()).filter(|&cell| !grid.on_border(cell));
        self.boards.push(Sketch {
            columns: grid.columns,
            rows: grid.rows,
            cover: cover(analysis, level),
            walls: inner().filter(|&cell| wall[cell]).count() as f64 / inner().count().max(1) as f64,
            counts,
            decor: decor.iter().map(|&(symbol, _)| number(symbol)).collect(),
        });
        closed
    }

    /// Returns the minimum and maximum number of columns.
    pub fn columns(&self) -> (usize, usize) {
        range(self.boards.iter().map(|board| board.columns))
    }

    /// Returns the minimum and maximum number of rows.
    pub fn rows(&self) -> (usize, usize) {
        range(self.boards.iter().map(|board| board.rows))
    }

    /// Returns the minimum and maximum fraction of cells that contain more than floor.
    pub fn cover(&self) -> (f64, f64) {
        let covers = self.boards.iter().map(|board| board.cover);
        covers
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), cover| (low.min(cover), high.max(cover)))
    }

    /// Returns the minimum and maximum fraction of the cells inside the border that are walls.
    pub fn walls(&self) -> (f64, f64) {
        let walls = self.boards.iter().map(|board| board.walls);
        walls.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), walls| (low.min(walls), high.max(walls)))
    }

    /// Returns the minimum, median and maximum number of a type's sprites per level.
    pub fn count(&self, stype: SpriteType) -> (usize, usize, usize) {
        let mut counts: Vec<usize> = self.boards.iter().map(|board| board.counts[stype.index()]).collect();
        counts.sort_unstable();
        (counts[0], counts[counts.len() / 2], counts[counts.len() - 1])
    }

    /// Returns `true` if the average position of sprites of type `one` is lower on the board than that of type `two`,
    /// by at least a third of the board's height. Also returns `true` if either type does not occur.
    pub(crate) fn is_below(&self, one: SpriteType, two: SpriteType) -> bool {
        match (self.placement(one).height(), self.placement(two).height()) {
            (Some(one), Some(two)) => one > two + 1.0 / 3.0,
            _ => true,
        }
    }

    /// Decides at random whether to mirror the walls from left to right, with the probability found in the examples.
    pub(crate) fn draw_mirrored(&self, sampler: &mut Sampler) -> bool {
        sampler.ratio(self.mirrored, self.boards.len())
    }

    pub(crate) fn placement(&self, stype: SpriteType) -> &Placement {
        &self.placements[stype.index()]
    }

    /// Draws the target for a level of the given size, or of a size between two examples.
    pub(crate) fn draw(
        &self,
        columns: (usize, usize),
        rows: (usize, usize),
        sampler: &mut Sampler,
    ) -> Target {
        let (model, other) = (sampler.below(self.boards.len()), sampler.below(self.boards.len()));
        let (one, two) = (&self.boards[model], &self.boards[other]);
        let share = sampler.unit();
        let between = |from: f64, to: f64| from + (to - from) * share;
        let nearest = |from: usize, to: usize| (between(from as f64, to as f64) + 0.5) as usize;
        let grid = Grid {
            columns: nearest(one.columns, two.columns).clamp(columns.0, columns.1),
            rows: nearest(one.rows, two.rows).clamp(rows.0, rows.1),
        };
        let own = between((one.columns * one.rows) as f64, (two.columns * two.rows) as f64);
        // A board larger or smaller than the examples gets proportionally more or fewer sprites, but at least one.
        let scale = if own > 0.0 { grid.len() as f64 / own } else { 1.0 };
        let scale = if (0.8..=1.25).contains(&scale) { 1.0 } else { scale };
        let scaled = |count: usize| (count as f64 * scale + 0.5) as usize;
        let counts = (0..self.placements.len()).map(|at| {
            let count = nearest(one.counts[at], two.counts[at]);
            let (least, usual, most) = self.count(SpriteType(at as u16));
            let drawn = scaled(count).max(usize::from(count > 0));
            (drawn, [scaled(least), scaled(usual), scaled(most).max(drawn)])
        });
        let decor = self.decor.iter().enumerate();
        let decor = decor.map(|(at, &stype)| (stype, scaled(nearest(one.decor[at], two.decor[at]))));
        Target {
            grid,
            model: if share < 0.5 { model } else { other },
            walls: between(one.walls, two.walls),
            counts: counts.collect(),
            decor: decor.collect(),
        }
    }
}

fn range(values: impl Iterator<Item = usize> + Clone) -> (usize, usize) {
    (values.clone().min().unwrap_or(0), values.max().unwrap_or(0))
}

/// Returns the most common character that the avatar can walk over without any effect.
fn commonest(analysis: &Analysis, levels: &[Level]) -> Option<u8> {
    let mut counts = [0usize; 128];
    for &symbol in levels.iter().flat_map(|level| level.cells()) {
        counts[usize::from(symbol) % 128] += 1;
    }
    let suits = |symbol: &u8| Palette::is_bearable(analysis, *symbol);
    let symbols = (b' '..=b'~').filter(|symbol| counts[usize::from(*symbol)] > 0).filter(suits);
    symbols.max_by_key(|&symbol| (counts[usize::from(symbol)], std::cmp::Reverse(symbol)))
}

/// Returns the characters that place only visible floor, each with the rarest of its types. The character for the empty
/// cell is excluded.
fn decor(analysis: &Analysis, palette: &Palette, levels: &[Level]) -> Vec<(u8, SpriteType)> {
    let game = analysis.game();
    let seen = |symbol: &u8| levels.iter().any(|level| level.cells().contains(symbol));
    let symbols = (b'!'..=b'~').filter(|&symbol| symbol != palette.base).filter(seen);
    let decor = symbols.filter_map(|symbol| {
        let places = game.places(symbol);
        let plain = places
            .iter()
            .all(|&stype| analysis.role(stype) == Role::Floor && !palette.ground.contains(&stype));
        let rarity = |stype: &&SpriteType| analysis.facts(**stype).symbols.len();
        let stype = *places.iter().min_by_key(rarity)?;
        (plain && !analysis.facts(stype).hidden).then_some((symbol, stype))
    });
    decor.collect()
}

/// Returns the fraction of a level's cells that contain more than floor. Cost: O(cells).
pub fn cover(analysis: &Analysis, level: &Level) -> f64 {
    let covered = level.cells().iter().filter(|&&symbol| is_cover(analysis, symbol)).count();
    covered as f64 / level.cells().len().max(1) as f64
}

/// Returns `true` if a character places more than floor.
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
