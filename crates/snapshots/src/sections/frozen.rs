//! The result of a job, as data that can be stored and shipped.

use super::marks::Wins;
use super::memory::{SecondWin, Sibling};
use base::SeedStep;
use engine::Episode;
use forge::Tally;
use forge::card::Card;
use serde::{Deserialize, Serialize};
use validators::Difficulty;

/// The games of a job; none if nothing passed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobResult {
    /// The games that passed.
    pub games: Vec<FrozenGame>,
    /// The candidates that were tried, and the reasons why the others failed.
    pub tally: Tally,
}

/// A game as texts, without the canary of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrozenGame {
    /// The rules, headed by the title.
    pub text: String,
    /// The card that describes it. Its ladders are of plays that neither the judges nor the selection saw.
    pub card: Card,
    /// The difficulty of each level for its judges, by which games are selected; empty if no ladder played.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub difficulties: Vec<Difficulty>,
    /// The levels.
    pub levels: Vec<String>,
    /// The winning episode of each level.
    pub witnesses: Vec<Episode>,
    /// For each episode, the steps from the release's root seed to its seed.
    pub paths: Vec<Vec<SeedStep>>,
    /// For each level, the plays that its marks won; empty if the recipe asks for none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<Wins>,
    /// The sibling that a coin withholds, if the recipe asks for one and there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sibling: Option<Sibling>,
    /// For each level the win that a coin withholds, if there is one; empty if the recipe asks for none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seconds: Vec<Option<SecondWin>>,
}

impl FrozenGame {
    /// The titles and rules that it is known by: its own, and those of its sibling.
    pub(crate) fn guises(&self) -> impl Iterator<Item = (&str, &str)> {
        let sibling = self.sibling.iter().map(|sibling| (&*sibling.title, &*sibling.text));
        std::iter::once((&*self.card.title, &*self.text)).chain(sibling)
    }

    /// Tests whether the steps from the release's root seed to each of its episodes are known.
    pub(crate) fn is_traced(&self) -> bool {
        let seconds = self.seconds.iter().flatten().map(|second| &second.path);
        !self.paths.iter().chain(seconds).any(Vec::is_empty)
    }
}
