//! Whole games on request: candidates of a generator of rules, their levels, and the judges of both.

mod candidate;
mod levels;

pub(crate) use candidate::Candidate;
pub use candidate::MadeGame;
pub(crate) use levels::Levels;
pub use levels::{FoundLevel, FoundLevels};
