//! The result of an attempt at a game.

use super::candidate::MadeGame;
use crate::tally::Tally;

/// The result of an attempt, or of those for one game.
#[derive(Default)]
pub(super) struct Attempted {
    pub(super) made: Option<MadeGame>,
    pub(super) tally: Tally,
}
