//! A job's result, as data that can be stored and transferred.

use super::ceilings::LevelCeilings;
use super::marks::Wins;
use super::memory::{SecondWin, Sibling};
use base::SeedStep;
use engine::Episode;
use forge::Tally;
use forge::card::Card;
use serde::{Deserialize, Serialize};
use validators::Difficulty;

/// A job's result: its games, or no games if every candidate was rejected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobResult {
    /// The games that passed.
    pub games: Vec<FrozenGame>,
    /// The number of candidates tried, and the rejections by reason.
    pub tally: Tally,
}

/// A generated game as it is stored in a release, but without the release's canary (its identifier in text corpora).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenGame {
    /// The rules, preceded by the title.
    pub text: String,
    /// The game's card. The reference players' results on the card come from episodes that were used neither by the
    /// judges nor for selection.
    pub card: Card,
    /// For each level, the difficulty that the judges measured, for use in selection; empty if no ladder of reference
    /// players was played.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub difficulties: Vec<Difficulty>,
    /// The level texts.
    pub levels: Vec<String>,
    /// The winning episode of each level.
    pub witnesses: Vec<Episode>,
    /// For each episode, the steps from the release's root seed to the episode's seed.
    pub paths: Vec<Vec<SeedStep>>,
    /// The reference players' wins on each level; empty if the recipe does not request reference players.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<Wins>,
    /// The highest known win rates on each level; empty if the recipe does not request them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ceilings: Vec<LevelCeilings>,
    /// The game's sibling: a renamed copy that a secret random choice selected to be withheld. `None` if the recipe
    /// does not request siblings, or if the game has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sibling: Option<Sibling>,
    /// For each level, the win that a secret random choice selected to be withheld, or `None` if there is no such win.
    /// The list is empty if the recipe does not request second wins.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seconds: Vec<Option<SecondWin>>,
}

impl FrozenGame {
    /// Returns the titles and rules of the game and of its sibling (the withheld renamed copy), if any.
    pub(crate) fn guises(&self) -> impl Iterator<Item = (&str, &str)> {
        let sibling = self.sibling.iter().map(|sibling| (&*sibling.title, &*sibling.text));
        std::iter::once((&*self.card.title, &*self.text)).chain(sibling)
    }

    /// Returns `true` if the steps from the release's root seed are known for each of the game's episodes.
    pub(crate) fn is_traced(&self) -> bool {
        let seconds = self.seconds.iter().flatten().map(|second| &second.path);
        !self.paths.iter().chain(seconds).any(Vec::is_empty)
    }
}
