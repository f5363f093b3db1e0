//! A game with its levels, ready to be played.

use crate::commitment::Commitment;
use base::Seed;
use engine::{Analysis, Diagnostics, Game, Level, StateHash, describe};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A game with its levels and the known facts beyond its rules.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The id of the game in logs and tables: a file name without separators.
    pub id: String,
    /// The text of the game.
    pub source: String,
    /// The compiled game.
    pub game: Game,
    /// The analysis of its rules.
    pub analysis: Analysis,
    /// Its levels.
    pub levels: Vec<SubjectLevel>,
    /// The known facts about it.
    pub facts: SubjectFacts,
}

impl Subject {
    /// Builds a subject from the texts of a game and its levels. Each level comes with its number and the ticks of its
    /// proved shortest win, if there is one. The taxonomy is derived from the rules if `facts` has none.
    ///
    /// # Errors
    /// The problems of the game if it does not compile, or else those of the first level that does not.
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

    /// Returns the hash of the first state of one of its levels under a fixed seed: equal for levels of twins under other names.
    pub(crate) fn first_state(&self, level: &SubjectLevel) -> StateHash {
        let start = || self.game.start(&level.level, Seed::from_text("start")).state_hash();
        *level.first.get_or_init(start)
    }
}

/// The error for a game or level that does not compile.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{}{problems}", level.map_or(String::new(), |number| format!("level {number}: ")))]
pub struct Unreadable {
    /// The level's number, or `None` if the game is at fault.
    pub level: Option<usize>,
    /// The problems found.
    pub problems: Diagnostics,
}

/// A level of a [`Subject`].
#[derive(Clone, Debug)]
pub struct SubjectLevel {
    /// Its number in the game.
    pub number: usize,
    /// The text of the level.
    pub text: String,
    /// The level, checked against its game.
    pub level: Level,
    /// The ticks of the shortest win, if its optimality is proved.
    pub optimal_ticks: Option<usize>,
    /// The hash of its first state under a fixed seed, once it is known.
    first: OnceLock<StateHash>,
}

/// The facts that reports give about a game beside the results.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubjectFacts {
    /// The title in the game's own theme.
    pub title: String,
    /// The kind of game that its release or its card gives: `shooter`. Empty if it is not known.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kind: String,
    /// The kind of game by its rules, a sentence for each side of the taxonomy (`engine::describe::Guide::kind`).
    pub taxonomy: Vec<String>,
    /// `true` if its faults are tolerated, as in the reference engine.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub as_reference: bool,
    /// The marks that its release keeps of the levels played.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<LevelMark>,
    /// The name of its release.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<String>,
    /// The ticks of the shortest known win of each level, by number, as far as its release tells them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub known_wins: BTreeMap<usize, u64>,
}

/// The result of a player that never changes on a level, as a release keeps it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelMark {
    /// The number of the level.
    pub level: usize,
    /// The tier of the level: what it demands, from 1 to 4.
    pub tier: u8,
    /// The player.
    pub player: String,
    /// The number of actions that it commits to at each look.
    pub commit: Commitment,
    /// The episodes that it won.
    pub wins: u64,
    /// The episodes that it played.
    pub plays: u64,
}
