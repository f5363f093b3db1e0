//! The result of a job, as data that can be stored and transferred.

use super::marks::Wins;
use super::memory::{SecondWin, Sibling};
use base::SeedStep;
use engine::Episode;
use forge::Tally;
use forge::card::Card;
use serde::{Deserialize, Serialize};
use validators::Difficulty;

/// The result of a job: its games, or no games if no candidate passed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobResult {
    /// The games that passed.
    pub games: Vec<FrozenGame>,
    /// The number of candidates tried, and the reasons for rejections.
    pub tally: Tally,
}

/// The texts of a game, without the canary of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenGame {
    /// The rules, headed by the title.
    pub text: String,
    /// The card of the game. Its ladders come from episodes that were used neither by the judges nor by the
    /// selection.
    pub card: Card,
    /// The difficulty that the judges measured for each level, which the selection uses; empty if no ladder was
    /// played.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub difficulties: Vec<Difficulty>,
    /// The texts of the levels.
    pub levels: Vec<String>,
    /// The winning episode of each level.
    pub witnesses: Vec<Episode>,
    /// For each episode, the steps from the release's root seed to its seed.
    pub paths: Vec<Vec<SeedStep>>,
    /// The wins of the reference players on each level; empty if the recipe requests none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<Wins>,
    /// The sibling that a coin withholds, if the recipe requests one and one exists.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sibling: Option<Sibling>,
    /// The win of each level that a coin withholds; `None` for a level without such a win. The list is empty if
    /// the recipe requests no second wins.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seconds: Vec<Option<SecondWin>>,
}

impl FrozenGame {
    /// Returns the titles and rules under which the game is known: the game's own, and those of its sibling.
    pub(crate) fn guises(&self) -> impl Iterator<Item = (&str, &str)> {
        let sibling = self.sibling.iter().map(|sibling| (&*sibling.title, &*sibling.text));
        std::iter::once((&*self.card.title, &*self.text)).chain(sibling)
    }

    /// Returns `true` if the steps from the release's root seed to each of the game's episodes are known.
    pub(crate) fn is_traced(&self) -> bool {
        let seconds = self.seconds.iter().flatten().map(|second| &second.path);
        !self.paths.iter().chain(seconds).any(Vec::is_empty)
    }
}
