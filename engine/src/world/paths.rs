//! Path finding for games with `obs=` (`spec/01` §8).

use super::{Slot, World};
use crate::numbers::geometry::Direction;
use crate::rules::Rules;
use std::sync::{Arc, OnceLock};

/// The value of a cell that paths may cross. Each cell of the board and of the ring around it has one of these values.
const OPEN: u8 = 0;
/// A cell that contains an obstacle or is off the board.
const CLOSED: u8 = u8::MAX;
/// The value that marks the cell where a path starts.
const START: u8 = u8::MAX - 1;

/// A search frontier that breaks ties like the reference's binary heap.
#[derive(Default)]
struct Heap {
    /// Pairs of cost and cell.
    items: Vec<(u32, u32)>,
}

impl Heap {
    fn push(&mut self, item: (u32, u32)) {
        let mut at = self.items.len();
        self.items.push(item);
        while at > 0 {
            let parent = (at - 1) / 2;
            if self.items[parent].0 <= item.0 {
                break;
            }
            self.items[at] = self.items[parent];
            at = parent;
        }
        self.items[at] = item;
    }

    fn pop(&mut self) -> Option<(u32, u32)> {
        let first = *self.items.first()?;
        let last = self.items.pop().expect("the queue is not empty");
        let count = self.items.len();
        if count == 0 {
            return Some(first);
        }
        let mut at = 0;
        while 2 * at + 1 < count {
            let (left, right) = (2 * at + 1, 2 * at + 2);
            let child = if right < count && self.items[left].0 > self.items[right].0 { right } else { left };
            if last.0 <= self.items[child].0 {
                break;
            }
            self.items[at] = self.items[child];
            at = child;
        }
        self.items[at] = last;
        Some(first)
    }
}

/// The paths in one level: the cells that paths avoid, which do not change during an episode, and the paths
/// requested so far. All states of the level share them, and the results do not depend on the order of
/// requests.
#[derive(Debug)]
pub(crate) struct Paths {
    /// For each cell, [`OPEN`] or [`CLOSED`].
    cells: Vec<u8>,
    /// For each direction, its number and the offset that a step adds to a cell's index, in wrapping arithmetic.
    ahead: Vec<(u8, usize)>,
    /// For each start cell, the first steps of its paths, once they have been requested. Empty for boards
    /// with too many cells.
    known: Vec<OnceLock<Box<[u8]>>>,
}

/// The maximum number of cells on a board whose paths are stored. The paths take one byte per pair of cells.
const MAX_KEPT: usize = 1 << 11;

const DIRECTIONS: [Direction; 4] = [Direction::UP, Direction::DOWN, Direction::LEFT, Direction::RIGHT];

impl Paths {
    fn first(&self, start: usize, goal: usize) -> Option<Direction> {
        let step = match self.known.get(start) {
            Some(known) => known.get_or_init(|| self.search(start, None))[goal],
            None => self.search(start, Some(goal))[goal],
        };
        DIRECTIONS.get(usize::from(step).wrapping_sub(1)).copied()
    }

    /// Returns the first step on the path to each cell, as a number above [`OPEN`]. The search stops as soon
    /// as it reaches the goal.
    fn search(&self, start: usize, goal: Option<usize>) -> Box<[u8]> {
        let mut first = self.cells.clone();
        first[start] = START;
        let mut frontier = Heap::default();
        frontier.push((0, start as u32));
        while let Some((cost, cell)) = frontier.pop() {
            let cell = cell as usize;
            let here = first[cell];
            for &(direction, ahead) in &self.ahead {
                let next = cell.wrapping_add(ahead);
                if first[next] != OPEN {
                    continue;
                }
                first[next] = if here == START { direction } else { here };
                if goal == Some(next) {
                    return first.into();
                }
                frontier.push((cost + 1, next as u32));
            }
        }
        first.into()
    }
}

impl World {
    /// Records the cells that contain an obstacle at the start. These cells remain obstacles for the whole
    /// episode. Hidden sprites are not obstacles. If the avatar has three actions, all paths in the episode
    /// lead only left and right, even if the avatar changes.
    pub(crate) fn mark_obstacles(&mut self, rules: &Rules) {
        let mut cells = vec![CLOSED; World::cell_count(self.columns, self.rows)];
        for row in 0..self.rows {
            for column in 0..self.columns {
                cells[self.cell(column + 1, row + 1)] = OPEN;
            }
        }
        for &stype in rules.obstacles.iter().filter(|stype| !rules.types[stype.index()].traits.hidden) {
            for slot in self.slots(stype) {
                let rect = self.sprite(slot).rect;
                let (column, row) = (rect.x / self.block, rect.y / self.block);
                cells[self.cell(column + 1, row + 1)] = CLOSED;
            }
        }
        let stride = (self.columns + 2) as usize;
        let mut ahead = vec![(1, stride.wrapping_neg()), (2, stride), (3, 1usize.wrapping_neg()), (4, 1)];
        if self.avatar_actions(rules) == 3 {
            ahead.drain(..2);
        }
        let kept = if cells.len() <= MAX_KEPT { cells.len() } else { 0 };
        let known = (0..kept).map(|_| OnceLock::new()).collect();
        self.paths = Some(Arc::new(Paths { cells, ahead, known }));
    }

    /// Returns the first step of the path between two pixels, or `None` if there is no path or no step to
    /// take. Also returns the amount of work counted for finding the path.
    pub(crate) fn first_step(&self, from: (i32, i32), to: (i32, i32)) -> (Option<Direction>, usize) {
        let (Some(start), Some(goal)) = (self.path_cell(from), self.path_cell(to)) else { return (None, 1) };
        let Some(paths) = self.paths.as_deref() else { return (None, 1) };
        if start == goal || paths.cells[start] == CLOSED || paths.cells[goal] == CLOSED {
            return (None, 1);
        }
        // The work counted must not depend on earlier requests.
        let share = if paths.known.is_empty() { 1 } else { 8 };
        (paths.first(start, goal), paths.cells.len() / share)
    }

    /// Returns the cell that contains a pixel; `None` for a pixel off the board. The reference multiplies by the
    /// reciprocal of the block size, which yields a lower cell for some sizes.
    fn path_cell(&self, (x, y): (i32, i32)) -> Option<usize> {
        let reciprocal = 1.0 / f64::from(self.block);
        let column = (f64::from(x) * reciprocal) as i32;
        let row = (f64::from(y) * reciprocal) as i32;
        let inside = (0..self.columns).contains(&column) && (0..self.rows).contains(&row);
        inside.then(|| self.cell(column + 1, row + 1))
    }

    /// Returns the number of the avatar's actions, excluding [`Action::Nil`](crate::Action::Nil).
    fn avatar_actions(&self, rules: &Rules) -> usize {
        let avatar: Slot = self.avatar;
        let Some(sprite) = self.sprites.get(usize::from(avatar)) else { return 0 };
        rules.types[sprite.stype.index()].class.map_or(0, |class| class.actions().len())
    }
}
