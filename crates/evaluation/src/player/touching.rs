//! An agent that learns the rules by touching everything.

use crate::log::Journal;
use crate::player::{Agent, Choice, Halt, Said, Validity};
use crate::predictions::{Predicted, TouchFact};
use crate::turn::{Turn, is_of_use};
use agents::TouchEverything;
use agents::touch_everything::Experience;
use base::Seed;
use engine::{Action, Observation};

/// An agent that learns the rules by touching everything. It sees each turn's observation, but no rules.
#[derive(Clone, Debug)]
pub struct Touching {
    player: TouchEverything,
    /// `true` if the score is hidden from the player.
    is_blind: bool,
}

impl Touching {
    /// The player's name in results.
    pub const NAME: &'static str = "touch-everything";

    /// Creates the agent for an episode. `chance` is the seed of the game's randomness, from which the
    /// agent's own choices are also derived.
    pub fn new(chance: Seed) -> Touching {
        Touching { player: TouchEverything::new(chance.child(Touching::NAME, 0)), is_blind: false }
    }

    /// Hides the score from the player, as in prompts without rules.
    #[must_use]
    pub fn without_score(self) -> Touching {
        Touching { is_blind: true, ..self }
    }

    /// Returns a prediction based on experience. If the score is hidden, types that seem beneficial are
    /// predicted to score.
    fn expects(&self, known: &Experience, fact: TouchFact) -> bool {
        match fact {
            TouchFact::Kills => known.is_deadly(),
            TouchFact::Stops => known.is_blocking(),
            TouchFact::Goes => known.taken > 0,
            TouchFact::Scores => known.gain != 0 || (self.is_blind && known.is_good()),
        }
    }

    fn seen(&self, turn: &Turn<'_>) -> Observation {
        let seen = turn.observation.clone();
        if self.is_blind { Observation { score: 0.0, ..seen } } else { seen }
    }
}

impl Agent for Touching {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let analysis = &turn.subject.analysis;
        let actions: Vec<Action> =
            turn.actions.iter().copied().filter(|&action| is_of_use(analysis, action)).collect();
        let due = usize::try_from(turn.due()).unwrap_or(usize::MAX);
        Ok(Choice::plan(self.player.act(&self.seen(turn), &actions, due)))
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        // To recall a turn, the agent chooses again: the same turns give the same choices and the same
        // experience.
        self.act(turn, &mut Journal::in_memory()).map(drop)
    }

    fn end(&mut self, last: &Turn<'_>) {
        self.player.end(&self.seen(last));
    }

    fn predict(&mut self, last: &Turn<'_>, kinds: &[String], _: &mut Journal) -> Result<Option<Said>, Halt> {
        self.player.end(&self.seen(last));
        let expected = |fact: TouchFact| {
            let known = kinds
                .iter()
                .filter(|kind| self.player.experience(kind).is_some_and(|known| self.expects(known, fact)));
            (fact, known.cloned().collect())
        };
        let predicted: Predicted = TouchFact::ALL.into_iter().map(expected).collect();
        Ok(Some(Said { predicted: Some(predicted), validity: Validity::Valid }))
    }
}
