//! Board symmetries.

use crate::levels::grid::Grid;
use base::Sampler;

/// A board symmetry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mirror {
    None,
    Sides,
    Ends,
    Turn,
}

impl Mirror {
    pub(crate) fn draw(sampler: &mut Sampler) -> Mirror {
        *sampler.choose(&[
            Mirror::None,
            Mirror::Sides,
            Mirror::Sides,
            Mirror::Ends,
            Mirror::Turn,
            Mirror::Turn,
        ])
    }

    /// Returns the symmetry of the walls.
    pub(crate) fn of_walls(grid: Grid, wall: &[bool]) -> Mirror {
        let kept = |mirror: &Mirror| (0..grid.len()).all(|cell| wall[cell] == wall[mirror.of(grid, cell)]);
        [Mirror::Sides, Mirror::Turn, Mirror::Ends].into_iter().find(kept).unwrap_or(Mirror::None)
    }

    /// Returns a cell's mirror image.
    pub(crate) fn of(self, grid: Grid, cell: usize) -> usize {
        let (x, y) = (grid.x(cell), grid.y(cell));
        let (other_x, other_y) = (grid.columns - 1 - x, grid.rows - 1 - y);
        match self {
            Mirror::None => cell,
            Mirror::Sides => grid.at(other_x, y),
            Mirror::Ends => grid.at(x, other_y),
            Mirror::Turn => grid.at(other_x, other_y),
        }
    }
}
