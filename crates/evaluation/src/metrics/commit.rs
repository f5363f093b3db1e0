//! Compares the plans in a log with the steps that execute them.

use crate::commitment::Commitment;
use crate::log::Event;
use crate::player::Choice;
use crate::run::available;
use engine::{Game, State};

/// The state of the current plan.
#[derive(Debug)]
pub(super) struct Commit {
    commit: Commitment,
    max_steps: u64,
    choice: Choice,
    /// The number of steps of the plan that have been played.
    played: u64,
    due: u64,
}

impl Commit {
    /// Creates the state before the first decision.
    pub(super) fn new(commit: Commitment, max_steps: u64) -> Commit {
        Commit { commit, max_steps, choice: Choice::plan(Vec::new()), played: 0, due: 0 }
    }

    /// Begins a plan recorded after `steps` steps.
    pub(super) fn begin(&mut self, event: &Event, steps: u64) -> Result<(), String> {
        let Event::Plan { step, actions, validity } = event else { return Ok(()) };
        if self.commit.is_one() {
            return Err("the log contains a plan, but the player commits to one action at a time".to_owned());
        }
        if self.played < self.due {
            return Err(format!(
                "a new plan begins, but {} steps of the previous plan are missing",
                self.due - self.played
            ));
        }
        if *step != steps {
            return Err(format!("the plan of step {steps} is recorded as the plan of step {step}"));
        }
        self.due = self.commit.due(self.max_steps.saturating_sub(steps));
        if actions.len() as u64 > self.due {
            return Err(format!("the plan has {} actions; the limit is {}", actions.len(), self.due));
        }
        (self.choice, self.played) = (Choice { actions: actions.clone(), validity: *validity }, 0);
        Ok(())
    }

    /// Compares a step that was played in `state` with the current plan. Returns `true` if the step itself is
    /// a decision, because the player commits to one action.
    pub(super) fn step(&mut self, event: &Event, game: &Game, state: &State) -> Result<bool, String> {
        let Event::Step { step, action, validity, .. } = event else { return Ok(false) };
        if self.commit.is_one() {
            return Ok(true);
        }
        if self.played >= self.due {
            return Err(format!("step {step} does not belong to a plan"));
        }
        let asked = self.choice.action(self.played as usize);
        let planned = available(game, state, asked);
        if (planned, self.choice.validity) != (*action, *validity) {
            let (planned, found) = (self.choice.validity.name(), validity.name());
            return Err(format!(
                "step {step} plays {action} ({found}), but the plan has {asked} ({planned})"
            ));
        }
        self.played += 1;
        Ok(false)
    }
}
