//! The actions of a player.

use serde::{Deserialize, Serialize};
use std::fmt;

/// An action of a player in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Action {
    /// Nothing.
    Nil,
    /// The up key.
    Up,
    /// The left key.
    Left,
    /// The down key.
    Down,
    /// The right key.
    Right,
    /// The use key: shoot, hit, put.
    Use,
}

impl Action {
    /// All actions, in order.
    pub const ALL: [Action; 6] =
        [Action::Nil, Action::Up, Action::Left, Action::Down, Action::Right, Action::Use];

    /// Parses the reference's spelling, `ACTION_LEFT`, which traces use.
    pub fn from_reference(name: &str) -> Option<Action> {
        let name = name.strip_prefix("ACTION_")?;
        Action::ALL.into_iter().find(|action| action.to_string().eq_ignore_ascii_case(name))
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Action::Nil => "nil",
            Action::Up => "up",
            Action::Left => "left",
            Action::Down => "down",
            Action::Right => "right",
            Action::Use => "use",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actions_have_the_reference_spelling() {
        assert_eq!(Action::from_reference("ACTION_LEFT"), Some(Action::Left));
        assert_eq!(Action::from_reference("ACTION_ESCAPE"), None);
        assert_eq!(Action::from_reference("LEFT"), None);
    }
}
