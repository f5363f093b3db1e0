//! The progress of a making of levels or games.

use crate::games::Kept;

/// Receives the progress of a making, and returns the results of an interrupted one. Several threads call it.
pub trait Progress: Sync {
    /// A candidate was looked at, or judged.
    fn looked(&self) {}
    /// A candidate is accepted: a game of this title, or the level of a number.
    fn made(&self, _what: &str) {}
    /// Returns the result of an attempt of an interrupted making of the same games.
    fn kept(&self, _attempt: &str) -> Option<Kept> {
        None
    }
    /// Keeps the result of an attempt.
    fn keep(&self, _attempt: &str, _result: &Kept) {}
}

impl Progress for () {}
