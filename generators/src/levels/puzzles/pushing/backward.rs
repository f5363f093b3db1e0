//! Backward breadth-first search from all solved positions, which gives each position's distance from a solution.

use super::floor_plan::{Position, Pushing, bit, each};
use crate::levels::grid::WAYS;

/// The value of an empty entry in the hash table.
const NONE: u32 = u32::MAX;

/// The positions found, in discovery order, with their distances.
#[derive(Default)]
pub(crate) struct SearchedPositions {
    positions: Vec<Position>,
    distances: Vec<u16>,
    /// A hash table with open addressing that contains position indices. The table size is a power of two.
    slots: Vec<u32>,
    /// `true` if all reachable positions have been found.
    pub(crate) complete: bool,
}

impl SearchedPositions {
    pub(crate) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns all positions from nearest to farthest, each with its distance.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&Position, usize)> {
        self.positions
            .iter()
            .zip(&self.distances)
            .map(|(position, &distance)| (position, usize::from(distance)))
    }

    pub(crate) fn distance(&self, position: &Position) -> Option<usize> {
        let at = self.slots.get(self.slot(position)).copied().filter(|&at| at != NONE)?;
        Some(usize::from(self.distances[at as usize]))
    }

    /// Returns the hash table index of a position, or the free index where it belongs.
    fn slot(&self, position: &Position) -> usize {
        let mask = self.slots.len().wrapping_sub(1);
        let mut slot = hash(position) as usize & mask;
        while let Some(&at) = self.slots.get(slot) {
            if at == NONE || self.positions[at as usize] == *position {
                break;
            }
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn insert(&mut self, position: Position, distance: u16) {
        if self.positions.len() * 2 >= self.slots.len() {
            self.grow();
        }
        let slot = self.slot(&position);
        if self.slots[slot] == NONE {
            self.slots[slot] = self.positions.len() as u32;
            self.positions.push(position);
            self.distances.push(distance);
        }
    }

    fn grow(&mut self) {
        self.slots = vec![NONE; (self.slots.len() * 4).max(1 << 12)];
        for at in 0..self.positions.len() {
            let slot = self.slot(&self.positions[at]);
            self.slots[slot] = at as u32;
        }
    }
}

fn hash(position: &Position) -> u64 {
    let mut hash = u64::from(position.avatar);
    for cells in [position.things[0], position.things[1], position.targets[0], position.targets[1]] {
        for half in [cells as u64, (cells >> 64) as u64] {
            hash = (hash.rotate_left(23) ^ half).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        }
    }
    hash ^ hash >> 29
}

impl Pushing<'_> {
    /// Computes the minimum number of pushes needed to solve each position. Positions that differ only by a walk of the
    /// avatar count as one position, with the avatar in the first reachable cell. The search stops after about `most`
    /// positions. In this case, the farthest positions are missing.
    ///
    /// Cost: O(positions × objects), about a microsecond per position.
    pub(crate) fn by_pushes(&self, most: usize) -> SearchedPositions {
        let mut searched = SearchedPositions::default();
        for solved in self.solved() {
            let mut open = self.stands(&solved);
            while open != 0 {
                let region = self.flood(open & open.wrapping_neg(), open);
                searched.insert(Position { avatar: region.trailing_zeros() as u8, ..solved }, 0);
                open &= !region;
            }
        }
        let strides = self.strides();
        let mut at = 0;
        while let Some(&position) = searched.positions.get(at) {
            if searched.len() > most {
                return searched;
            }
            let depth = searched.distances[at].saturating_add(1);
            at += 1;
            let region = self.flood(bit(position.avatar.into()), self.stands(&position));
            let ends = self.ends(&position);
            for stride in strides {
                let beside = if stride < 0 { ends >> -stride } else { ends << stride };
                for near in each(region & beside) {
                    self.before(&position, near, stride, &mut |before| {
                        let region = self.flood(bit(before.avatar.into()), self.stands(&before));
                        searched.insert(Position { avatar: region.trailing_zeros() as u8, ..before }, depth);
                    });
                }
            }
        }
        searched.complete = true;
        searched
    }

    /// Computes the minimum number of avatar steps needed to solve each position.
    pub(crate) fn by_steps(&self, most: usize) -> SearchedPositions {
        let mut searched = SearchedPositions::default();
        for solved in self.solved() {
            for avatar in each(self.stands(&solved)) {
                searched.insert(Position { avatar: avatar as u8, ..solved }, 0);
            }
        }
        let strides = self.strides();
        let mut at = 0;
        while let Some(&position) = searched.positions.get(at) {
            if searched.len() > most {
                return searched;
            }
            let steps = searched.distances[at].saturating_add(1);
            at += 1;
            let avatar = usize::from(position.avatar);
            let stands = self.stands(&position);
            for stride in strides {
                let from = avatar.wrapping_add_signed(stride);
                if from < self.floor_plan.grid.len() && stands & bit(from) != 0 {
                    searched.insert(Position { avatar: from as u8, ..position }, steps);
                }
                self.before(&position, avatar, stride, &mut |before| searched.insert(before, steps));
            }
        }
        searched.complete = true;
        searched
    }

    /// Returns the avatar's steps that solve a position with the minimum number of pushes and a short walk before each
    /// push. `pushes` comes from [`Pushing::by_pushes`]. Returns `None` if `pushes` does not contain the position.
    pub(crate) fn solution(&self, pushes: &SearchedPositions, start: Position) -> Option<Vec<(i32, i32)>> {
        let grid = self.floor_plan.grid;
        let distance = |position: &Position| {
            let region = self.flood(bit(position.avatar.into()), self.stands(position));
            pushes.distance(&Position { avatar: region.trailing_zeros() as u8, ..*position })
        };
        let mut position = start;
        let mut left = distance(&position)?;
        let mut ways = Vec::new();
        while left > 0 {
            let avatar = usize::from(position.avatar);
            let stands = self.stands(&position);
            let steps = grid.flood(&[avatar], |cell| stands & bit(cell) != 0);
            let region = each(self.flood(bit(avatar), stands));
            let options = region.flat_map(|from| WAYS.map(|way| (from, way))).filter_map(|(from, way)| {
                let near = grid.shift(from, way).filter(|&near| position.taken() & bit(near) != 0)?;
                let stride = near as isize - from as isize;
                let after = self.step(&Position { avatar: from as u8, ..position }, stride)?;
                (distance(&after) == Some(left - 1)).then_some((from, way, after))
            });
            let (from, way, after) = options.min_by_key(|(from, ..)| steps[*from])?;
            let walk = grid.way(avatar, from, |cell| stands & bit(cell) != 0)?;
            ways.extend(walk.windows(2).map(|pair| grid.offset(pair[0], pair[1])));
            ways.push(way);
            (position, left) = (after, left - 1);
        }
        Some(ways)
    }
}
