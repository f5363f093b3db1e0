//! Cheapest paths on a board.

use engine::Action;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The four directions in the order of preference among equals.
pub(super) const DIRECTIONS: [(Action, (isize, isize)); 4] =
    [(Action::Up, (0, -1)), (Action::Left, (-1, 0)), (Action::Down, (0, 1)), (Action::Right, (1, 0))];

#[derive(Clone, Copy, Debug)]
pub(super) struct Board {
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Board {
    /// Returns the neighbour of a cell in a direction, or `None` at the edge.
    pub(super) fn beside(self, cell: usize, way: (isize, isize)) -> Option<usize> {
        let column =
            (cell % self.columns).checked_add_signed(way.0).filter(|&column| column < self.columns)?;
        let row = (cell / self.columns).checked_add_signed(way.1).filter(|&row| row < self.rows)?;
        Some(row * self.columns + column)
    }
}

/// The cheapest paths from one cell to all others.
#[derive(Debug)]
pub(super) struct Routes(Vec<Option<(u32, Action)>>);

impl Routes {
    /// Computes the paths. `enter` returns the cost of entering a cell in a direction, or `None` if it cannot be entered.
    /// `passes` returns `false` for a cell that can be entered but not passed. Cost: O(cells log cells).
    pub(super) fn from(
        board: Board,
        start: usize,
        actions: &[Action],
        enter: impl Fn(usize, (isize, isize)) -> Option<u32>,
        passes: impl Fn(usize) -> bool,
    ) -> Routes {
        let mut best: Vec<Option<(u32, Action)>> = vec![None; board.columns * board.rows];
        let mut queue = BinaryHeap::from([Reverse((0, 0_u32, start, Action::Nil))]);
        let mut number = 0;
        let mut done = vec![false; best.len()];
        while let Some(Reverse((cost, _, cell, first))) = queue.pop() {
            if std::mem::replace(&mut done[cell], true) {
                continue;
            }
            if cell != start {
                best[cell] = Some((cost, first));
                if !passes(cell) {
                    continue;
                }
            }
            for (action, way) in DIRECTIONS.into_iter().filter(|(action, _)| actions.contains(action)) {
                let Some(next) = board.beside(cell, way).filter(|&next| !done[next]) else { continue };
                let Some(step_cost) = enter(next, way) else { continue };
                number += 1;
                let first = if cell == start { action } else { first };
                queue.push(Reverse((cost + step_cost, number, next, first)));
            }
        }
        Routes(best)
    }

    /// Returns the cost of a cell and the first step towards it.
    pub(super) fn to(&self, cell: usize) -> Option<(u32, Action)> {
        self.0[cell]
    }
}
