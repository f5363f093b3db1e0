//! Built-in players, which plan with the forward model or repeat a recorded episode.

use crate::log::Journal;
use crate::player::{Agent, Choice, Halt};
use crate::turn::Turn;
use agents::{Budget, PlannerSpec};
use base::Digest;
use engine::{Action, Episode};

/// The player of an episode.
pub enum Contestant {
    /// A planner. It sees the state, because it is a baseline and not a subject of the benchmark.
    Planner {
        /// The planner, optionally with its budget.
        spec: PlannerSpec,
        /// The number of forward-model calls per decision, if the planner's name does not set it.
        budget: Budget,
    },
    /// An agent that is shown turns.
    Agent(Box<dyn Agent>),
}

/// An agent that repeats the actions of a recorded episode, and then does nothing.
#[derive(Clone, Debug)]
pub struct Replay {
    actions: Vec<Action>,
}

impl Replay {
    /// Creates a replay of the actions of an episode.
    pub fn of(episode: &Episode) -> Replay {
        Replay { actions: episode.actions.clone() }
    }

    /// Returns a digest that distinguishes replays.
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
