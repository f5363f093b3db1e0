//! Caves drawn by cellular automata (Johnson, Yannakakis and Togelius 2010, "Cellular automata for real-time generation
//! of infinite cave levels").

use crate::levels::grid::Grid;
use base::Sampler;

/// The number of smoothing rounds.
const ROUNDS: usize = 3;

/// Draws more and more open caves until a single region contains most of the area inside the border.
pub(super) fn cave(grid: Grid, ring: bool, sampler: &mut Sampler, wall: &mut [bool]) {
    let border: Vec<bool> = wall.to_vec();
    let inside = border.iter().filter(|&&wall| !wall).count();
    for fill in [42, 40, 38, 36, 32, 28, 20, 10] {
        let mut cells: Vec<bool> = border.iter().map(|&wall| wall || sampler.ratio(fill, 100)).collect();
        for _ in 0..ROUNDS {
            let smooth = |cell: usize| {
                // Cells off the board count as rock only if walls surround the board.
                let rock =
                    grid.around(cell).iter().filter(|next| next.map_or(ring, |next| cells[next])).count();
                rock >= 5 || (cells[cell] && rock >= 4)
            };
            let next: Vec<bool> = (0..grid.len()).map(|cell| border[cell] || smooth(cell)).collect();
            cells = next;
        }
        roughen(grid, &border, sampler, &mut cells);
        let regions = grid.regions(|cell| !cells[cell]);
        if regions.first().is_some_and(|largest| largest.len() * 100 >= inside * 55) {
            wall.copy_from_slice(&cells);
            return;
        }
    }
}

/// Adds single rocks in the widest places, so that large halls contain obstacles.
fn roughen(grid: Grid, border: &[bool], sampler: &mut Sampler, cells: &mut [bool]) {
    for cell in 0..grid.len() {
        let clear = grid.around(cell).into_iter().all(|next| next.is_some_and(|next| !cells[next]));
        if !border[cell] && clear && sampler.ratio(1, 4) {
            cells[cell] = true;
        }
    }
}
