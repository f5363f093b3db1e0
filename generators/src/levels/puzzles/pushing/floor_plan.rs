//! Floor plans for pushing puzzles, and the effects of pushes. Walls and targets are stored as sets of cells.

use super::rules::{Destination, KINDS, Rules};
use crate::levels::grid::{Grid, WAYS};

/// The maximum number of cells on a board. A set of cells is stored as the bits of one number.
pub(crate) const MAX_CELLS: usize = 128;

/// A set of cells.
pub(crate) type Cells = u128;

/// Returns a set with one cell.
pub(crate) fn bit(cell: usize) -> Cells {
    1 << cell
}

/// Returns a set's cells, in ascending order.
pub(crate) fn each(mut cells: Cells) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let cell = (cells != 0).then(|| cells.trailing_zeros() as usize)?;
        cells &= cells - 1;
        Some(cell)
    })
}

/// A floor plan with a border of walls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FloorPlan {
    pub(crate) grid: Grid,
    pub(crate) wall: Cells,
    /// The target cells, by kind.
    pub(crate) targets: [Cells; KINDS],
    /// Floor onto which objects cannot be pushed.
    pub(crate) sills: Cells,
    /// The number of objects of each kind at the start.
    pub(crate) counts: [usize; KINDS],
}

impl FloorPlan {
    /// Returns the cells with a target.
    pub(crate) fn all_targets(&self) -> Cells {
        self.targets[0] | self.targets[1]
    }
}

/// A position: the cells of the objects, the targets and the avatar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Position {
    /// The object cells, by kind.
    pub(crate) things: [Cells; KINDS],
    /// The remaining targets, by kind.
    pub(crate) targets: [Cells; KINDS],
    /// The avatar's cell, or the first cell that the avatar can reach.
    pub(crate) avatar: u8,
}

impl Position {
    /// Returns the cells with an object.
    pub(crate) fn taken(&self) -> Cells {
        self.things[0] | self.things[1]
    }

    /// Returns the cells with a target.
    pub(crate) fn all_targets(&self) -> Cells {
        self.targets[0] | self.targets[1]
    }
}

/// A floor plan with the pushing rules.
#[derive(Clone, Copy)]
pub(crate) struct Pushing<'a> {
    pub(crate) floor_plan: &'a FloorPlan,
    pub(crate) rules: &'a Rules,
}

