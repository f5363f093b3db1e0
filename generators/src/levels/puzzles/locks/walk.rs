//! Exhaustive search of a lock layout. The search is exact because only the avatar moves.

use super::layout::{Layout, Tile};
use crate::levels::grid::WAYS;

/// A shortest win of a layout, and statistics on the states that are one step off this win.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Walk {
    /// The steps of a shortest win, as indices into [`WAYS`].
    pub(super) ways: Vec<usize>,
    /// The number of states that are one step off the win.
    pub(super) beside: usize,
    /// The number of states in `beside` from which no win exists.
    pub(super) dead: usize,
    /// The total number of reachable states.
    pub(super) states: usize,
}

/// A state as one number: the avatar's cell, and one bit for each item taken, opened or worn out.
type Packed = u128;

/// The number of bits for the cell.
const CELL: u32 = 8;
/// The index that represents no state.
const NONE: u32 = u32::MAX;

struct Space<'a> {
    layout: &'a Layout,
    /// For each cell, the bit of its item; `None` if the cell has no item that can be taken, opened or worn out.
    bits: Vec<Option<u32>>,
    /// For each kind of key, the bits of these keys in a packed state.
    keys: [Packed; 2],
    /// The bits of doors, by kind.
    doors: [Packed; 2],
    /// The bits of goals.
    goals: Packed,
}

impl Space<'_> {
    fn of(layout: &Layout) -> Option<Space<'_>> {
        let mut space =
            Space { layout, bits: vec![None; layout.tiles.len()], keys: [0; 2], doors: [0; 2], goals: 0 };
        let mut next = CELL;
        for (cell, tile) in layout.tiles.iter().enumerate() {
            let own: Packed = 1 << next;
            match tile {
                Tile::Floor | Tile::Wall => continue,
                Tile::Key(kind) => space.keys[*kind] |= own,
                Tile::Door(kind) => space.doors[*kind] |= own,
                Tile::Goal => space.goals |= own,
                Tile::Plank => {}
            }
            space.bits[cell] = Some(next);
            next += 1;
            if next >= Packed::BITS {
                return None;
            }
        }
        (layout.tiles.len() <= 1 << CELL).then_some(space)
    }

    fn is_won(&self, state: Packed) -> bool {
        state & self.goals == self.goals
    }

    /// Returns the state after a step; `None` if the step is impossible.
    fn step(&self, state: Packed, way: usize) -> Option<Packed> {
        let cell = (state & 0xff) as usize;
        let next = self.layout.grid.shift(cell, WAYS[way])?;
        let moved = (state & !0xff) | next as Packed;
        let own = self.bits[next].map_or(0, |bit| 1 << bit);
        match self.layout.tiles[next] {
            Tile::Wall => None,
            Tile::Floor => Some(moved),
            Tile::Plank if state & own != 0 => None,
            Tile::Door(kind) if state & own == 0 => {
                let held = (state & self.keys[kind]).count_ones() - (state & self.doors[kind]).count_ones();
                // A door that opens pushes the avatar back. The avatar can enter in the next tick.
                (held > 0).then_some(state | own)
            }
            _ => Some(moved | own),
        }
    }
}

/// States by number. They are looked up by content in a hash table with open addressing, whose size is at least twice
/// the number of states.
struct Table {
    slots: Vec<u32>,
    states: Vec<Packed>,
}

impl Table {
    fn new() -> Table {
        Table { slots: vec![NONE; 1024], states: Vec::new() }
    }

    /// Returns the hash table index of a state, or the free index where it belongs.
    fn slot(&self, state: Packed) -> usize {
        let folded = (state as u64) ^ ((state >> 64) as u64).rotate_left(29);
        let mask = self.slots.len() - 1;
        let mut slot = (folded.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 20) as usize & mask;
        while self.slots[slot] != NONE && self.states[self.slots[slot] as usize] != state {
            slot = (slot + 1) & mask;
        }
        slot
    }

