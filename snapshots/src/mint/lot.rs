//! What a lot came to, as data that can be put away and shipped.

use super::tally::Tally;
use crate::card::Card;
use crate::games::MadeGame;
use engine::Episode;
use serde::{Deserialize, Serialize};

/// The games of a lot: none, if nothing passed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LotResult {
    /// Those that passed.
    pub games: Vec<FrozenGame>,
    /// What was tried, and why the others failed.
    pub tally: Tally,
}

/// A game as texts, without the canary of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenGame {
    /// The rules, headed by the title.
    pub text: String,
    /// What is told of it.
    pub card: Card,
    /// Its levels.
    pub levels: Vec<String>,
    /// The episode that wins each.
    pub witnesses: Vec<Episode>,
}

impl FrozenGame {
    pub(super) fn of(made: MadeGame) -> FrozenGame {
        let MadeGame { text, card, levels, witnesses, .. } = made;
        let levels = levels.iter().map(|found| found.level.to_string()).collect();
        FrozenGame { text, card, levels, witnesses }
    }
}
