//! Furnishing a crossing: the avatar starts at the bottom, its aim lies at the top, and in between lanes of traffic run
//! from edge to edge.

use super::builder::{Builder, way};
use super::grid::Grid;
use super::plan;
use engine::analysis::{Deed, Motion, Role};
use engine::{Analysis, SpriteType};

/// What a row is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// Wall.
    Border,
    /// Nothing drives here.
    Verge,
    /// Sprites of this type drive here.
    Lane(SpriteType),
}

/// The types that drive from edge to edge: they go left or right, harm, and come in again at the other side.
pub(crate) fn traffic(analysis: &Analysis, palette: &super::palette::Palette) -> Vec<SpriteType> {
    let enemies = plan::furnishable(analysis, palette, Role::Enemy).into_iter();
    let drives = |stype: &SpriteType| {
        let sideways = match analysis.facts(*stype).motion {
            Motion::Straight(direction) => way(direction).is_some_and(|(x, _)| x != 0),
            _ => false,
        };
        let returns = analysis.at_edge(*stype).any(|encounter| encounter.does(|deed| *deed == Deed::Wrap));
        sideways && returns
    };
    enemies.filter(drives).collect()
}

impl Builder<'_> {
    /// Draws what each row is for: lanes in groups of one to three between verges.
    pub(crate) fn rows(&mut self, grid: Grid, ring: bool, traffic: &[SpriteType]) -> Vec<Row> {
        let edge = usize::from(ring);
        let (first, last) = (edge, grid.rows - 1 - edge);
        let mut rows = vec![Row::Border; grid.rows];
        rows[first..=last].fill(Row::Verge);
        let mut at = first + 1;
        let longest = 1 + plan::round(1.0 + 1.2 * self.difficulty(), &mut self.sampler);
        let mut types: Vec<SpriteType> = traffic.to_vec();
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

    /// Walls only above and below the lanes, where nothing drives through them; `closed`: at the sides of verges too.
    pub(crate) fn lane_walls(grid: Grid, rows: &[Row], ring: bool) -> Vec<bool> {
        let wall = |cell: usize| match rows[grid.y(cell)] {
            Row::Border => true,
            Row::Verge => ring && (grid.x(cell) == 0 || grid.x(cell) + 1 == grid.columns),
            Row::Lane(_) => false,
        };
        (0..grid.len()).map(wall).collect()
    }

    /// Furnishes the rows.
    pub(crate) fn crossing(&mut self, rows: &[Row]) {
        let grid = self.board.grid;
        let verges: Vec<usize> = (0..grid.rows).filter(|&row| rows[row] == Row::Verge).collect();
        let (top, bottom) = (verges[0], verges[verges.len() - 1]);
        let (left, right) = (grid.columns / 4, grid.columns - 1 - grid.columns / 4);
        let start = grid.at(self.sampler.between(left, right), bottom);
        self.put_avatar(start);
        let in_row = |row: usize| (0..grid.columns).map(move |x| grid.at(x, row));
        for exit in plan::furnishable(self.analysis, self.palette, Role::Exit) {
            // Rather not straight ahead.
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
        // The other things lie on verges and, where they are small gains, on lanes; other traffic is left out.
        let lanes: Vec<usize> =
            (0..grid.len()).filter(|&cell| matches!(rows[grid.y(cell)], Row::Lane(_))).collect();
        for &cell in &lanes {
            self.board.kept[cell] = true;
        }
        let done: Vec<SpriteType> = traffic(self.analysis, self.palette);
        let (area, difficulty) = (self.board.area(), self.difficulty());
        let wishes = plan::wishes(self.analysis, self.palette, area, difficulty, &mut self.sampler);
        let others = wishes.into_iter().filter(|wish| !done.contains(&wish.stype) && wish.role != Role::Exit);
        let (goods, rest): (Vec<_>, Vec<_>) = others.partition(|wish| wish.role == Role::Collectable);
        for wish in rest {
            self.fulfil(wish);
        }
        for &cell in &lanes {
            self.board.kept[cell] = false;
        }
        for wish in goods {
            self.fulfil(wish);
        }
    }

    /// Vehicles of one type along a lane, with gaps of at least two cells, none in the avatar's column just before it.
    fn drive(&mut self, row: usize, stype: SpriteType) {
        let grid = self.board.grid;
        let least = 3 + plan::round(3.0 * (1.0 - self.difficulty()), &mut self.sampler);
        let mut x = self.sampler.below(least);
        while x < grid.columns {
            let cell = grid.at(x, row);
            if self.board.is_free(cell) && grid.manhattan(cell, self.board.start) >= 2 {
                self.put(cell, stype);
            }
            x += least + self.sampler.below(4);
        }
    }
}
