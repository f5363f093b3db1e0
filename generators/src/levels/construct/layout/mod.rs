//! The layout of walls: families of connected layouts, drawn from a sampler.

mod arena;
mod cave;
mod density;
mod learnt;
mod maze;
mod mirror;
mod platforms;
mod rooms;

pub(crate) use density::adjust;
pub(crate) use learnt::Patterns;

use crate::levels::grid::Grid;
use base::Sampler;

/// A way to lay out walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    /// Only the border consists of walls.
    Field,
    /// Open ground with a few short walls, often symmetric.
    Arena,
    /// Single blocks in a loose grid.
    Pillars,
    /// Rooms with one door in each wall between them, or two in a few walls.
    Rooms,
    /// A cave made by cellular automata.
    Cave,
    /// Ledges to stand on, one above the other.
    Platforms,
    /// Corridors of width 1 with a few loops, for boards of at least 7 by 7 cells.
    Maze,
}

/// Draws walls. If `ring` is `true`, the border consists of walls. `loops` is the amount of alternative routes, from
/// 0.0 to 1.0. All cells without walls are connected.
pub(crate) fn walls(family: Family, grid: Grid, ring: bool, loops: f64, sampler: &mut Sampler) -> Vec<bool> {
    let mut wall: Vec<bool> = (0..grid.len()).map(|cell| ring && grid.on_border(cell)).collect();
    match family {
        Family::Field => {}
        Family::Arena => arena::pieces(grid, ring, sampler, &mut wall),
        Family::Pillars => arena::pillars(grid, ring, sampler, &mut wall),
        Family::Rooms => rooms::rooms(grid, ring, loops, sampler, &mut wall),
        Family::Cave => cave::cave(grid, ring, sampler, &mut wall),
        Family::Platforms => platforms::platforms(grid, ring, sampler, &mut wall),
        Family::Maze => maze::maze(grid, ring, loops, sampler, &mut wall),
    }
    keep_largest(grid, &mut wall);
    wall
}

/// Draws walls assembled from learnt windows; `None` if that fails. All cells without walls are connected.
pub(crate) fn learnt(patterns: &Patterns, grid: Grid, sampler: &mut Sampler) -> Option<Vec<bool>> {
    let mut wall = patterns.assemble(grid, sampler)?;
    join(grid, &mut wall);
    keep_largest(grid, &mut wall);
    Some(wall)
}

/// Makes the right half of a board the reflection of the left half. All cells without walls are connected.
pub(crate) fn mirror(grid: Grid, wall: &mut [bool]) {
    for cell in 0..grid.len() {
        let twin = grid.at(grid.columns - 1 - grid.x(cell), grid.y(cell));
        if grid.x(twin) > grid.x(cell) {
            wall[twin] = wall[cell];
        }
    }
    join(grid, wall);
    keep_largest(grid, wall);
}

/// The minimum number of cells of a region to connect. Smaller regions are filled.
const ROOM: usize = 4;

/// Opens the shortest path through the walls from the largest region to every other region that is large enough.
fn join(grid: Grid, wall: &mut [bool]) {
    for region in grid.regions(|cell| !wall[cell]).into_iter().skip(1) {
        let main = grid.regions(|cell| !wall[cell]).swap_remove(0);
        if region.len() < ROOM || main.contains(&region[0]) {
            continue;
        }
        let inside = |cell: usize| !grid.on_border(cell) || !wall[cell];
        let steps = grid.flood(&region, inside);
        let Some(&nearest) = main.iter().min_by_key(|&&cell| (steps[cell], cell)) else { continue };
        let Some(way) = grid.way(nearest, region[0], inside) else { continue };
        // The path continues inside the region, where no wall needs opening.
        for cell in way {
            wall[cell] = false;
            if region.contains(&cell) {
                break;
            }
        }
    }
}

/// Fills every open region except the largest.
fn keep_largest(grid: Grid, wall: &mut [bool]) {
    for region in grid.regions(|cell| !wall[cell]).into_iter().skip(1) {
        for cell in region {
            wall[cell] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    #[test]
    fn open_cells_are_connected_and_many() {
        let families = [
            Family::Field,
            Family::Arena,
            Family::Pillars,
            Family::Rooms,
            Family::Cave,
            Family::Platforms,
            Family::Maze,
        ];
        for (family, index) in families.into_iter().zip(0..) {
            for seed in 0..60 {
                let mut sampler =
                    Seed::from_text("layout").child("family", index).child("seed", seed).sampler();
                let least = if family == Family::Maze { 7 } else { 4 };
                let grid = Grid { columns: sampler.between(least, 20), rows: sampler.between(least, 14) };
                let ring = sampler.ratio(2, 3);
                let wall = walls(family, grid, ring, 0.3, &mut sampler);
                assert_eq!(grid.regions(|cell| !wall[cell]).len(), 1, "{family:?} {grid:?}");
                let inner = if ring { (grid.columns - 2) * (grid.rows - 2) } else { grid.len() };
                let open = wall.iter().filter(|&&wall| !wall).count();
                assert!(open * 10 >= inner * 3, "{family:?} {grid:?} {open} of {inner}");
                let border = (0..grid.len()).filter(|&cell| grid.on_border(cell));
                assert!(!ring || border.into_iter().all(|cell| wall[cell]), "{family:?} {grid:?}");
            }
        }
    }
}
