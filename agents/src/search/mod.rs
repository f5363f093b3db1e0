//! Systematic search, for games in which chance decides nothing from here on: it proves a level winnable in so many ticks,
//! or not at all.
//!
//! States are told apart by [`engine::analysis::Keying`], kept as they differ from the start ([`engine::Packed`]), and
//! counted in forward-model calls. A search stops at the first win, when every state that can be reached has been looked
//! at, or when its limits are met: only the second proves that there is no win.

mod a_star;
mod best_first;
mod pushes;
mod tree;

pub use a_star::a_star;
pub use best_first::best_first;
pub use pushes::Pushes;

use engine::Action;
use serde::{Deserialize, Serialize};

/// What a search may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SearchLimits {
    /// Forward-model calls.
    pub calls: u64,
    /// Bytes of memory for states, keys and the tree.
    pub bytes: usize,
}

impl SearchLimits {
    /// So many calls, and a gibibyte.
    pub fn calls(calls: u64) -> SearchLimits {
        SearchLimits { calls, bytes: 1 << 30 }
    }
}

/// What a search found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Searched {
    /// The answer.
    pub answer: Answer,
    /// Forward-model calls that it cost.
    pub calls: u64,
    /// Different states that were met.
    pub states: u64,
    /// The actions that lead to the first of the states from which the fewest sprites must still go or come for a win.
    pub nearest: Vec<Action>,
}

/// The answer of a search.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// These actions win.
    Won {
        /// From the state on that the search started from.
        actions: Vec<Action>,
        /// Whether no fewer actions win.
        shortest: bool,
    },
    /// There is no win: every state that can be reached was looked at.
    Impossible,
    /// Not known: the calls were spent.
    OutOfCalls,
    /// Not known: the memory was full.
    OutOfMemory,
}
