//! What a player is shown at one decision.

use crate::run::Task;
use crate::subject::Subject;
use engine::{Action, Game, Observation, State};

/// What a player is shown at one decision: what stands for the whole episode, and the state that the action will be
/// played on. Never the state itself: with that a player could look into the future.
#[derive(Clone, Copy, Debug)]
pub struct Turn<'a> {
    /// The game. A player reads its rules; the levels are not for it.
    pub subject: &'a Subject,
    /// The number of the level, for logs.
    pub level: usize,
    /// Decisions before this one.
    pub number: u64,
    /// Decisions of the episode at most.
    pub limit: u64,
    /// What is seen now.
    pub observation: &'a Observation,
    /// What is seen was brought about by this action, and by what it gained; none at the first decision.
    pub before: Option<Before<'a>>,
    /// The actions that can be chosen, [`Action::Nil`] first.
    pub actions: &'a [Action],
}

/// The decision before.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// What was seen then.
    pub observation: &'a Observation,
    /// What was played.
    pub action: Action,
    /// By how much the score has changed.
    pub reward: f64,
}

/// The start of an episode as a player sees it, for looking at prompts without playing.
#[derive(Clone, Debug)]
pub struct Observed {
    observation: Observation,
    actions: Vec<Action>,
}

impl Observed {
    /// What a player is shown first.
    pub fn first(task: &Task<'_>) -> Observed {
        let game = &task.subject.game;
        let state = game.start(&task.level.level, task.chance());
        Observed { observation: game.observe(&state), actions: choices(game, &state) }
    }

    /// The turn.
    pub fn turn<'a>(&'a self, task: &Task<'a>) -> Turn<'a> {
        Turn {
            subject: task.subject,
            level: task.level.number,
            number: 0,
            limit: task.max_steps,
            observation: &self.observation,
            before: None,
            actions: &self.actions,
        }
    }
}

/// What can be chosen in a state: nothing, or a key.
pub(crate) fn choices(game: &Game, state: &State) -> Vec<Action> {
    let keys = game.actions(state).iter().copied().filter(|&action| action != Action::Nil);
    std::iter::once(Action::Nil).chain(keys).collect()
}
