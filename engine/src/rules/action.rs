//! The actions available to players.

use std::fmt;

base::named_enum! {
    /// A player's action in one tick.
    pub enum Action {
        /// No key is pressed: the player does nothing.
        Nil = "nil",
        /// The up key.
        Up = "up",
        /// The left key.
        Left = "left",
        /// The down key.
        Down = "down",
        /// The right key.
        Right = "right",
        /// The use key, which shoots, hits or places something.
        Use = "use",
    }
}

impl Action {
    /// Parses the reference's spelling of an action, such as `ACTION_LEFT`, which traces use; `None` for any other
    /// text.
    pub fn from_reference(name: &str) -> Option<Action> {
        let name = name.strip_prefix("ACTION_")?;
        Action::ALL.into_iter().find(|action| action.name().eq_ignore_ascii_case(name))
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
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