    /// Returns the number of a state, and `true` if the state is new.
    fn number(&mut self, state: Packed) -> (u32, bool) {
        let mut slot = self.slot(state);
        if self.slots[slot] != NONE {
            return (self.slots[slot], false);
        }
        if 2 * self.states.len() >= self.slots.len() {
            self.slots = vec![NONE; 4 * self.slots.len()];
            for number in 0..self.states.len() {
                let slot = self.slot(self.states[number]);
                self.slots[slot] = number as u32;
            }
            slot = self.slot(state);
        }
        let number = self.states.len() as u32;
        self.slots[slot] = number;
        self.states.push(state);
        (number, true)
    }
}

impl Walk {
    /// Searches up to `most` states. Returns `None` if there are more states, or if there is no win. Cost: about a
    /// tenth of a microsecond per state.
    pub(super) fn of(layout: &Layout, most: usize) -> Option<Walk> {
        let space = Space::of(layout)?;
        let mut table = Table::new();
        table.number(layout.start as Packed);
        // For each state, the states after each step, and the state from which it was first found.
        let mut after: Vec<[u32; 4]> = Vec::new();
        let mut before: Vec<u32> = vec![NONE];
        let mut won = NONE;
        let mut at = 0;
        while at < table.states.len() {
            let state = table.states[at];
            let mut own = [NONE; 4];
            if space.is_won(state) {
                won = won.min(at as u32);
            } else {
                for (way, after) in own.iter_mut().enumerate() {
                    let Some(next) = space.step(state, way) else { continue };
                    let (number, is_new) = table.number(next);
                    if is_new {
                        before.push(at as u32);
                    }
                    *after = number;
                }
                if table.states.len() > most {
                    return None;
                }
            }
            after.push(own);
            at += 1;
        }
        if won == NONE {
            return None;
        }
        let alive = alive(&space, &table.states, &after);
        let mut path = vec![won];
        while path[path.len() - 1] != 0 {
            path.push(before[path[path.len() - 1] as usize]);
        }
        path.reverse();
        let (mut ways, mut beside) = (Vec::new(), Vec::new());
        for pair in path.windows(2) {
            let own = after[pair[0] as usize];
            ways.extend(own.iter().position(|&next| next == pair[1]));
            beside.extend(own.into_iter().filter(|&next| next != NONE && !path.contains(&next)));
        }
        beside.sort_unstable();
        beside.dedup();
        let dead = beside.iter().filter(|&&state| !alive[state as usize]).count();
        Some(Walk { ways, beside: beside.len(), dead, states: table.states.len() })
    }

    /// Returns the fraction of dead ends among the states that are one step off the win.
    pub(super) fn dead_share(&self) -> f64 {
        self.dead as f64 / self.beside.max(1) as f64
    }
}

/// Returns, for each state, `true` if a win is reachable from that state.
fn alive(space: &Space<'_>, states: &[Packed], after: &[[u32; 4]]) -> Vec<bool> {
    let mut first = vec![0_u32; states.len() + 1];
    let edges =
        || after.iter().enumerate().flat_map(|(from, own)| own.iter().map(move |&to| (from as u32, to)));
    for (_, to) in edges().filter(|(_, to)| *to != NONE) {
        first[to as usize + 1] += 1;
    }
    for at in 1..first.len() {
        first[at] += first[at - 1];
    }
    let mut sources = vec![0_u32; first[states.len()] as usize];
    let mut next = first.clone();
    for (from, to) in edges().filter(|(_, to)| *to != NONE) {
        sources[next[to as usize] as usize] = from;
        next[to as usize] += 1;
    }
    let mut alive: Vec<bool> = states.iter().map(|&state| space.is_won(state)).collect();
    let mut open: Vec<usize> = (0..states.len()).filter(|&at| alive[at]).collect();
    while let Some(at) = open.pop() {
        for &from in &sources[first[at] as usize..first[at + 1] as usize] {
            if !alive[from as usize] {
                alive[from as usize] = true;
                open.push(from as usize);
            }
        }
    }
    alive
}
