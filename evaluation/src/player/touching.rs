//! The touch-everything player as an agent.

use crate::log::Journal;
use crate::player::{Agent, Choice, Halt};
use crate::turn::{Turn, is_of_use};
use agents::TouchEverything;
use engine::{Action, Seed};

/// An agent that learns by touching: it sees the observation of a turn, and nothing of the rules.
#[derive(Clone, Debug)]
pub struct Touching {
    player: TouchEverything,
}

impl Touching {
    /// The name of the player.
    pub const NAME: &'static str = "touch-everything";

    /// Creates the agent for an episode by the seed of its chance, from which its own choices are derived.
    pub fn new(chance: Seed) -> Touching {
        Touching { player: TouchEverything::new(chance.child(Touching::NAME, 0)) }
    }
}

impl Agent for Touching {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let analysis = &turn.subject.analysis;
        let actions: Vec<Action> =
            turn.actions.iter().copied().filter(|&action| is_of_use(analysis, action)).collect();
        let due = usize::try_from(turn.due()).unwrap_or(usize::MAX);
        Ok(Choice::plan(self.player.act(turn.observation, &actions, due)))
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        // The same turns get the same choices, and teach the same.
        self.act(turn, &mut Journal::in_memory()).map(drop)
    }

    fn end(&mut self, last: &Turn<'_>) {
        self.player.end(last.observation);
    }
}
