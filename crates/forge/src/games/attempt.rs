//! The result of an attempt at a game.

use super::candidate::MadeGame;
use super::look::Look;
use crate::tally::{LOOK, Tally};

/// The result of an attempt, or of those for one game.
#[derive(Default)]
pub(super) struct Attempted {
    pub(super) made: Option<MadeGame>,
    pub(super) tally: Tally,
    pub(super) looks: u64,
}

impl Attempted {
    pub(super) fn note(&mut self, look: &Look) {
        self.looks += 1;
        self.tally.judge(LOOK, look.evaluation.is_feasible(), look.calls);
    }
}
