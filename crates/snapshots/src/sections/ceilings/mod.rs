//! Ceilings: the highest known win rate on each level, by commitment (the number of actions per decision).
//!
//! When the release is minted, the strongest known players play each level with fresh seeds, and the win rate of the
//! best of them is stored in a file of the release. On a level without randomness, the witness wins every episode.

mod check;
mod measure;
mod section;

pub(crate) use section::CeilingsSection;

use crate::format::layout::HELD;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::recipe::error::{RecipeError, wrong};
use serde::{Deserialize, Serialize};
use statistics::{Z95, wilson};
use std::fmt::Write;
use validators::Commitment;

/// The file with the ceilings (the highest known win rates). In a sealed release, it is stored in [`HELD`].
pub const CEILINGS_FILE: &str = "CEILINGS.json";

/// The version of the file format.
pub const CEILINGS_FORMAT: u32 = 1;

/// The commitments for which ceilings (highest known win rates) are measured. Each one divides the next, so a player
/// can play with the plans of a player with a longer commitment.
pub const CEILING_COMMITS: [Commitment; 4] =
    [Commitment::One, Commitment::Five, Commitment::Ten, Commitment::All];

/// The minimum and maximum number of episodes that a recipe can request.
const EPISODES: [u64; 2] = [10, 10_000];

/// The lowest ceiling of the levels that the README counts. Reports have the same threshold.
const ENOUGH: f64 = 0.8;

base::with_defaults! {
    /// The ceilings (highest known win rates) that a recipe requests.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct CeilingsPart {
        /// The number of episodes from which each level's ceiling at each commitment is estimated.
        pub episodes: u64 = 100,
    }
}

impl CeilingsPart {
    /// Checks the values.
    ///
    /// # Errors
    /// Returns an error if the number of episodes is out of range.
    pub(crate) fn check(self) -> Result<(), RecipeError> {
        let [least, most] = EPISODES;
        if (least..=most).contains(&self.episodes) {
            return Ok(());
        }
        let value = self.episodes;
        wrong("ceilings.episodes", format!("is {value}; the value must be from {least} to {most}"))
    }
}

/// The content of [`CEILINGS_FILE`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ceilings {
    /// The release's canary: an identifier that shows whether a text corpus contains the release.
    pub canary: String,
    /// The version of the format: [`CEILINGS_FORMAT`].
    pub format: u32,
    /// The recipe's request.
    pub asked: CeilingsPart,
    /// The games, ordered by folder name.
    pub games: Vec<GameCeilings>,
}

/// The ceilings (highest known win rates) of a game's levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameCeilings {
    /// The name of the game's folder.
    pub id: String,
    /// The game's levels.
    pub levels: Vec<LevelCeilings>,
}

/// The ceilings (highest known win rates) of a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelCeilings {
    /// `true` if no randomness can occur on the level. The witness then wins every episode, whatever the commitment.
    pub exact: bool,
    /// The ceilings, in the order of [`CEILING_COMMITS`].
    pub ceilings: Vec<Ceiling>,
}

/// The highest known win rate on a level at one commitment (number of actions per decision).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ceiling {
    /// The number of actions that a player commits to at each decision.
    pub commit: Commitment,
    /// The player that reached the win rate.
    pub player: String,
    /// The commitment with which this player plays: `commit`, or a longer one that `commit` divides.
    pub played: Commitment,
    /// The number of episodes won.
    pub wins: u64,
    /// The number of episodes, whose seeds were not used to choose the player.
    pub episodes: u64,
    /// The fraction of episodes won.
    pub rate: f64,
    /// The 95% interval of the win rate (Wilson's).
    pub interval: [f64; 2],
}

impl Ceiling {
    fn of(commit: Commitment, (player, played): (String, Commitment), wins: u64, episodes: u64) -> Ceiling {
        let interval = wilson(wins, episodes, Z95);
        let rate = wins as f64 / episodes as f64;
        Ceiling { commit, player, played, wins, episodes, rate, interval: [interval.low, interval.high] }
    }
}

impl LevelCeilings {
    /// Returns the ceilings of a level without randomness.
    fn exact() -> LevelCeilings {
        let one = |commit| Ceiling {
            interval: [1.0, 1.0],
            ..Ceiling::of(commit, ("witness".to_owned(), Commitment::All), 1, 1)
        };
        LevelCeilings { exact: true, ceilings: CEILING_COMMITS.map(one).to_vec() }
    }
}

impl Ceilings {
    fn of(canary: &str, asked: CeilingsPart, mut games: Vec<GameCeilings>) -> Ceilings {
        games.sort_by(|one, other| one.id.cmp(&other.id));
        Ceilings { canary: canary.to_owned(), format: CEILINGS_FORMAT, asked, games }
    }

    /// Parses the ceilings (highest known win rates) of a release.
    ///
    /// # Errors
    /// Returns a message if the text does not contain ceilings in this format.
    pub fn read(text: &[u8]) -> Result<Ceilings, String> {
        let ceilings: Ceilings = serde_json::from_slice(text).map_err(|error| error.to_string())?;
        match ceilings.format {
            CEILINGS_FORMAT => Ok(ceilings),
            other => Err(format!("format {other} is not {CEILINGS_FORMAT}: use a different arcade version")),
        }
    }

    /// Returns the file's path in a release of the given kind.
    fn path(kind: ReleaseKind) -> String {
        match kind {
            ReleaseKind::Open => CEILINGS_FILE.to_owned(),
            ReleaseKind::Sealed => format!("{HELD}{CEILINGS_FILE}"),
        }
    }

    /// Returns the path of the ceilings (highest known win rates) according to a manifest; `None` if the manifest's
    /// recipe requests no ceilings.
    pub fn path_in(manifest: &Manifest) -> Option<String> {
        let asked = manifest.recipe.get("ceilings").filter(|part| !part.is_null());
        asked.map(|_| Ceilings::path(manifest.kind))
    }

    /// Formats the mean ceilings (highest known win rates) by commitment, for the README of an open release.
    fn in_words(&self) -> String {
        let mut text = format!(
            "## Ceilings\n\nThe win rate of the best known player of each level, in {} episodes at each commitment \
             (the number of actions per decision).\n\n\
             | actions per decision | levels | mean ceiling | levels with at least {ENOUGH} |\n|---|---|---|---|\n",
            self.asked.episodes
        );
        let levels = || self.games.iter().flat_map(|game| &game.levels);
        for (at, commit) in CEILING_COMMITS.iter().enumerate() {
            let rates: Vec<f64> = levels().map(|level| level.ceilings[at].rate).collect();
            let mean = rates.iter().sum::<f64>() / rates.len() as f64;
            let enough = rates.iter().filter(|rate| **rate >= ENOUGH).count();
            let _ = writeln!(text, "| {} | {} | {mean:.2} | {enough} |", commit.name(), rates.len());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::Recipe;
    use crate::recipe::tests::{GOOD, check};

    #[test]
    fn requests_stay_within_bounds() {
        let asked = |text: &str| format!("{GOOD}[ceilings]\n{text}");
        let part = Recipe::from_toml(&asked("")).unwrap().ceilings;
        assert_eq!(part, Some(CeilingsPart { episodes: 100 }));
        check(&asked("episodes = 9"), "`ceilings.episodes` is 9; the value must be from 10 to 10000");
        check(&asked("games = 3"), "unknown field `games`");
        // Recipes that request no ceilings are serialised as before.
        assert!(serde_json::to_value(Recipe::from_toml(GOOD).unwrap()).unwrap().get("ceilings").is_none());
    }
}
