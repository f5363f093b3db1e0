//! States stored as differences from another state, for searches that keep millions of them.
//!
//! Most of a state is the same in all states of a level: walls, floors and their tables. A [`Packed`] state stores only
//! the bytes in which it differs from a base, usually the start of the search: some hundred bytes instead of tens of
//! thousands.

use crate::rules::{Action, Outcome};
use crate::state::State;

/// A state, stored as the difference from a base. It can only be restored by [`State::unpack_from`] with the same base.
#[derive(Clone, Debug)]
pub struct Packed {
    outcome: Outcome,
    last_action: Action,
    bytes: Box<[u8]>,
}

impl Packed {
    /// The size in bytes.
    pub fn size_in_bytes(&self) -> usize {
        size_of::<Packed>() + self.bytes.len()
    }
}

impl State {
    /// Packs this state as the difference from `base`. Cost: that of comparing the two, O(size of a state).
    pub fn pack(&self, base: &State) -> Packed {
        let mut bytes = Vec::with_capacity(512);
        self.world.put_differences(&base.world, &mut bytes);
        self.schedule.put_differences(&base.schedule, &mut bytes);
        Packed { outcome: self.world.outcome(), last_action: self.world.last_action(), bytes: bytes.into() }
    }

    /// Makes this state the packed one again; keeps the buffers. `base` is the state that it was packed against. Cost:
    /// that of a copy of `base`.
    ///
    /// # Panics
    /// May panic if the state was packed against another base.
    pub fn unpack_from(&mut self, packed: &Packed, base: &State) {
        self.clone_from(base);
        self.world.set_outcome_and_action(packed.outcome, packed.last_action);
        let mut bytes = &*packed.bytes;
        self.world.take_differences(&mut bytes);
        self.schedule.take_differences(&mut bytes);
        assert!(bytes.is_empty(), "packed against this base");
    }
}
