//! Equality of levels, and distances between them, up to symmetry.

use super::grid::Grid;
use super::palette::Palette;
use base::Digest;
use engine::analysis::Role;
use engine::{Analysis, Level};
use itertools::Itertools;

/// The number of board symmetries. Bit 0 mirrors left and right, bit 1 mirrors up and down, and bit 2 swaps columns and
/// rows.
const SYMMETRIES: usize = 8;
/// The value for cells outside the smaller of two levels. Such cells have no character.
const OUTSIDE: u8 = 0;

/// Compares a game's levels up to rotations and reflections.
///
/// Rules may distinguish directions, for example if objects fall or drive from left to right. A rotated or mirrored
/// level may therefore play differently, but it still does not count as a new level.
#[derive(Clone, Debug)]
pub struct LevelSimilarity {
    /// For each character, the first character that places the same sprites.
    class: [u8; 128],
    /// For each character, the index of the set of sprites that it places. The index does not depend on which
    /// characters the game uses.
    rank: [u8; 128],
    /// For each character, the weight of a cell in which two levels differ.
    weight: [u32; 128],
    /// For each character, `true` if it shapes the board, as walls do.
    structure: [bool; 128],
}

impl LevelSimilarity {
    /// Creates a comparator for the levels of a game. Cost: O(characters²).
    pub fn of(analysis: &Analysis) -> LevelSimilarity {
        let palette = Palette::of(analysis);
        let places = |symbol: u8| {
            let mut types = analysis.game().places(symbol).to_vec();
            types.sort_unstable();
            types
        };
        let symbols: [u8; 128] = std::array::from_fn(|symbol| symbol as u8);
        let is_ground = |symbol: u8| {
            let known = palette.as_ref().is_some_and(|palette| palette.base == symbol);
            known || places(symbol).iter().all(|&stype| analysis.role(stype) == Role::Floor)
        };
        let structure = symbols.map(|symbol| {
            let known = palette.as_ref().is_some_and(|palette| palette.wall == Some(symbol));
            let shapes = |role| matches!(role, Role::Wall | Role::Breakable | Role::Soil);
            known || places(symbol).iter().any(|&stype| shapes(analysis.role(stype)))
        });
        // Spaces and characters that place nothing are equal to each other, but differ from cells outside a level.
        let class = symbols.map(|symbol| {
            let same = (b' '..=symbol).find(|&other| places(other) == places(symbol));
            same.unwrap_or(symbol)
        });
        let mut placements = symbols.map(places);
        let ranked = placements.clone();
        placements.sort_unstable();
        let mut placements = placements.to_vec();
        placements.dedup();
        let rank = symbols
            .map(|symbol| placements.partition_point(|placed| *placed < ranked[usize::from(symbol)]) as u8);
        let weight = symbols.map(|symbol| match () {
            () if symbol == OUTSIDE || structure[usize::from(symbol)] => 1,
            () if is_ground(symbol) => 0,
            () => 2,
        });
        LevelSimilarity { class, rank, weight, structure }
    }

    /// Returns a digest that is the same for two levels exactly if the levels are equal up to the eight board
    /// symmetries and the choice among characters that place the same sprites. The levels may belong to different games
    /// that differ only in names and characters. Cost: O(cells).
    pub fn digest(&self, level: &Level) -> Digest {
        let (grid, mut cells) = self.classes(level);
        cells.iter_mut().for_each(|cell| *cell = self.rank[usize::from(*cell)]);
        let image = |symmetry| {
            let (grid, cells) = image(grid, &cells, symmetry);
            let sides = [grid.columns as u32, grid.rows as u32].map(u32::to_le_bytes);
            [sides.as_flattened(), &cells].concat()
        };
        let canonical = (0..SYMMETRIES).map(image).min().expect("a level has images");
        Digest::of(&canonical)
    }

