//! Mazes whose corridors are dug depth-first on every second cell. Some of the dead ends are opened.

use crate::levels::grid::{Grid, WAYS};
use base::Sampler;

/// Draws a maze. On a board of even width or height, the last column or row becomes part of the
/// border.
pub(super) fn maze(grid: Grid, ring: bool, loops: f64, sampler: &mut Sampler, wall: &mut [bool]) {
    let first = usize::from(ring);
    let node = |cell: usize| {
        let (x, y) = (grid.x(cell), grid.y(cell));
        (x + first) % 2 == 0 && (y + first) % 2 == 0 && !(ring && grid.on_border(cell))
    };
    wall.fill(true);
    let start = grid.at(first, first);
    wall[start] = false;
    let mut trail = vec![start];
    while let Some(&cell) = trail.last() {
        let options: Vec<(usize, usize)> = WAYS
            .iter()
            .filter_map(|&way| {
                let between = grid.shift(cell, way)?;
                let next = grid.shift(between, way)?;
                (node(next) && wall[next]).then_some((between, next))
            })
            .collect();
        if options.is_empty() {
            trail.pop();
            continue;
        }
        let (between, next) = *sampler.choose(&options);
        wall[between] = false;
        wall[next] = false;
        trail.push(next);
    }
    open_dead_ends(grid, ring, 0.15 + 0.5 * loops, sampler, wall);
}

/// Opens a wall at a fraction of the dead ends.
fn open_dead_ends(grid: Grid, ring: bool, share: f64, sampler: &mut Sampler, wall: &mut [bool]) {
    for cell in 0..grid.len() {
        let exits = grid.beside(cell).filter(|&next| !wall[next]).count();
        if wall[cell] || exits != 1 || sampler.unit() >= share {
            continue;
        }
        let through = |way: &(i32, i32)| {
            let between = grid.shift(cell, *way)?;
            let next = grid.shift(between, *way)?;
            let inner = !(ring && grid.on_border(between));
            (inner && wall[between] && !wall[next]).then_some(between)
        };
        let options: Vec<usize> = WAYS.iter().filter_map(through).collect();
        if !options.is_empty() {
            wall[*sampler.choose(&options)] = false;
        }
    }
}
