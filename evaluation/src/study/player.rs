//! Who is compared.

use crate::run::Entrant;
use serde::Serialize;

/// A player of a study: equal ones in several results folders are one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Player {
    /// What tables call it.
    pub name: String,
    /// `zero-shot` or `contextual`; none for players that are no models.
    pub mode: Option<String>,
    /// What it is shown beyond or short of the default, a flag each, sorted.
    pub aids: Vec<String>,
}

/// The mode without memory.
pub const ZERO_SHOT: &str = "zero-shot";
/// The mode with earlier turns.
pub const CONTEXTUAL: &str = "contextual";

impl Player {
    /// A player that is no model.
    pub fn reference(name: &str) -> Player {
        Player { name: name.to_owned(), mode: None, aids: Vec::new() }
    }

    /// A model in a mode, without aids.
    pub fn model(name: &str, mode: &str) -> Player {
        Player { mode: Some(mode.to_owned()), ..Player::reference(name) }
    }

    /// Whether it is no model but a mark to compare with: random, a planner, a replay.
    pub fn is_reference(&self) -> bool {
        self.mode.is_none()
    }

    /// The name with mode and aids: no two players of a study have the same.
    ///
    /// ```
    /// use evaluation::study::{CONTEXTUAL, Player};
    /// let player = Player { aids: vec!["coordinates".to_owned()], ..Player::model("a-model", CONTEXTUAL) };
    /// assert_eq!(player.label(), "a-model (contextual, coordinates)");
    /// ```
    pub fn label(&self) -> String {
        let notes: Vec<&str> = self.mode.iter().chain(&self.aids).map(String::as_str).collect();
        if notes.is_empty() { self.name.clone() } else { format!("{} ({})", self.name, notes.join(", ")) }
    }

    /// The name with aids, for tables in which the mode is said.
    pub fn short_label(&self) -> String {
        Player { mode: None, ..self.clone() }.label()
    }
}

impl From<&Entrant> for Player {
    fn from(entrant: &Entrant) -> Player {
        let mut aids = entrant.aids.clone();
        aids.sort();
        Player { name: entrant.name.clone(), mode: entrant.mode.clone(), aids }
    }
}
