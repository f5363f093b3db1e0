//! Players that come with the suite and look ahead with the forward model, or repeat what was recorded.

use crate::log::Journal;
use crate::player::{Agent, Choice, Halt, Validity};
use crate::turn::Turn;
use agents::{Budget, PlannerSpec};
use engine::{Action, Digest, Episode};

/// Who plays an episode.
pub enum Contestant {
    /// A planner: sees the state, for it is no subject of the benchmark but a mark to compare with.
    Planner {
        /// Which, perhaps with its budget.
        spec: PlannerSpec,
        /// Forward-model calls of a decision, if the planner's name has none.
        budget: Budget,
    },
    /// Someone who is shown turns.
    Agent(Box<dyn Agent>),
}

/// Plays the actions of a recorded episode, then nothing.
#[derive(Clone, Debug)]
pub struct Replay {
    actions: Vec<Action>,
}

impl Replay {
    /// The actions of this episode.
    pub fn of(episode: &Episode) -> Replay {
        Replay { actions: episode.actions.clone() }
    }

    /// Tells replays apart.
    pub fn digest(&self) -> Digest {
        let words: Vec<String> = self.actions.iter().map(Action::to_string).collect();
        Digest::of(words.join(" ").as_bytes())
    }
}

impl Agent for Replay {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let action = usize::try_from(turn.number).ok().and_then(|number| self.actions.get(number));
        let offered = action.filter(|action| turn.actions.contains(action));
        Ok(Choice { action: *offered.unwrap_or(&Action::Nil), validity: Validity::Valid })
    }

    fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        Ok(())
    }
}
