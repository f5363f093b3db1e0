//! The progress of generating levels or games.

use crate::games::Kept;

/// A receiver of progress events, which can also return the results of an interrupted run. Must support
/// calls from several threads.
pub trait Progress: Sync {
    /// Called before the work on a level starts.
    fn start(&self) {}
    /// Called after a candidate is evaluated or judged.
    fn looked(&self) {}
    /// Called after a candidate is accepted: a game with this title, or the level with this number.
    fn made(&self, _what: &str) {}
    /// Returns an attempt's result from an interrupted run for the same games.
    fn kept(&self, _attempt: &str) -> Option<Kept> {
        None
    }
    /// Stores an attempt's result.
    fn keep(&self, _attempt: &str, _result: &Kept) {}
}

impl Progress for () {}
