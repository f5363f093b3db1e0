//! The progress of making levels or games.

use crate::games::Kept;

/// A receiver of progress, which can also return the results of an interrupted run. Several threads call it.
pub trait Progress: Sync {
    /// Called when a candidate was looked at or judged.
    fn looked(&self) {}
    /// Called when a candidate was accepted: a game with this title, or the level with this number.
    fn made(&self, _what: &str) {}
    /// Returns the result of an attempt from an interrupted run for the same games.
    fn kept(&self, _attempt: &str) -> Option<Kept> {
        None
    }
    /// Stores the result of an attempt.
    fn keep(&self, _attempt: &str, _result: &Kept) {}
}

impl Progress for () {}
