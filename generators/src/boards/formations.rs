//! Formations, which are groups of pieces that look deliberately arranged.

use crate::levels::grid::Grid;
use base::Sampler;

/// The number of attempts to place a formation.
const DRAWS: usize = 24;

/// The arrangement of a group of equal pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Formation {
    /// A row in which each member is displaced by this offset from the previous one.
    Row(i32, i32),
    /// A block of two columns, filled row by row.
    Block,
    /// A zigzag, along a column if `true` and along a row otherwise.
    Zigzag(bool),
    /// A ring around a cell. The four sides are filled first, then the corners.
    Ring,
    /// Members as far from each other as possible.
    Spread,
}

/// The formations with their weights.
const FORMATIONS: [(Formation, u32); 11] = [
    (Formation::Row(1, 0), 4),
    (Formation::Row(0, 1), 4),
    (Formation::Row(2, 0), 4),
    (Formation::Row(0, 2), 4),
    (Formation::Row(1, 1), 2),
    (Formation::Row(1, -1), 2),
    (Formation::Block, 4),
    (Formation::Zigzag(false), 2),
    (Formation::Zigzag(true), 2),
    (Formation::Ring, 2),
    (Formation::Spread, 7),
];

impl Formation {
    fn draw(sampler: &mut Sampler) -> Formation {
        let weights = FORMATIONS.map(|(_, weight)| weight);
        FORMATIONS[sampler.weighted(&weights).expect("the weights are positive")].0
    }

    /// Returns the offset from the group's first member to the member with the given index.
    fn offset(self, at: usize) -> (i32, i32) {
        const AROUND: [(i32, i32); 8] =
            [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)];
        let step = at as i32;
        match self {
            Formation::Row(dx, dy) => (step * dx, step * dy),
            Formation::Block | Formation::Spread => (step % 2, step / 2),
            Formation::Zigzag(false) => (step, step % 2),
            Formation::Zigzag(true) => (step % 2, step),
            Formation::Ring => AROUND[at % AROUND.len()],
        }
    }
}

/// Draws cells for a group of `count` members. The weights determine where members may be, and how suitable each
/// cell is. Returns fewer cells if there is no room for all members.
pub(crate) fn arrange(grid: Grid, count: usize, weights: &[u32], sampler: &mut Sampler) -> Vec<usize> {
    let formation = Formation::draw(sampler);
    if formation == Formation::Spread || count < 2 {
        return spread(grid, count, weights, sampler);
    }
    let mut best: (u64, Vec<usize>) = (0, Vec::new());
    for _ in 0..DRAWS {
        let Some(anchor) = sampler.weighted(weights) else { return Vec::new() };
        let mut cells: Vec<usize> = Vec::new();
        for at in 0..count.min(8) {
            let cell = grid.shift(anchor, formation.offset(at));
            cells.extend(cell.filter(|&cell| weights[cell] > 0 && !cells.contains(&cell)));
        }
        let value = cells.iter().map(|&cell| u64::from(weights[cell].min(16))).sum::<u64>();
        let value = value + 100 * cells.len() as u64;
        if value > best.0 {
            best = (value, cells);
        }
    }
    // Members that do not fit into the formation stand close to it.
    let mut cells = best.1;
    while cells.len() < count {
        let room = (0..grid.len()).filter(|cell| weights[*cell] > 0 && !cells.contains(cell));
        let apart = |cell: &usize| cells.iter().map(|&other| grid.manhattan(*cell, other)).min();
        let Some(next) = room.min_by_key(apart) else { break };
        cells.push(next);
    }
    cells
}

/// Draws `count` cells that are far from each other.
fn spread(grid: Grid, count: usize, weights: &[u32], sampler: &mut Sampler) -> Vec<usize> {
    let mut cells: Vec<usize> = sampler.weighted(weights).into_iter().collect();
    while !cells.is_empty() && cells.len() < count {
        let mut next: Option<(usize, usize)> = None;
        for _ in 0..6 {
            let Some(cell) = sampler.weighted(weights).filter(|cell| !cells.contains(cell)) else { continue };
            let apart = cells.iter().map(|&other| grid.manhattan(cell, other)).min().unwrap_or(0);
            if next.is_none_or(|(most, _)| apart > most) {
                next = Some((apart, cell));
            }
        }
        match next {
            Some((_, cell)) => cells.push(cell),
            None => break,
        }
    }
    cells
}

/// Draws a patch of up to `count` connected cells, or a straight band of cells from wall to wall.
pub(crate) fn patch(
    grid: Grid,
    count: usize,
    free: impl Fn(usize) -> bool,
    sampler: &mut Sampler,
) -> Vec<usize> {
    let room: Vec<usize> = (0..grid.len()).filter(|&cell| free(cell)).collect();
    if room.is_empty() {
        return Vec::new();
    }
    let start = *sampler.choose(&room);
    if sampler.ratio(1, 2) {
        let ways = if sampler.ratio(1, 2) { [(0, -1), (0, 1)] } else { [(-1, 0), (1, 0)] };
        let mut band = vec![start];
        for way in ways {
            let mut at = start;
            while let Some(next) = grid.shift(at, way).filter(|&next| free(next)) {
                band.push(next);
                at = next;
            }
        }
        if band.len() >= 3 && band.len() <= count {
            return band;
        }
    }
    let mut cells = vec![start];
    while cells.len() < count {
        let beside = |cell: usize, cells: &[usize]| {
            grid.beside(cell).filter(|next| cells.contains(next)).count() as u32
        };
        // Preferring cells with two neighbours in the patch keeps it round.
        let weights: Vec<u32> = room
            .iter()
            .map(
                |&cell| {
                    if cells.contains(&cell) { 0 } else { [0, 2, 9, 16, 16][beside(cell, &cells) as usize] }
                },
            )
            .collect();
        let Some(at) = sampler.weighted(&weights) else { break };
        cells.push(room[at]);
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    #[test]
    fn groups_stay_where_they_may() {
        let grid = Grid { columns: 12, rows: 9 };
        let weights: Vec<u32> = (0..grid.len()).map(|cell| u32::from(!grid.on_border(cell))).collect();
        for at in 0..50 {
            let sampler = &mut Seed::from_text("groups").child("draw", at).sampler();
            let mut cells = arrange(grid, 4, &weights, sampler);
            assert_eq!(cells.len(), 4);
            assert!(cells.iter().all(|&cell| weights[cell] > 0));
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 4, "no cell twice");
            let patch = patch(grid, 6, |cell| weights[cell] > 0, sampler);
            assert!((1..=6).contains(&patch.len()));
            assert!(patch.iter().all(|&cell| weights[cell] > 0));
        }
    }
}
