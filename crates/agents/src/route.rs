//! Cheapest paths on a board.

use engine::{Action, Observation};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The four directions, in the order in which ties are broken.
pub const DIRECTIONS: [(Action, (isize, isize)); 4] =
    [(Action::Up, (0, -1)), (Action::Left, (-1, 0)), (Action::Down, (0, 1)), (Action::Right, (1, 0))];

/// Returns the columns and rows by which a key moves the avatar, or `None` if the key has no direction.
pub fn way(action: Action) -> Option<(isize, isize)> {
    DIRECTIONS.into_iter().find(|(known, _)| *known == action).map(|(_, way)| way)
}

/// A board's size. Cells are numbered row by row.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// The number of columns.
    pub columns: usize,
    /// The number of rows.
    pub rows: usize,
}

impl Board {
    /// Returns the board of an observation.
    pub fn of(seen: &Observation) -> Board {
        Board { columns: seen.columns, rows: seen.rows }
    }

    /// Returns the cell next to a cell in one direction, or `None` at the edge.
    pub fn beside(self, cell: usize, (right, down): (isize, isize)) -> Option<usize> {
        let column =
            (cell % self.columns).checked_add_signed(right).filter(|&column| column < self.columns)?;
        let row = (cell / self.columns).checked_add_signed(down).filter(|&row| row < self.rows)?;
        Some(row * self.columns + column)
    }

    /// Returns the cells next to a cell.
    pub fn around(self, cell: usize) -> impl Iterator<Item = usize> {
        DIRECTIONS.into_iter().filter_map(move |(_, way)| self.beside(cell, way))
    }
}

/// The cheapest paths from one cell to all other cells.
#[derive(Debug)]
pub struct Routes(Vec<Option<(u32, Action)>>);

impl Routes {
    /// Computes the cheapest paths with the given keys. `enter` returns the cost of entering a cell in a given
    /// direction, or `None` if the cell cannot be entered. `passes` returns `false` for a cell that can be entered
    /// but not crossed. Cost: O(cells log cells).
    pub fn from(
        board: Board,
        start: usize,
        keys: &[Action],
        enter: impl Fn(usize, (isize, isize)) -> Option<u32>,
        passes: impl Fn(usize) -> bool,
    ) -> Routes {
        let mut best: Vec<Option<(u32, Action)>> = vec![None; board.columns * board.rows];
        let mut done = vec![false; best.len()];
        let mut queue = BinaryHeap::from([Reverse((0, 0_u32, start, Action::Nil))]);
        let mut number = 0;
        while let Some(Reverse((so_far, _, cell, first))) = queue.pop() {
            if std::mem::replace(&mut done[cell], true) {
                continue;
            }
            if cell != start {
                best[cell] = Some((so_far, first));
                if !passes(cell) {
                    continue;
                }
            }
            for (action, way) in DIRECTIONS.into_iter().filter(|(action, _)| keys.contains(action)) {
                let Some(next) = board.beside(cell, way).filter(|&next| !done[next]) else { continue };
                let Some(step) = enter(next, way) else { continue };
                number += 1;
                queue.push(Reverse((
                    so_far + step,
                    number,
                    next,
                    if cell == start { action } else { first },
                )));
            }
        }
        Routes(best)
    }

    /// Returns the cost of reaching a cell and the first step towards it, or `None` if there is no path.
    pub fn to(&self, cell: usize) -> Option<(u32, Action)> {
        self.0[cell]
    }
}
