//! A study's players.

use crate::run::Entrant;
use crate::track;
use serde::Serialize;

/// A player in a study. Equal players in different results folders are the same player.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Player {
    /// The player's name in tables.
    pub name: String,
    /// The mode, `zero-shot` or `contextual`, or `None` for players that are not models.
    pub mode: Option<String>,
    /// The differences between the player's prompts and the default prompts, as sorted flags.
    pub aids: Vec<String>,
    /// The settings that distinguish the player from other players with the same name, mode and aids (optional parts of
    /// the prompt). Each setting is a phrase such as `temperature 0` or `served by m-2026-08`, and the phrases are
    /// sorted. The list is empty if there are no such players.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub conditions: Vec<String>,
}

/// The name of the mode without earlier turns.
pub const ZERO_SHOT: &str = "zero-shot";
/// The name of the mode that shows earlier turns.
pub const CONTEXTUAL: &str = "contextual";

impl Player {
    /// Creates a non-model player.
    pub fn reference(name: &str) -> Player {
        Player { name: name.to_owned(), mode: None, aids: Vec::new(), conditions: Vec::new() }
    }

    /// Creates a model player in a given mode, without aids (optional parts of the prompt).
    pub fn model(name: &str, mode: &str) -> Player {
        Player { mode: Some(mode.to_owned()), ..Player::reference(name) }
    }

    /// Returns `true` if the player is a baseline for comparisons, such as a random player, a planner or a
    /// replay. Models, programs (`cmd:`), people and mailboxes are not baselines.
    ///
    /// ```
    /// use infinite_arcade_evaluation::study::Player;
    /// assert!(Player::reference("mcts:100").is_reference());
    /// assert!(!Player::reference("cmd:python3 my_agent.py").is_reference());
    /// ```
    pub fn is_reference(&self) -> bool {
        let examined = ["cmd:", "human", "mailbox"].iter().any(|name| self.name.starts_with(name));
        self.mode.is_none() && !examined
    }

    /// Returns the track (bundle of prompt settings) with its version, such as `masked@1`. Returns `None` for players
    /// with custom prompts, and for players that read no prompts.
    pub fn track(&self) -> Option<&str> {
        self.aids.iter().find_map(|aid| aid.strip_prefix(track::AID))
    }

    /// Returns `true` if the results of the two players can be compared: the players have the same track (bundle of
    /// prompt settings), or one of them is a baseline that reads no prompts.
    pub fn is_comparable(&self, other: &Player) -> bool {
        let is_free = |player: &Player| player.track().is_none() && player.is_reference();
        self.track() == other.track() || is_free(self) || is_free(other)
    }

    /// Returns the name with mode, aids and conditions on one line ([`report::visible`]). The label is unique
    /// within a study.
    ///
    /// ```
    /// use infinite_arcade_evaluation::study::{CONTEXTUAL, Player};
    /// let player = Player { aids: vec!["coordinates".to_owned()], ..Player::model("a-model", CONTEXTUAL) };
    /// assert_eq!(player.label(), "a-model (contextual, coordinates)");
    /// ```
    pub fn label(&self) -> String {
        let notes: Vec<&str> =
            self.mode.iter().chain(&self.aids).chain(&self.conditions).map(String::as_str).collect();
        let label = match notes.is_empty() {
            true => self.name.clone(),
            false => format!("{} ({})", self.name, notes.join(", ")),
        };
        report::visible(&label).into_owned()
    }

    /// Returns the name with aids (optional parts of the prompt) and conditions, for tables that show the mode
    /// elsewhere.
    pub fn short_label(&self) -> String {
        Player { mode: None, ..self.clone() }.label()
    }
}

impl From<&Entrant> for Player {
    fn from(entrant: &Entrant) -> Player {
        let mut aids = entrant.aids.clone();
        aids.sort();
        Player { name: entrant.name.clone(), mode: entrant.mode.clone(), aids, conditions: Vec::new() }
    }
}
