//! Sets of cells on a board and on the one-cell ring around it.

use crate::numbers::geometry::Direction;

/// A board with a ring of one cell around it, which stands for everything outside.
///
/// A position off the board counts as the nearest ring cell. A move by n cells therefore takes at most n
/// steps between the corresponding cells. A sprite that leaves the board and returns elsewhere has a path
/// along the ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Board {
    pub(super) columns: i32,
    pub(super) rows: i32,
}

impl Board {
    /// Returns the number of cells, including the ring.
    pub(super) fn size(self) -> usize {
        (self.columns as usize + 2) * (self.rows as usize + 2)
    }

    /// Returns the number of cells along the longer side of the board.
    pub(super) fn side(self) -> i32 {
        self.columns.max(self.rows)
    }

    pub(super) fn at(self, x: i32, y: i32) -> usize {
        let (x, y) = (x.clamp(-1, self.columns) + 1, y.clamp(-1, self.rows) + 1);
        y as usize * (self.columns as usize + 2) + x as usize
    }

    /// Returns a cell's column and row. In the ring, a column or row is −1 or one past the last.
    pub(super) fn place(self, cell: usize) -> (i32, i32) {
        let width = self.columns as usize + 2;
        ((cell % width) as i32 - 1, (cell / width) as i32 - 1)
    }

    /// Returns the board cell for an index in [`Level::cells`](crate::Level::cells).
    pub(super) fn of_level(self, cell: usize) -> usize {
        let columns = self.columns as usize;
        self.at((cell % columns) as i32, (cell / columns) as i32)
    }

    /// Returns a board cell's index in [`Level::cells`](crate::Level::cells).
    pub(super) fn on_level(self, cell: usize) -> usize {
        let (x, y) = self.place(cell);
        (y * self.columns + x) as usize
    }

    pub(super) fn shifted(self, cell: usize, (dx, dy): (i32, i32), times: i32) -> usize {
        let (x, y) = self.place(cell);
        self.at(x.saturating_add(dx.saturating_mul(times)), y.saturating_add(dy.saturating_mul(times)))
    }

    /// Returns the cells that are one step away from `cells`. The ring stands for everything outside, so a
    /// step from a ring cell may end in the same cell.
    pub(super) fn beside(self, cells: &Cells, step: (i32, i32)) -> Cells {
        let outside = cells.iter().filter(|&cell| self.is_ring(cell));
        Cells::of(self, cells.iter().map(|cell| self.shifted(cell, step, 1)).chain(outside))
    }

    pub(super) fn is_ring(self, cell: usize) -> bool {
        let (x, y) = self.place(cell);
        !(0..self.columns).contains(&x) || !(0..self.rows).contains(&y)
    }

    pub(super) fn ring(self) -> Cells {
        Cells::of(self, (0..self.size()).filter(|&cell| self.is_ring(cell)))
    }

    /// Returns all cells within `distance` columns and rows of `cells`. Cost: O(cells), regardless of the
    /// distance.
    pub(super) fn around(self, cells: &Cells, distance: i32) -> Cells {
        if distance == 0 {
            return cells.clone();
        }
        let (width, height) = (self.columns as usize + 2, self.rows as usize + 2);
        let mut wide = Cells::none(self);
        (0..height).for_each(|y| wide.smear(cells, (y * width, 1), width, distance));
        let mut around = Cells::none(self);
        (0..width).for_each(|x| around.smear(&wide, (x, width), height, distance));
        around
    }
}

/// A set of cells.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Cells(Vec<u64>);

impl Cells {
    pub(super) fn none(board: Board) -> Cells {
        Cells(vec![0; board.size().div_ceil(64)])
    }

    pub(super) fn all(board: Board) -> Cells {
        Cells::of(board, 0..board.size())
    }

    pub(super) fn of(board: Board, cells: impl Iterator<Item = usize>) -> Cells {
        let mut set = Cells::none(board);
        for cell in cells {
            set.insert(cell);
        }
        set
    }

    pub(super) fn contains(&self, cell: usize) -> bool {
        self.0.get(cell / 64).is_some_and(|word| word >> (cell % 64) & 1 == 1)
    }

    /// Inserts a cell. Returns `true` if it is new.
    pub(super) fn insert(&mut self, cell: usize) -> bool {
        let word = &mut self.0[cell / 64];
        let new = *word >> (cell % 64) & 1 == 0;
        *word |= 1 << (cell % 64);
        new
    }

    pub(super) fn remove(&mut self, cell: usize) -> bool {
        let had = self.contains(cell);
        self.0[cell / 64] &= !(1 << (cell % 64));
        had
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|&word| word == 0)
    }

    /// Removes every cell of `others` that is in neither of the `kept` sets.
    pub(super) fn drop_unless(&mut self, others: &Cells, kept: [&Cells; 2]) {
        for (at, word) in self.0.iter_mut().enumerate() {
            *word &= !others.0[at] | kept[0].0[at] | kept[1].0[at];
        }
    }

    pub(super) fn shared(&self, other: &Cells) -> Cells {
        Cells(self.0.iter().zip(&other.0).map(|(one, two)| one & two).collect())
    }

    /// Adds the cells of another set. Returns `true` if any of them is new.
    pub(super) fn add(&mut self, other: &Cells) -> bool {
        let mut new = false;
        for (one, two) in self.0.iter_mut().zip(&other.0) {
            new |= two & !*one != 0;
            *one |= two;
        }
        new
    }

    /// Adds the cells of a line that are at most `distance` away, along the line, from a cell in `from`. The line
    /// starts at `start`, advances by `step`, and has `length` cells.
    fn smear(&mut self, from: &Cells, (start, step): (usize, usize), length: usize, distance: i32) {
        for back in [false, true] {
            let mut left = 0;
            for at in 0..length {
                let cell = start + step * if back { length - 1 - at } else { at };
                left = if from.contains(cell) { distance.saturating_add(1) } else { left };
                if left > 0 {
                    self.insert(cell);
                    left -= 1;
                }
            }
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().enumerate().flat_map(|(at, &word)| {
            let mut rest = word;
            std::iter::from_fn(move || {
                let bit = (rest != 0).then(|| rest.trailing_zeros() as usize)?;
                rest &= rest - 1;
                Some(at * 64 + bit)
            })
        })
    }
}

