//! States stored as differences from a base state, for searches that keep millions of states.
//!
//! Most of a state is the same in all states of a level: walls, floors and their tables. A [`Packed`] state
//! stores only the bytes that differ from the base state (usually the start of the search). Such a difference
//! takes a few hundred bytes, compared with tens of thousands for a full state.

use crate::rules::{Action, Outcome};
use crate::state::State;

/// A state, stored as its difference from a base. Only [`State::unpack_from`] with the same base can restore it.
#[derive(Clone, Debug)]
pub struct Packed {
    outcome: Outcome,
    last_action: Action,
    bytes: Box<[u8]>,
}

impl Packed {
    /// Returns the size of the packed state in bytes.
    pub fn size_in_bytes(&self) -> usize {
        size_of::<Packed>() + self.bytes.len()
    }
}

impl State {
    /// Packs this state as its difference from `base`. Cost: one comparison, O(size of a state).
    pub fn pack(&self, base: &State) -> Packed {
        let mut bytes = Vec::with_capacity(512);
        self.world.put_differences(&base.world, &mut bytes);
        self.schedule.put_differences(&base.schedule, &mut bytes);
        Packed { outcome: self.world.outcome(), last_action: self.world.last_action(), bytes: bytes.into() }
    }

    /// Restores the packed state into `self`, reusing its buffers. `base` is the state that was passed to
    /// [`State::pack`]. Cost: one copy of `base`.
    ///
    /// # Panics
    /// May panic if the state was packed against a different base.
    pub fn unpack_from(&mut self, packed: &Packed, base: &State) {
        self.clone_from(base);
        self.world.set_outcome_and_action(packed.outcome, packed.last_action);
        let mut bytes = &*packed.bytes;
        self.world.take_differences(&mut bytes);
        self.schedule.take_differences(&mut bytes);
        assert!(bytes.is_empty(), "packed against this base");
    }
}
