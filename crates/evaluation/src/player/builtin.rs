//! Built-in players, which plan with the forward model or replay a recorded episode.

use crate::log::Journal;
use crate::player::{Agent, Choice, Halt};
use crate::turn::Turn;
use agents::{Budget, PlannerSpec};
use base::Digest;
use engine::{Action, Episode};

/// The player of an episode.
pub enum Contestant {
    /// A planner. Planners see the state, because they are baselines rather than subjects of the benchmark.
    Planner {
        /// The planner, with its budget if its name contains one.
        spec: PlannerSpec,
        /// The number of forward-model calls per decision, used if the planner's name contains no budget.
        budget: Budget,
    },
    /// An agent, which sees turns instead of the state.
    Agent(Box<dyn Agent>),
}

/// An agent that replays the actions of a recorded episode, and does nothing afterwards.
#[derive(Clone, Debug)]
pub struct Replay {
    actions: Vec<Action>,
}

impl Replay {
    /// Creates an agent that repeats an episode's actions.
    pub fn of(episode: &Episode) -> Replay {
        Replay { actions: episode.actions.clone() }
    }

    /// Returns a digest of the actions. Replays of distinct actions have distinct digests.
    pub fn digest(&self) -> Digest {
        let words: Vec<String> = self.actions.iter().map(Action::to_string).collect();
        Digest::of(words.join(" ").as_bytes())
    }
}

impl Agent for Replay {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let past = usize::try_from(turn.number).unwrap_or(usize::MAX);
        let due = usize::try_from(turn.due()).unwrap_or(usize::MAX);
        Ok(Choice::plan(self.actions.iter().skip(past).take(due).copied().collect()))
    }

    fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        Ok(())
    }
}
