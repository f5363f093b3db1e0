//! Systematic search for wins. From a state with a deterministic future, the search proves in how many ticks
//! a level can be won, or that the level cannot be won. In other games, the search explores one random
//! future, as if the player foresaw all randomness, and proves nothing.
//!
//! States are distinguished by [`engine::analysis::StateAbstraction`], stored as differences from the start
//! ([`engine::Packed`]), and counted in forward-model calls. A search stops at the first win, after all
//! reachable states, or at its limits. Only the second case proves that there is no win.

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
    /// Returns limits of `calls` calls and one gibibyte.
    pub fn calls(calls: u64) -> SearchLimits {
        SearchLimits { calls, bytes: 1 << 30 }
    }
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Searched {
    /// The answer to the question whether the level can be won.
    pub answer: Answer,
    /// The cost of the search in forward-model calls.
    pub calls: u64,
    /// The number of distinct states found.
    pub states: u64,
    /// The actions that lead to the state closest to a win: the state from which the fewest sprites must
    /// still disappear or appear. If several states are equally close, the first of them counts.
    pub nearest: Vec<Action>,
}

/// The answer of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// A sequence of actions wins.
    Won {
        /// The actions from the initial state of the search.
        actions: Vec<Action>,
        /// `true` if no shorter sequence of actions wins.
        shortest: bool,
    },
    /// There is no win, because all reachable states were searched.
    Impossible,
    /// The answer is unknown, because the budget in calls was spent or all states of one random future were
    /// searched.
    OutOfCalls,
    /// The answer is unknown, because the memory was full.
    OutOfMemory,
}
