//! The corpus of hand-written games. Releases contain new levels for corpus games, and commands accept corpus
//! games by name.

use crate::sections::designs::{Design, DesignPool};
use serde::{Deserialize, Serialize};

/// A corpus game's `CARD.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorpusCard {
    /// The title in the game's own theme.
    pub title: String,
    /// A description of the game.
    pub description: String,
    /// The goal, as a sentence.
    pub goal: String,
    /// The kind of game.
    pub kind: String,
    /// `true` if sprites move even while the player does nothing.
    pub real_time: bool,
    /// The skill that the game requires.
    pub skill: String,
    /// The purpose of each level.
    pub levels: Vec<Intent>,
}

/// A level's purpose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Intent {
    /// A description of what the level teaches or tests.
    pub intent: String,
}

/// A corpus game, as text.
#[derive(Clone, Debug, PartialEq)]
pub struct CorpusGame {
    /// The name of the game's folder.
    pub name: String,
    /// The content of `game.vgdl`.
    pub source: String,
    /// The contents of `lvl0.txt`, `lvl1.txt` and so on.
    pub levels: Vec<String>,
    /// The game's card, parsed from `CARD.toml`.
    pub card: CorpusCard,
}

impl CorpusGame {
    /// Creates a game from the given texts. `card` is the text of the game's `CARD.toml`.
    ///
    /// # Errors
    /// Returns a message that names the game if the card is malformed.
    pub fn read(name: String, source: String, levels: Vec<String>, card: &str) -> Result<CorpusGame, String> {
        let card = toml::from_str(card).map_err(|error| format!("corpora/{name}/CARD.toml: {error}"))?;
        Ok(CorpusGame { name, source, levels, card })
    }
}

/// The games that recipes may take from outside: all corpus games, and a pool of designs if one was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corpus {
    /// The games, sorted by name.
    pub games: Vec<CorpusGame>,
    /// The pool for the section `[designs]`.
    pub designs: Option<DesignPool>,
}

impl Corpus {
    /// Returns the game with the given name; `None` if the corpus has no such game.
    pub fn find(&self, name: &str) -> Option<&CorpusGame> {
        self.games.iter().find(|game| game.name == name)
    }

    /// Returns a design by its index in the pool; `None` if there is no pool or no such design.
    pub(crate) fn design(&self, at: usize) -> Option<&Design> {
        self.designs.as_ref()?.designs.get(at)
    }
}
