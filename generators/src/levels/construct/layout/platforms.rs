//! Ledges for avatars that fall, walk and jump.

use crate::levels::grid::Grid;
use base::Sampler;

/// The number of rows from one ledge up to the next.
const RISE: usize = 3;

/// Draws ledges of three to seven cells in every third row, from the floor up, with gaps between them. Every storey has
/// at least one gap through which the avatar can climb.
pub(super) fn platforms(grid: Grid, ring: bool, sampler: &mut Sampler, wall: &mut [bool]) {
    let edge = usize::from(ring);
    let (left, right) = (edge, grid.columns - edge);
    let floor = grid.rows - 1;
    for x in 0..grid.columns {
        wall[grid.at(x, floor)] = true;
    }
    let mut y = floor;
    while y > edge + RISE {
        y -= RISE;
        let mut x = left + sampler.below(3);
        while x < right {
            let end = (x + sampler.between(3, 7)).min(right);
            for x in x..end {
                wall[grid.at(x, y)] = true;
            }
            x = end + sampler.between(2, 4);
        }
        // There must be at least one way up.
        let gap = sampler.between(left, right - 1);
        for x in gap..(gap + 2).min(right) {
            wall[grid.at(x, y)] = false;
        }
    }
}
