//! The view of a player at one decision.

use crate::run::Task;
use crate::subject::Subject;
use engine::{Action, Game, Observation, State};

/// The view of a player at one decision: the facts of the whole episode, and an observation of the current state. The state
/// itself is never shown, because a player could use it to look into the future.
#[derive(Clone, Copy, Debug)]
pub struct Turn<'a> {
    /// The game. A player may read its rules, but not its levels.
    pub subject: &'a Subject,
    /// The number of the level, for logs.
    pub level: usize,
    /// The number of decisions before this one.
    pub number: u64,
    /// The maximum number of decisions of the episode.
    pub limit: u64,
    /// The current observation.
    pub observation: &'a Observation,
    /// The preceding decision, which led to the current observation; `None` at the first decision.
    pub before: Option<Before<'a>>,
    /// The available actions, [`Action::Nil`] first.
    pub actions: &'a [Action],
}

/// The preceding decision.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The observation at that decision.
    pub observation: &'a Observation,
    /// The action played.
    pub action: Action,
    /// The change of the score.
    pub reward: f64,
}

impl<'a> Turn<'a> {
    /// The turn of an episode after `number` steps, of which the last led from the observation in `before`.
    pub(crate) fn of(
        task: &Task<'a>,
        number: u64,
        observation: &'a Observation,
        before: &'a Option<(Observation, Action, f64)>,
        actions: &'a [Action],
    ) -> Turn<'a> {
        let before = before.as_ref().map(|(observation, action, reward)| Before {
            observation,
            action: *action,
            reward: *reward,
        });
        let (subject, level, limit) = (task.subject, task.level.number, task.max_steps);
        Turn { subject, level, number, limit, observation, before, actions }
    }
}

/// The start of an episode as a player sees it, for inspecting prompts without playing.
#[derive(Clone, Debug)]
pub struct Observed {
    observation: Observation,
    actions: Vec<Action>,
}

impl Observed {
    /// Observes the first state of an episode.
    pub fn first(task: &Task<'_>) -> Observed {
        let game = &task.subject.game;
        let state = game.start(&task.level.level, task.chance());
        Observed { observation: game.observe(&state), actions: choices(game, &state) }
    }

    /// Returns the first turn.
    pub fn turn<'a>(&'a self, task: &Task<'a>) -> Turn<'a> {
        Turn::of(task, 0, &self.observation, &None, &self.actions)
    }
}

/// Returns the actions available in a state: doing nothing, and the keys.
pub(crate) fn choices(game: &Game, state: &State) -> Vec<Action> {
    let keys = game.actions(state).iter().copied().filter(|&action| action != Action::Nil);
    std::iter::once(Action::Nil).chain(keys).collect()
}
