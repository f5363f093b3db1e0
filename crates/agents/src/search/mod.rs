//! Systematic search for wins. If the future of a state is deterministic, the search proves the minimum number of
//! ticks in a win, or proves that there is no win. Otherwise, the search explores one random future, as if the player
//! foresaw all randomness, and proves nothing.
//!
//! States are distinguished by [`engine::analysis::StateAbstraction`] and stored as differences from the
//! start ([`engine::Packed`]). The cost is counted in forward-model calls. A search stops at the first win,
//! when it has covered all reachable states, or at its limits. Only full coverage proves that no win exists.

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
    /// The maximum number of forward-model calls.
    pub calls: u64,
    /// The maximum number of bytes for states, keys and the tree.
    pub bytes: usize,
}

impl SearchLimits {
    /// Returns limits of `calls` calls and 1 GiB of memory.
    pub fn calls(calls: u64) -> SearchLimits {
        SearchLimits { calls, bytes: 1 << 30 }
    }
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Searched {
    /// The finding on whether the level can be won.
    pub answer: Answer,
    /// The cost of the search in forward-model calls.
    pub calls: u64,
    /// The number of distinct states found.
    pub states: u64,
    /// The actions that lead to the state closest to a win: the state in which the fewest sprites must still
    /// disappear or appear. If several states are equally close, the first one found counts.
    pub nearest: Vec<Action>,
}

/// The outcome of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// A sequence of actions wins.
    Won {
        /// The actions from the search's initial state.
        actions: Vec<Action>,
        /// `true` if no shorter sequence of actions wins.
        shortest: bool,
    },
    /// No win exists, because the search has covered all reachable states.
    Impossible,
    /// The answer is unknown, because the search has spent its call budget, or has covered all states of only one
    /// random future.
    OutOfCalls,
    /// The answer is unknown, because the memory limit was reached.
    OutOfMemory,
}
