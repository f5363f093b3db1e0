//! The progress of generating levels or games.

use crate::games::Kept;

/// A receiver of progress events, which can also supply the results of an interrupted run. Its methods may be called
/// from several threads at once.
pub trait Progress: Sync {
    /// Called before the work on a level starts.
    fn start(&self) {}
    /// Called after a candidate is evaluated or judged.
    fn looked(&self) {}
    /// Called after a candidate is accepted: a game with this title, or the level with this number.
    fn made(&self, _what: &str) {}
    /// Returns the saved result of an attempt, if an interrupted run for the same games has saved it.
    fn kept(&self, _attempt: &str) -> Option<Kept> {
        None
    }
    /// Stores an attempt's result.
    fn keep(&self, _attempt: &str, _result: &Kept) {}
}

impl Progress for () {}