    /// Returns the distance between two levels, from 0.0 for equal levels (up to symmetry) to 1.0 for levels that agree
    /// only in their ground. The distance is the minimum over the symmetries of
    ///
    /// ```text
    ///   Σ weight of the cells that differ  /  Σ weight of all cells
    /// ```
    ///
    /// with both levels aligned at the top left. The weight of a cell is 0 if it is ground in both levels, or the same
    /// border wall in both. The weight is 1 if the cell is wall, soil or ground in both levels, or lies outside one
    /// level. Any other cell has weight 2. Two mostly empty levels are therefore similar only if their few objects are
    /// similar. The distance is symmetric in its arguments. Cost: O(cells).
    pub fn distance(&self, one: &Level, two: &Level) -> f64 {
        let (one, two) = (self.classes(one), self.classes(two));
        let turned = |fixed: &(Grid, Vec<u8>), (grid, cells): &(Grid, Vec<u8>)| {
            let distances = (0..SYMMETRIES).map(|at| self.share(fixed, &image(*grid, cells, at)));
            distances.fold(1.0, f64::min)
        };
        // Images of a level that is not square may have swapped sides, so both directions are compared.
        turned(&one, &two).min(turned(&two, &one))
    }

    /// Returns the similarity of a level to its left-right or up-down mirror image, which is 1.0 minus their distance
    /// without further symmetries. Cost: O(cells).
    pub(super) fn mirror(&self, level: &Level, symmetry: Mirror) -> f64 {
        let (grid, cells) = self.classes(level);
        1.0 - self.share(&(grid, cells.clone()), &image(grid, &cells, symmetry as usize))
    }

    fn classes(&self, level: &Level) -> (Grid, Vec<u8>) {
        let cells = level.cells().iter().map(|&symbol| self.class[usize::from(symbol)]).collect();
        (Grid { columns: level.columns(), rows: level.rows() }, cells)
    }

    /// Returns the weighted fraction of cells that differ.
    fn share(&self, (grid, one): &(Grid, Vec<u8>), (other_grid, two): &(Grid, Vec<u8>)) -> f64 {
        let (columns, rows) = (grid.columns.max(other_grid.columns), grid.rows.max(other_grid.rows));
        let at = |grid: &Grid, cells: &[u8], x: usize, y: usize| match x < grid.columns && y < grid.rows {
            true => (cells[grid.at(x, y)], grid.on_border(grid.at(x, y))),
            false => (OUTSIDE, false),
        };
        let (mut differing, mut all) = (0, 0);
        for (y, x) in (0..rows).cartesian_product(0..columns) {
            let ((one, one_border), (two, two_border)) = (at(grid, one, x, y), at(other_grid, two, x, y));
            if one == two
                && (one == OUTSIDE || (one_border && two_border && self.structure[usize::from(one)]))
            {
                continue;
            }
            let weight = self.weight[usize::from(one)].max(self.weight[usize::from(two)]);
            all += weight;
            differing += if one == two { 0 } else { weight };
        }
        if all == 0 { 0.0 } else { f64::from(differing) / f64::from(all) }
    }
}

/// A mirroring of a level for comparison with the original.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mirror {
    LeftRight = 1,
    UpDown = 2,
}

/// Applies a symmetry to a board.
fn image(grid: Grid, cells: &[u8], symmetry: usize) -> (Grid, Vec<u8>) {
    let swaps = symmetry & 4 != 0;
    let image = if swaps { Grid { columns: grid.rows, rows: grid.columns } } else { grid };
    let source = |cell: usize| {
        let (x, y) = (image.x(cell), image.y(cell));
        let (x, y) = if swaps { (y, x) } else { (x, y) };
        let x = if symmetry & 1 != 0 { grid.columns - 1 - x } else { x };
        let y = if symmetry & 2 != 0 { grid.rows - 1 - y } else { y };
        cells[grid.at(x, y)]
    };
    (image, (0..image.len()).map(source).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_eight_images_differ() {
        let grid = Grid { columns: 3, rows: 2 };
        let mut images: Vec<(usize, Vec<u8>)> = (0..SYMMETRIES)
            .map(|symmetry| image(grid, b"abcdef", symmetry))
            .map(|(grid, cells)| (grid.columns, cells))
            .collect();
        images.sort();
        images.dedup();
        assert_eq!(images.len(), SYMMETRIES);
        assert!(images.contains(&(2, b"daebfc".to_vec())));
    }
}
