//! The names of a game's types, compared between games. Two games that share most of them would look alike.

use engine::Game;
use std::collections::BTreeSet;

/// The maximum fraction of names that two games may share.
const SHARED: f64 = 0.5;

/// The names that are ignored because many games use them.
const COMMON: [&str; 5] = ["wall", "avatar", "floor", "ground", "exit"];

/// The names of a game's types, except common names.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cast(BTreeSet<String>);

impl Cast {
    /// Returns the names of a game's types, except common names.
    pub fn of(game: &Game) -> Cast {
        let names = game.sprite_types().map(|stype| game.name(stype).to_owned());
        Cast(names.filter(|name| !COMMON.contains(&name.as_str())).collect())
    }

    /// Returns `true` if most names of the game with fewer names also occur in the other game.
    pub fn is_shared(&self, other: &Cast) -> bool {
        let shared = self.0.intersection(&other.0).count() as f64;
        shared > SHARED * self.0.len().min(other.0.len()) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn casts_are_shared_if_most_names_are() {
        let cast = |names: &str| Cast(names.split(' ').map(str::to_owned).collect());
        assert!(cast("otter raft reed").is_shared(&cast("otter raft stone moss")));
        assert!(!cast("otter raft reed moss").is_shared(&cast("otter raft stone heron")));
    }
}
