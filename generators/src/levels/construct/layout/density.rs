//! Adjustment of the number of walls without a change to their structure.

use super::mirror::Mirror;
use crate::levels::grid::Grid;
use base::Sampler;

/// Thickens walls, or erodes them at their ends, until they make up about `share` of the area inside the border.
/// Regions stay connected, and symmetries are preserved. Cost: O(cells) per changed cell in the worst case.
pub(crate) fn adjust(grid: Grid, share: f64, sampler: &mut Sampler, wall: &mut [bool]) {
    let inner: Vec<usize> = (0..grid.len()).filter(|&cell| !grid.on_border(cell)).collect();
    let wanted = (share * inner.len() as f64 + 0.5) as usize;
    let mirror = Mirror::of_walls(grid, wall);
    let has = |wall: &[bool]| inner.iter().filter(|&&cell| wall[cell]).count();
    let mut now = has(wall);
    let grow = now < wanted;
    // The result misses the target by at most the one or two cells of a symmetric pair, whether walls grow or shrink.
    while if grow { now < wanted } else { now > wanted } {
        let walls =
            |cell: usize| grid.around(cell).into_iter().filter(|next| next.is_none_or(|next| wall[next]));
        let beside = |cell: usize| grid.beside(cell).filter(|&next| wall[next]).count();
        let weight = |cell: usize| -> u32 {
            if wall[cell] == grow {
                0
            } else if grow {
                // Nooks are filled first, then cells along existing walls.
                match (beside(cell), walls(cell).count()) {
                    (3.., _) => 60,
                    (2, 5..) => 30,
                    (1.., _) => 4,
                    _ => 0,
                }
            } else {
                match beside(cell) {
                    0 => 4,
                    1 => 30,
                    2 => 3,
                    _ => 1,
                }
            }
        };
        let weights: Vec<u32> = inner.iter().map(|&cell| weight(cell)).collect();
        // A change that would cut off cells is excluded, and a different change is drawn.
        let mut weights = weights;
        let changed = loop {
            let Some(at) = sampler.weighted(&weights) else { return };
            let pair = [inner[at], mirror.of(grid, inner[at])];
            let mut tried = wall.to_vec();
            let cuts = pair.iter().any(|&cell| {
                let cut = grow && !tried[cell] && grid.is_cut(cell, |next| !tried[next]);
                tried[cell] = grow;
                cut
            });
            let joined = grow
                || pair
                    .iter()
                    .any(|&cell| grid.beside(cell).any(|next| !tried[next] && !pair.contains(&next)));
            if !cuts && joined {
                break tried;
            }
            weights[at] = 0;
        };
        wall.copy_from_slice(&changed);
        now = has(wall);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Family, walls};
    use super::*;
    use base::Seed;

    #[test]
    fn shares_are_met_and_cells_stay_connected() {
        for seed in 0..40 {
            let mut sampler = Seed::from_text("density").child("seed", seed).sampler();
            let grid = Grid { columns: sampler.between(8, 20), rows: sampler.between(7, 14) };
            let family = *sampler.choose(&[Family::Arena, Family::Rooms, Family::Cave, Family::Pillars]);
            let mut wall = walls(family, grid, true, 0.3, &mut sampler);
            let share = 0.05 + 0.4 * sampler.unit();
            adjust(grid, share, &mut sampler, &mut wall);
            assert_eq!(grid.regions(|cell| !wall[cell]).len(), 1);
            let inner = (grid.columns - 2) * (grid.rows - 2);
            let found = (0..grid.len()).filter(|&cell| !grid.on_border(cell) && wall[cell]).count();
            assert!(
                (found as f64 - share * inner as f64).abs() <= 2.5,
                "{family:?} {found} of {inner}, {share}"
            );
        }
    }
}
