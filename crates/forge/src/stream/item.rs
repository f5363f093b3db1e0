//! Items of a stream.

use base::SeedPath;
use engine::{Action, Episode, Level};
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

/// A verified level of a stream.
///
/// In JSON, an item is an object with the keys `index`, `game`, `rules` (the game's digest), `path` (the steps from the
/// stream's seed to the level's seed), `difficulty`, `level` (the rows), `digest`, `witness` (one letter per action),
/// `length`, `witness_seed`, `generation` and `semantics`.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamItem {
    /// The index of the item in the stream.
    pub index: u64,
    /// The name of the item's game.
    pub game: String,
    /// The path of the seed from which the level was drawn.
    pub path: SeedPath,
    /// The requested difficulty, from 0.0 to 1.0, if any.
    pub difficulty: Option<f64>,
    /// The level.
    pub level: Level,
    /// A winning episode, which replays bit for bit.
    pub witness: Episode,
}

impl StreamItem {
    /// Returns the actions of the witness as letters: `U`, `L`, `D` and `R` for the arrow keys, `X` for use, and `.` for
    /// nil.
    pub fn letters(&self) -> String {
        let letter = |action: &Action| match action {
            Action::Nil => '.',
            Action::Up => 'U',
            Action::Left => 'L',
            Action::Down => 'D',
            Action::Right => 'R',
            Action::Use => 'X',
        };
        self.witness.actions.iter().map(letter).collect()
    }
}

impl Serialize for StreamItem {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let text = self.level.to_string();
        let mut item = serializer.serialize_struct("StreamItem", 12)?;
        item.serialize_field("index", &self.index)?;
        item.serialize_field("game", &self.game)?;
        item.serialize_field("rules", &self.witness.game)?;
        item.serialize_field("path", self.path.steps())?;
        item.serialize_field("difficulty", &self.difficulty)?;
        item.serialize_field("level", &text.lines().collect::<Vec<_>>())?;
        item.serialize_field("digest", &self.level.digest())?;
        item.serialize_field("witness", &self.letters())?;
        item.serialize_field("length", &self.witness.actions.len())?;
        item.serialize_field("witness_seed", &self.witness.seed)?;
        item.serialize_field("generation", &generators::GENERATION)?;
        item.serialize_field("semantics", &engine::SEMANTICS)?;
        item.end()
    }
}
