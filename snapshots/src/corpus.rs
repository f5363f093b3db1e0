//! The corpus: hand-written games that releases take new levels for, and that verbs accept by name.

use serde::{Deserialize, Serialize};

/// `CARD.toml` of a corpus game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorpusCard {
    /// Title in the game's own fiction.
    pub title: String,
    /// What it is.
    pub description: String,
    /// How to win.
    pub goal: String,
    /// Which kind of game.
    pub kind: String,
    /// Whether anything moves unless the player acts.
    pub real_time: bool,
    /// What skill it asks for.
    pub skill: String,
    /// What each level is for.
    pub levels: Vec<Intent>,
}

/// What a level is for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Intent {
    /// What it teaches or tests.
    pub intent: String,
}

/// A corpus game as text.
#[derive(Clone, Debug, PartialEq)]
pub struct CorpusGame {
    /// Its folder's name.
    pub name: String,
    /// `game.vgdl`.
    pub source: String,
    /// `lvl0.txt`, `lvl1.txt` …
    pub levels: Vec<String>,
    /// `CARD.toml`.
    pub card: CorpusCard,
}

/// All corpus games, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corpus {
    /// Sorted by name.
    pub games: Vec<CorpusGame>,
}

impl Corpus {
    /// The game of that name.
    pub fn find(&self, name: &str) -> Option<&CorpusGame> {
        self.games.iter().find(|game| game.name == name)
    }
}
