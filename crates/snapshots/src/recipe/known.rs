//! A recipe's record of earlier content, which the release must not repeat.

use crate::recipe::error::RecipeError;
use base::Digest;
use engine::Game;
use generators::invention::Census;
use generators::levels::LevelSimilarity;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use validators::GameForm;

/// The content of previous releases, which this release must not repeat.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Known {
    /// The names of the previous releases, oldest first.
    pub releases: Vec<String>,
    /// The rules of the previous generated games, with all names removed. The rules are stored in full, so that any
    /// later version can compute the distance to a game.
    pub games: Vec<String>,
    /// The canonical items (rules and level) of the previous corpus games.
    pub items: BTreeSet<Digest>,
    /// The number of previous games that use each mechanic (such as `mechanic/lock`), each ending, and each coupling
    /// (merged pair of ports).
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub patterns: BTreeMap<String, u32>,
}

impl Known {
    /// Computes the games' forms. Cost: about a millisecond per game.
    ///
    /// # Errors
    /// Returns an error if an entry is not a game.
    pub(crate) fn forms(&self) -> Result<Vec<GameForm>, RecipeError> {
        let form = |(at, text): (usize, &String)| {
            let wrong = |_| RecipeError::Value {
                key: "known.games",
                message: format!(
                    "has an invalid game at index {at}: pass the previous release with --parent"
                ),
            };
            Ok(GameForm::of(&Game::from_source(text).map_err(wrong)?))
        };
        self.games.iter().enumerate().map(form).collect()
    }

    /// Counts the mechanics, endings and couplings (merged pairs of ports) of the games.
    pub(crate) fn census(&self) -> Census {
        Census::of(&self.patterns)
    }

    pub(crate) fn is_empty(&self) -> bool {
        *self == Known::default()
    }
}

/// Returns the canonical item (rules and level) for a level of a game. Levels that differ only in names, rule order
/// and board symmetry have equal canonical items.
pub(crate) fn item(form: &GameForm, likeness: &LevelSimilarity, level: &engine::Level) -> Digest {
    Digest::of(format!("{} {}", form.digest(), likeness.digest(level)).as_bytes())
}
