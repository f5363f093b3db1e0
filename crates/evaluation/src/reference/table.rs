//! The scale's reference players, each with a name and a version
//! ([docs/reference/examinees.md](../../../../docs/reference/examinees.md)). Their episodes place releases on
//! a common scale. A player that is modified gets a new version, and counts as a new player.

use super::ReferencePlayer;
use crate::player::Contestant;
use crate::run::Entrant;
use crate::subject::Subject;
use crate::{Commitment, EvaluationError};
use base::Seed;
use serde_json::json;
use statistics::scale::Dimension;
use std::collections::BTreeMap;

/// A reference player whose name, budget and version are fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScalePlayer {
    /// The name of the examinee (a reference player whose play never changes), such as `mcts-1`, including its version.
    pub name: &'static str,
    /// The family of the player. Players in the same family find the same games hard.
    pub family: &'static str,
    /// The player, such as `mcts:200`, with its budget in forward-model calls per decision.
    pub player: &'static str,
    /// The dimension of the player's ability: that of planners, or that of players that see only prompts.
    pub dimension: Dimension,
}

const fn planner(name: &'static str, family: &'static str, player: &'static str) -> ScalePlayer {
    ScalePlayer { name, family, player, dimension: Dimension::Planner }
}

/// All reference players of the scale, in playing order.
pub const SCALE_PLAYERS: [ScalePlayer; 10] = [
    planner("random-1", "random", "random"),
    planner("greedy-1", "greedy", "one-step-score"),
    planner("nearest-1", "nearest", "one-step"),
    planner("random-search-1", "random-search", "random-search:200"),
    planner("rhea-1", "rhea", "rhea:200"),
    planner("mcts-1", "mcts", "mcts:200"),
    planner("guided-mcts-1", "guided-mcts", "guided-mcts:200"),
    planner("width-1", "width", "width:200"),
    planner("olets-1", "olets", "olets:200"),
    ScalePlayer { name: "reflex-5", family: "reflex", player: "reflex", dimension: Dimension::Reader },
];

/// Returns the scale's reference player with the given name; `None` if there is no such player.
pub fn scale_player_named(name: &str) -> Option<&'static ScalePlayer> {
    SCALE_PLAYERS.iter().find(|player| player.name == name)
}

/// A function that creates an episode's player, given the game ID.
type PlayerOf = Box<dyn Fn(&str) -> Contestant + Sync>;

impl ScalePlayer {
    /// Returns the reference player in the form in which evaluation results describe their player.
    pub fn entrant(&self) -> Entrant {
        let mut details = json!({ "examinee": self.name, "family": self.family, "player": self.player });
        // This field distinguishes planners from players that see only prompts, as it does for planners outside the
        // scale.
        if self.dimension == Dimension::Planner {
            details["planner"] = json!(self.player);
        }
        Entrant { name: self.name.to_owned(), mode: None, aids: Vec::new(), details }
    }

    /// Returns a function that creates the reference player for a game, given the game's ID.
    ///
    /// # Errors
    /// Returns an error if a prompt cannot be written for one of the games.
    pub fn players(&self, subjects: &[Subject], max_steps: u64) -> Result<PlayerOf, EvaluationError> {
        let player: ReferencePlayer = self.player.parse().expect("the player of the scale is known");
        let mut prompters = BTreeMap::new();
        for subject in subjects {
            prompters.insert(subject.id.clone(), player.prompter(subject, max_steps, Commitment::ONE)?);
        }
        let chance = Seed::from_text(self.name);
        Ok(Box::new(move |game| player.contestant(prompters.get(game).and_then(Option::as_ref), chance)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn there_are_eight_families_of_planners_at_least() {
        let planners = SCALE_PLAYERS.iter().filter(|one| one.dimension == Dimension::Planner);
        assert!(planners.map(|one| one.family).collect::<BTreeSet<_>>().len() >= 8);
        let names: BTreeSet<&str> = SCALE_PLAYERS.iter().map(|one| one.name).collect();
        assert_eq!(names.len(), SCALE_PLAYERS.len());
        assert!(SCALE_PLAYERS.iter().all(|one| one.players(&[], 100).is_ok()));
        assert_eq!(scale_player_named("mcts-1").map(|one| one.player), Some("mcts:200"));
        assert_eq!(scale_player_named("mcts"), None);
    }
}
