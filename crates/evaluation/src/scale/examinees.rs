//! The examinees, which are players that never change and whose episodes put releases on one scale. A changed
//! examinee is a new examinee ([docs/reference/examinees.md](../../../../docs/reference/examinees.md)).

use crate::player::Contestant;
use crate::prompt::{PromptSettings, Prompter};
use crate::run::Entrant;
use crate::serve::{PromptPlayer, Prompted};
use crate::subject::Subject;
use crate::{Commitment, EvaluationError};
use agents::{Budget, PlannerSpec};
use serde_json::json;
use statistics::scale::Dimension;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A player with a fixed name, budget and version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examinee {
    /// The name with a version: `mcts-1`.
    pub name: &'static str,
    /// The family of the examinee. Players of one family find the same games hard.
    pub family: &'static str,
    /// The player with its budget in forward-model calls per decision: `mcts:200`.
    pub player: &'static str,
    /// The examinee's dimension.
    pub dimension: Dimension,
}

const fn planner(name: &'static str, family: &'static str, player: &'static str) -> Examinee {
    Examinee { name, family, player, dimension: Dimension::Planner }
}

/// All examinees, in the order in which they play.
pub const EXAMINEES: [Examinee; 10] = [
    planner("random-1", "random", "random"),
    planner("greedy-1", "greedy", "one-step-score"),
    planner("nearest-1", "nearest", "one-step"),
    planner("random-search-1", "random-search", "random-search:200"),
    planner("rhea-1", "rhea", "rhea:200"),
    planner("mcts-1", "mcts", "mcts:200"),
    planner("guided-mcts-1", "guided-mcts", "guided-mcts:200"),
    planner("width-1", "width", "width:200"),
    planner("olets-1", "olets", "olets:200"),
    Examinee { name: "reflex-3", family: "reflex", player: "reflex", dimension: Dimension::Reader },
];

/// Returns the examinee with the given name.
pub fn examinee_named(name: &str) -> Option<&'static Examinee> {
    EXAMINEES.iter().find(|examinee| examinee.name == name)
}

/// A function that makes the player for an episode of a game.
type PlayerOf = Box<dyn Fn(&str) -> Contestant + Sync>;

impl Examinee {
    /// Returns the examinee in the form that results record.
    pub fn entrant(&self) -> Entrant {
        let mut details = json!({ "examinee": self.name, "family": self.family, "player": self.player });
        // As for other planners, which this field distinguishes from readers.
        if self.dimension == Dimension::Planner {
            details["planner"] = json!(self.player);
        }
        Entrant { name: self.name.to_owned(), mode: None, aids: Vec::new(), details }
    }

    /// Returns a function that makes the examinee's players, given the ID of a game.
    ///
    /// # Errors
    /// Returns an error if a prompt cannot be written for one of the games.
    pub fn players(&self, subjects: &[Subject], max_steps: u64) -> Result<PlayerOf, EvaluationError> {
        if self.dimension == Dimension::Planner {
            let spec: PlannerSpec = self.player.parse().expect("the player of an examinee is known");
            let budget = spec.budget().unwrap_or(Budget(0));
            return Ok(Box::new(move |_| Contestant::Planner { spec: spec.clone(), budget }));
        }
        let player: PromptPlayer = self.player.parse().expect("the player of an examinee is known");
        let mut prompters = BTreeMap::new();
        for subject in subjects {
            let prompter = Prompter::within(subject, PromptSettings::default(), max_steps, Commitment::ONE)?;
            prompters.insert(subject.id.clone(), Arc::new(prompter));
        }
        Ok(Box::new(move |game| {
            Contestant::Agent(Box::new(Prompted::new(player.clone(), prompters[game].clone())))
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn there_are_eight_families_of_planners_at_least() {
        let planners = EXAMINEES.iter().filter(|one| one.dimension == Dimension::Planner);
        assert!(planners.map(|one| one.family).collect::<BTreeSet<_>>().len() >= 8);
        let names: BTreeSet<&str> = EXAMINEES.iter().map(|one| one.name).collect();
        assert_eq!(names.len(), EXAMINEES.len());
        assert!(EXAMINEES.iter().all(|one| one.players(&[], 100).is_ok()));
        assert_eq!(examinee_named("mcts-1").map(|one| one.player), Some("mcts:200"));
        assert_eq!(examinee_named("mcts"), None);
    }
}
