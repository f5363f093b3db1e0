//! The result of an attempt to generate a game.

use super::candidate::MadeGame;
use crate::tally::Tally;

/// The result of one attempt, or of all attempts to generate one game.
#[derive(Default)]
pub(super) struct Attempted {
    pub(super) made: Option<MadeGame>,
    pub(super) tally: Tally,
}