/// A set of directions: the four grid directions, any off-axis direction, and no direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Directions(u8);

impl Directions {
    pub(super) const NONE: Directions = Directions(0);
    pub(super) const UP: Directions = Directions(1);
    pub(super) const LEFT: Directions = Directions(2);
    pub(super) const DOWN: Directions = Directions(4);
    pub(super) const RIGHT: Directions = Directions(8);
    /// A direction off the grid axes.
    pub(super) const ASKEW: Directions = Directions(16);
    /// No direction, for sprites that have no orientation or have not moved.
    pub(super) const UNSET: Directions = Directions(32);
    pub(super) const FOUR: Directions = Directions(15);
    /// Every direction, on or off the grid axes.
    pub(super) const ANY: Directions = Directions(31);
    /// Every direction, including no direction.
    pub(super) const ALL: Directions = Directions(63);

    pub(super) fn of(direction: Direction) -> Directions {
        match (direction.x, direction.y) {
            (0.0, 0.0) => Directions::UNSET,
            (0.0, y) if y < 0.0 => Directions::UP,
            (0.0, _) => Directions::DOWN,
            (x, 0.0) if x < 0.0 => Directions::LEFT,
            (_, 0.0) => Directions::RIGHT,
            _ => Directions::ASKEW,
        }
    }

    pub(super) fn with(self, other: Directions) -> Directions {
        Directions(self.0 | other.0)
    }

    pub(super) fn shared(self, other: Directions) -> Directions {
        Directions(self.0 & other.0)
    }

    pub(super) fn without(self, other: Directions) -> Directions {
        Directions(self.0 & !other.0)
    }

    /// Returns `true` if the two sets have a direction in common.
    pub(super) fn meets(self, other: Directions) -> bool {
        self.0 & other.0 != 0
    }

    /// Returns the opposites of the directions.
    pub(super) fn mirrored(self) -> Directions {
        let swap = |from: Directions, to: Directions| if self.meets(from) { to } else { Directions::NONE };
        let axes = swap(Directions::UP, Directions::DOWN)
            .with(swap(Directions::DOWN, Directions::UP))
            .with(swap(Directions::LEFT, Directions::RIGHT))
            .with(swap(Directions::RIGHT, Directions::LEFT));
        axes.with(Directions(self.0 & (Directions::ASKEW.0 | Directions::UNSET.0)))
    }

    /// Returns the direction of a step along an axis.
    pub(super) fn of_step((x, y): (i32, i32)) -> Directions {
        Directions::of(Direction { x: f64::from(x), y: f64::from(y) })
    }

    /// Returns the one-cell steps that a sprite moving in these directions can take, with diagonal steps
    /// last.
    pub(super) fn steps(self) -> impl Iterator<Item = (i32, i32)> {
        let straight = [
            (Directions::UP, (0, -1)),
            (Directions::LEFT, (-1, 0)),
            (Directions::DOWN, (0, 1)),
            (Directions::RIGHT, (1, 0)),
        ];
        let askew = [(-1, -1), (1, -1), (-1, 1), (1, 1)];
        let any = self.meets(Directions::ASKEW);
        let straight = straight.into_iter().filter(move |(way, _)| any || self.meets(*way));
        straight.map(|(_, step)| step).chain(askew.into_iter().filter(move |_| any))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_off_the_board_are_the_ring() {
        let board = Board { columns: 5, rows: 3 };
        assert_eq!(board.size(), 35);
        assert_eq!(board.place(board.at(2, 1)), (2, 1));
        assert_eq!(board.place(board.at(900, -7)), (5, -1));
        assert_eq!(board.place(board.shifted(board.at(1, 1), (-1, 0), i32::MAX)), (-1, 1));
        assert_eq!(board.ring().iter().count(), 35 - 15);
        // A cell two rows above the board counts as just above the board, and so does the cell one row below
        // it.
        let above = Cells::of(board, [board.at(2, -2)].into_iter());
        assert_eq!(
            board.beside(&above, (0, 1)),
            Cells::of(board, [board.at(2, -1), board.at(2, 0)].into_iter())
        );
        let mut corner = Cells::none(board);
        corner.insert(board.at(0, 0));
        assert_eq!(board.around(&corner, 1).iter().count(), 9);
        assert_eq!(board.around(&corner, 9), Cells::all(board));
    }

    #[test]
    fn directions_as_sets() {
        let directions = Directions::of(Direction::UP).with(Directions::of(Direction::LEFT));
        assert_eq!(directions.steps().collect::<Vec<_>>(), [(0, -1), (-1, 0)]);
        assert_eq!(directions.mirrored(), Directions::DOWN.with(Directions::RIGHT));
        assert_eq!(Directions::of(Direction::NIL), Directions::ASKEW);
        assert_eq!(Directions::of(Direction::NONE.reversed()), Directions::UNSET);
        assert_eq!(Directions::ASKEW.steps().count(), 8);
        assert_eq!(Directions::ALL.without(Directions::UNSET), Directions::ANY);
    }
}
