//! What is played: a game with its levels.

use engine::{Analysis, Diagnostics, Game, Level, describe};
use serde::{Deserialize, Serialize};

/// A game with its levels, and what is known of it beyond its rules.
#[derive(Clone, Debug)]
pub struct Subject {
    /// What logs and tables call it: a file name without separators.
    pub id: String,
    /// The text of the game.
    pub source: String,
    /// The compiled game.
    pub game: Game,
    /// What its rules mean.
    pub analysis: Analysis,
    /// Its levels.
    pub levels: Vec<SubjectLevel>,
    /// What is known of it.
    pub facts: SubjectFacts,
}

impl Subject {
    /// A game and its levels from their texts: each level with its number and the ticks of its proved shortest win, if there
    /// is one. The taxonomy is derived from the rules where `facts` has none.
    ///
    /// # Errors
    /// The game, or else the first level with problems, does not compile: its problems.
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
            Ok(SubjectLevel { number: *number, text: text.clone(), level, optimal_ticks: *optimal_ticks })
        };
        let levels = levels.iter().map(read).collect::<Result<_, _>>()?;
        if facts.taxonomy.is_empty() {
            facts.taxonomy = describe::Guide::from_analysis(&analysis).kind;
        }
        Ok(Subject { id: id.to_owned(), source: source.to_owned(), game, analysis, levels, facts })
    }
}

/// A game or level that does not compile.
#[derive(Clone, Debug)]
pub struct Unreadable {
    /// The level's number; none if it is the game.
    pub level: Option<usize>,
    /// What is wrong with it.
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
    /// Ticks of the shortest win, where it is proved that no fewer win.
    pub optimal_ticks: Option<usize>,
}

/// What reports say of a game beside the results.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubjectFacts {
    /// The title in the game's own fiction.
    pub title: String,
    /// What kind of game it is, a sentence for each side of the taxonomy (`engine::describe::Guide::kind`).
    pub taxonomy: Vec<String>,
    /// Whether its faults are overlooked as the reference engine does.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub as_reference: bool,
}
