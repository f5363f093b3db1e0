//! Placement of sprites for crossings. The avatar starts at the bottom, its goal is at the top, and traffic runs
//! between them in lanes from edge to edge.

use crate::levels::construct::builder::{Builder, way};
use crate::levels::construct::plan;
use crate::levels::grid::Grid;
use crate::levels::palette::Palette;
use engine::analysis::{EffectSummary, Motion, Role};
use engine::{Analysis, SpriteType};

/// A row's use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// A row of walls.
    Border,
    /// Safe ground without traffic.
    Verge,
    /// A lane for sprites of the given type.
    Lane(SpriteType),
}

/// The sprites that drive across the board.
#[derive(Clone, Debug)]
pub(crate) struct Traffic {
    pub(crate) types: Vec<SpriteType>,
    /// `true` if the traffic wraps around to the other side; `false` if it turns at the walls.
    pub(crate) wraps: bool,
}

/// Returns the enemies that drive left or right, if their traffic makes the game a crossing. That is the case if the
/// enemies wrap around to the other side. It is also the case in a game with an exit if the enemies turn at walls and
/// drive in both directions.
pub(crate) fn traffic(analysis: &Analysis, palette: &Palette) -> Option<Traffic> {
    let enemies = plan::furnishable(analysis, palette, Role::Enemy);
    let sideways = |stype: &SpriteType| match analysis.facts(*stype).motion {
        Motion::Straight(direction) => way(direction).map(|(x, _)| x).filter(|&x| x != 0),
        _ => None,
    };
    let returns = |stype: &SpriteType| {
        let wraps =
            analysis.at_edge(*stype).any(|encounter| encounter.does(|effect| *effect == EffectSummary::Wrap));
        wraps && sideways(stype).is_some()
    };
    let wrapping: Vec<SpriteType> = enemies.iter().copied().filter(returns).collect();
    if !wrapping.is_empty() {
        return Some(Traffic { types: wrapping, wraps: true });
    }
    let types: Vec<SpriteType> = enemies.into_iter().filter(|stype| sideways(stype).is_some()).collect();
    let goes = |x: i32| types.iter().any(|stype| sideways(stype) == Some(x));
    let exit = !plan::furnishable(analysis, palette, Role::Exit).is_empty();
    (goes(-1) && goes(1) && exit).then_some(Traffic { types, wraps: false })
}

impl Builder<'_> {
    /// Draws the use of each row: lanes in groups of one to three, between verges (rows without traffic).
    pub(crate) fn rows(&mut self, grid: Grid, ring: bool, traffic: &Traffic) -> Vec<Row> {
        let edge = usize::from(ring);
        let (first, last) = (edge, grid.rows - 1 - edge);
        let mut rows = vec![Row::Border; grid.rows];
        rows[first..=last].fill(Row::Verge);
        let mut at = first + 1;
        let longest = 1 + plan::round(1.0 + 1.2 * self.difficulty(), &mut self.sampler);
        let mut types: Vec<SpriteType> = traffic.types.clone();
        self.sampler.shuffle(&mut types);
        let mut next = 0;
        while at < last {
            let group = self.sampler.between(1, longest.max(2)).min(last - at);
            for row in &mut rows[at..at + group] {
                *row = Row::Lane(types[next % types.len()]);
                next += 1;
            }
            at += group + 1;
        }
        rows
    }

    /// Returns the walls at the top and the bottom of the board, at the sides of verges (rows without traffic), and at
    /// the sides of lanes in which traffic turns.
    pub(crate) fn lane_walls(grid: Grid, rows: &[Row], ring: bool, traffic: &Traffic) -> Vec<bool> {
        let side = |cell: usize| grid.x(cell) == 0 || grid.x(cell) + 1 == grid.columns;
        let wall = |cell: usize| match rows[grid.y(cell)] {
            Row::Border => true,
            Row::Verge => ring && side(cell),
            Row::Lane(_) => ring && side(cell) && !traffic.wraps,
        };
        (0..grid.len()).map(wall).collect()
    }

    /// Fills the rows of a crossing with sprites.
    pub(crate) fn crossing(&mut self, rows: &[Row], traffic: &Traffic) {
        let grid = self.board.grid;
        let verges: Vec<usize> = (0..grid.rows).filter(|&row| rows[row] == Row::Verge).collect();
        let (top, bottom) = (verges[0], verges[verges.len() - 1]);
        let (left, right) = (grid.columns / 4, grid.columns - 1 - grid.columns / 4);
        let start = grid.at(self.sampler.between(left, right), bottom);
        self.put_avatar(start);
        let in_row = |row: usize| (0..grid.columns).map(move |x| grid.at(x, row));
        for exit in plan::furnishable(self.analysis, self.palette, Role::Exit) {
            // Prefer exits that are not straight ahead of the start.
            self.put_where(exit, |builder, cell| {
                let aside = grid.x(cell).abs_diff(grid.x(builder.board.start)) as u32;
                if in_row(top).any(|other| other == cell) { 1 + aside * aside } else { 0 }
            });
        }
        for (row, kind) in rows.iter().enumerate() {
            if let Row::Lane(stype) = *kind {
                self.drive(row, stype);
            }
        }
        // Other sprites are placed on verges (rows without traffic), and collectables also in lanes. Other traffic is
        // omitted.
        let lanes: Vec<usize> =
            (0..grid.len()).filter(|&cell| matches!(rows[grid.y(cell)], Row::Lane(_))).collect();
        for &cell in &lanes {
            self.board.kept[cell] = true;
        }
        self.keys(&[]);
        let wishes = self.wishes();
        let others =
            wishes.into_iter().filter(|wish| !traffic.types.contains(&wish.stype) && wish.role != Role::Exit);
        let (goods, rest): (Vec<_>, Vec<_>) = others.partition(|wish| wish.role == Role::Collectable);
        for wish in rest {
            self.fulfil(wish);
        }
        self.soil();
        for &cell in &lanes {
            self.board.kept[cell] = false;
        }
        for wish in goods {
            self.fulfil(wish);
        }
    }

    /// Places vehicles of one type along a lane, with gaps of at least two cells, but not next to the avatar's start.
    fn drive(&mut self, row: usize, stype: SpriteType) {
        let grid = self.board.grid;
        let least = 3 + plan::round(3.0 * (1.0 - self.difficulty()), &mut self.sampler);
        let mut x = self.sampler.below(least);
        while x < grid.columns {
            let cell = grid.at(x, row);
            if self.fits(cell, stype) && grid.manhattan(cell, self.board.start) >= 2 {
                self.put(cell, stype);
            }
            x += least + self.sampler.below(4);
        }
    }
}
