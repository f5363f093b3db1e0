//! A playable game with its levels.

use crate::commitment::Commitment;
use base::Seed;
use engine::{Analysis, Diagnostics, Game, Level, StateHash, describe};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A game with its levels, and facts known about it beyond its rules.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The game's ID in logs and tables. It can be used as a file name, and contains no path separators.
    pub id: String,
    /// The game's source text.
    pub source: String,
    /// The compiled game.
    pub game: Game,
    /// The analysis of the game's rules.
    pub analysis: Analysis,
    /// The game's levels.
    pub levels: Vec<SubjectLevel>,
    /// The known facts beyond the rules.
    pub facts: SubjectFacts,
}

impl Subject {
    /// Builds a subject from the texts of a game and its levels. Each level is given with its number, its
    /// text, and the length of its shortest win in ticks, if the win was proved to be optimal. If `facts`
    /// contains no taxonomy, the taxonomy is derived from the rules.
    ///
    /// # Errors
    /// Returns the game's problems if the game does not compile. Otherwise, returns the problems of the first
    /// level that does not compile.
    pub fn read(
        id: &str,
        source: &str,
        levels: &[(usize, String, Option<usize>)],
        mut facts: SubjectFacts,
    ) -> Result<Subject, Unreadable> {
        let load = if facts.as_reference { Game::from_source_as_reference } else { Game::from_source };
        let game = load(source).map_err(|problems| Unreadable { level: None, problems })?;
        let analysis = Analysis::of(&game);
        let read = |(number, text, optimal_ticks): &(usize, String, Option<usize>)| {
            let level = game.level(text);
            let level = level.map_err(|problems| Unreadable { level: Some(*number), problems })?;
            let (number, text, optimal_ticks, first) =
                (*number, text.clone(), *optimal_ticks, OnceLock::new());
            Ok(SubjectLevel { number, text, level, optimal_ticks, first })
        };
        let levels = levels.iter().map(read).collect::<Result<_, _>>()?;
        if facts.taxonomy.is_empty() {
            facts.taxonomy = describe::Guide::from_analysis(&analysis).kind;
        }
        Ok(Subject { id: id.to_owned(), source: source.to_owned(), game, analysis, levels, facts })
    }

    /// Returns the hash of a level's first state under a fixed seed. Renaming a game does not change the
    /// hashes.
    pub(crate) fn first_state(&self, level: &SubjectLevel) -> StateHash {
        let start = || self.game.start(&level.level, Seed::from_text("start")).state_hash();
        *level.first.get_or_init(start)
    }
}

/// The error for a game or level that does not compile.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{}{problems}", level.map_or(String::new(), |number| format!("level {number}: ")))]
pub struct Unreadable {
    /// The level number, or `None` if the game does not compile.
    pub level: Option<usize>,
    /// The problems found.
    pub problems: Diagnostics,
}

/// A level of a [`Subject`].
#[derive(Clone, Debug)]
pub struct SubjectLevel {
    /// The level's number in the game.
    pub number: usize,
    /// The level text.
    pub text: String,
    /// The level, checked against its game.
    pub level: Level,
    /// The length of the shortest win in ticks, if it was proved to be optimal.
    pub optimal_ticks: Option<usize>,
    /// The hash of the level's first state under a fixed seed, once it has been computed.
    first: OnceLock<StateHash>,
}

/// The facts about a game that reports state in addition to its results.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubjectFacts {
    /// The game's title in its own theme.
    pub title: String,
    /// The kind of game stated by its release or its card, such as `shooter`. Empty if the kind is unknown.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kind: String,
    /// The kind of game according to its rules, as one sentence per aspect of the taxonomy
    /// (`engine::describe::Guide::kind`).
    pub taxonomy: Vec<String>,
    /// `true` if the game's faults are tolerated, as in the reference engine.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub as_reference: bool,
    /// The release's reference results for the played levels.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<LevelMark>,
    /// The release's ceilings (highest known win rates) for the played levels.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ceilings: Vec<LevelCeiling>,
    /// The name of the game's release.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<String>,
    /// The length of each level's shortest known win in ticks, by level number. Levels without a win in the
    /// release are missing.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub known_wins: BTreeMap<usize, u64>,
}

/// A reference player's result on a level, as stored in a release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelMark {
    /// The level number.
    pub level: usize,
    /// The level's tier (difficulty class), from 1 to 4. It measures how far ahead a winner must look.
    pub tier: u8,
    /// The reference player's name.
    pub player: String,
    /// The number of actions that the player commits to at each decision.
    pub commit: Commitment,
    /// The number of won episodes.
    pub wins: u64,
    /// The number of episodes played.
    pub plays: u64,
}

/// The highest known win rate on a level at one commitment, as stored in a release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelCeiling {
    /// The level number.
    pub level: usize,
    /// The number of actions that a player commits to at each decision.
    pub commit: Commitment,
    /// `true` if the best player wins every episode, because no randomness can occur on the level.
    pub exact: bool,
    /// The number of episodes that the best known player won.
    pub wins: u64,
    /// The number of episodes that the best known player played.
    pub episodes: u64,
}