impl Pushing<'_> {
    /// Returns the change in a cell's index for each step in [`WAYS`].
    pub(crate) fn strides(&self) -> [isize; 4] {
        WAYS.map(|(x, y)| x as isize + y as isize * self.floor_plan.grid.columns as isize)
    }

    /// Returns the cells in which the avatar can stand.
    pub(crate) fn stands(&self, position: &Position) -> Cells {
        let barred = |kind: usize| if self.rules.walkable[kind] { 0 } else { position.targets[kind] };
        self.inside() & !(self.floor_plan.wall | position.taken() | barred(0) | barred(1))
    }

    /// Returns the cells in which an object of the given kind can come to rest.
    pub(crate) fn lies(&self, kind: usize, position: &Position) -> Cells {
        let barred = |of: usize| {
            let rests = match kind == of {
                true => self.rules.destinations[kind] == Destination::Place,
                false => self.rules.crosses[kind][of],
            };
            if rests { 0 } else { position.targets[of] }
        };
        let blocked = self.floor_plan.wall | self.floor_plan.sills | position.taken();
        self.inside() & !(blocked | barred(0) | barred(1))
    }

    fn inside(&self) -> Cells {
        let cells = self.floor_plan.grid.len();
        if cells == MAX_CELLS { Cells::MAX } else { bit(cells) - 1 }
    }

    /// Returns the cells in `open` that are connected to `from`. Cost: a few operations per step on the longest path.
    pub(crate) fn flood(&self, from: Cells, open: Cells) -> Cells {
        let columns = self.floor_plan.grid.columns;
        let mut reached = from & open;
        loop {
            let next = reached << 1 | reached >> 1 | reached << columns | reached >> columns;
            let next = reached | next & open;
            if next == reached {
                return reached;
            }
            reached = next;
        }
    }

    /// Returns the solved positions, without a cell for the avatar.
    pub(crate) fn solved(&self) -> Vec<Position> {
        let mut all = vec![Position::default()];
        for (kind, destination) in self.rules.destinations.iter().enumerate() {
            let targets = self.floor_plan.targets[kind];
            let count = self.floor_plan.counts[kind];
            // The remaining things and targets.
            let ends: Vec<(Cells, Cells)> = match destination {
                Destination::Sink | Destination::Partner => vec![(0, targets)],
                // Choose the holes to fill in every possible way, or fill all holes if there are no more holes than
                // things.
                Destination::Hole => {
                    subsets(targets, count).into_iter().map(|filled| (0, targets & !filled)).collect()
                }
                Destination::Place => {
                    subsets(targets, count).into_iter().map(|things| (things, targets)).collect()
                }
            };
            let join = |position: &Position, &(things, targets): &(Cells, Cells)| {
                let mut joined = *position;
                (joined.things[kind], joined.targets[kind]) = (things, targets);
                joined
            };
            all = all.iter().flat_map(|position| ends.iter().map(move |end| join(position, end))).collect();
        }
        all
    }

    /// Returns `true` if all objects are present and none has reached its destination.
    pub(crate) fn is_start(&self, position: &Position) -> bool {
        let counted =
            |kind: usize| position.things[kind].count_ones() as usize == self.floor_plan.counts[kind];
        let has_arrived = |(kind, destination): (usize, &Destination)| {
            *destination == Destination::Place && position.things[kind] & position.targets[kind] != 0
        };
        (0..KINDS).all(counted) && !self.rules.destinations.iter().enumerate().any(has_arrived)
    }

    /// Returns `true` if there are fewer objects of the given kind than at the start.
    fn is_missing(&self, kind: usize, position: &Position) -> bool {
        (position.things[kind].count_ones() as usize) < self.floor_plan.counts[kind]
    }

    /// Returns the cells into which an object may have been pushed immediately before a position.
    pub(crate) fn ends(&self, after: &Position) -> Cells {
        let gone = |(kind, destination): (usize, &Destination)| match destination {
            _ if !self.is_missing(kind, after) => 0,
            Destination::Place => 0,
            Destination::Sink | Destination::Hole => self.floor_plan.targets[kind],
            Destination::Partner => self.lies(kind, after),
        };
        self.rules.destinations.iter().enumerate().map(gone).fold(after.taken(), |ends, more| ends | more)
    }

    /// Calls `each` with every position from which a given push leads to `after`. The push moves the avatar from `near`
    /// plus `stride` to `near`, and an object from `near` to `near` minus `stride`.
    pub(crate) fn before(
        &self,
        after: &Position,
        near: usize,
        stride: isize,
        each: &mut impl FnMut(Position),
    ) {
        let (to, far) = (near.wrapping_add_signed(-stride), near.wrapping_add_signed(stride));
        let cells = self.floor_plan.grid.len();
        if to >= cells || far >= cells {
            return;
        }
        let (to_bit, near_bit, far_bit) = (bit(to), bit(near), bit(far));
        if self.stands(after) & far_bit == 0 {
            return;
        }
        let avatar = far as u8;
        for (kind, destination) in self.rules.destinations.iter().enumerate() {
            if self.lies(kind, after) & near_bit == 0 {
                continue;
            }
            if after.things[kind] & to_bit != 0 {
                let mut things = after.things;
                things[kind] ^= to_bit | near_bit;
                each(Position { things, avatar, ..*after });
            }
            if !self.is_missing(kind, after) || after.taken() & to_bit != 0 {
                continue;
            }
            let mut things = after.things;
            things[kind] |= near_bit;
            match destination {
                Destination::Sink if after.targets[kind] & to_bit != 0 => {
                    each(Position { things, avatar, ..*after });
                }
                // The hole is open again, with neither a thing nor the avatar on it.
                Destination::Hole if self.floor_plan.targets[kind] & !after.targets[kind] & to_bit != 0 => {
                    let mut targets = after.targets;
                    targets[kind] |= to_bit;
                    each(Position { things, targets, avatar });
                }
                Destination::Partner
                    if self.lies(kind, after) & to_bit != 0 && self.is_missing(1 - kind, after) =>
                {
                    things[1 - kind] |= to_bit;
                    each(Position { things, avatar, ..*after });
                }
                _ => {}
            }
        }
    }

    /// Returns the position after a step of the avatar; `None` if the step is blocked. `position` must contain the
    /// avatar's exact cell.
    pub(crate) fn step(&self, position: &Position, stride: isize) -> Option<Position> {
        let near = usize::from(position.avatar).checked_add_signed(stride)?;
        if self.stands(position) & bit(near) != 0 {
            return Some(Position { avatar: near as u8, ..*position });
        }
        let kind = position.things.iter().position(|things| things & bit(near) != 0)?;
        let to = near.checked_add_signed(stride).filter(|&to| to < self.floor_plan.grid.len())?;
        let mut after = Position { avatar: near as u8, ..*position };
        after.things[kind] &= !bit(near);
        // The thing may have been on a target that the avatar cannot stand on.
        if self.stands(&after) & bit(near) == 0 {
            return None;
        }
        if let Some(other) = position.things.iter().position(|things| things & bit(to) != 0) {
            after.things[other] &= !bit(to);
            return self.rules.merges[kind][other].then_some(after);
        }
        let destination = self.rules.destinations[kind];
        if position.targets[kind] & bit(to) != 0 && destination != Destination::Place {
            if destination == Destination::Hole {
                after.targets[kind] &= !bit(to);
            }
            return Some(after);
        }
        let lies = self.lies(kind, &after) & bit(to) != 0;
        after.things[kind] |= bit(to);
        lies.then_some(after)
    }
}

/// Returns all subsets of `count` cells.
fn subsets(cells: Cells, count: usize) -> Vec<Cells> {
    let mut subsets = vec![0];
    for _ in 0..count {
        let larger = subsets.iter().flat_map(|&subset: &Cells| {
            // Add only cells after the last one, so that each subset is produced once.
            let after = cells & !(Cells::MAX >> subset.leading_zeros().min(127)) & !subset;
            let after = if subset == 0 { cells } else { after };
            each(after).map(move |cell| subset | bit(cell))
        });
        subsets = larger.collect();
    }
    subsets
}
