//! Systematic search: from states with a deterministic future it proves that a level can be won in some number of ticks, or
//! not at all. Elsewhere it searches the future of one random state, as if the player foresaw all chance, and proves nothing.
//!
//! States are told apart by [`engine::analysis::StateAbstraction`], stored as differences from the start ([`engine::Packed`]),
//! and counted in forward-model calls. A search stops at the first win, after all reachable states, or at its limits:
//! only the second case proves that there is no win.

mod a_star;
mod best_first;
mod memory;
mod pushes;
mod tree;

pub use a_star::a_star;
pub(crate) use a_star::a_star_until;
pub use best_first::best_first;
pub(crate) use best_first::best_first_until;
pub use memory::{TooLittle, bound as bound_memory};
pub use pushes::Pushes;

use engine::Action;
use serde::{Deserialize, Serialize};

/// The limits of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SearchLimits {
    /// Forward-model calls.
    pub calls: u64,
    /// Bytes of memory for states, keys and the tree.
    pub bytes: usize,
}

impl SearchLimits {
    /// Limits of `calls` calls and one gibibyte.
    pub fn calls(calls: u64) -> SearchLimits {
        SearchLimits { calls, bytes: 1 << 30 }
    }
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Searched {
    /// The answer.
    pub answer: Answer,
    /// Forward-model calls that it cost.
    pub calls: u64,
    /// The number of distinct states found.
    pub states: u64,
    /// The actions that lead to the first of the states from which the fewest sprites must still go or come for a
    /// win.
    pub nearest: Vec<Action>,
}

/// The answer of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// These actions win.
    Won {
        /// The actions from the initial state of the search.
        actions: Vec<Action>,
        /// `true` if no fewer actions win.
        shortest: bool,
    },
    /// There is no win: all reachable states were searched.
    Impossible,
    /// Not known: the calls were spent, or all states of one random future were searched.
    OutOfCalls,
    /// Not known: the memory was full.
    OutOfMemory,
}
