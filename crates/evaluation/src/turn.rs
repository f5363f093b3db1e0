//! The view of a player at one decision.

use crate::commitment::Commitment;
use crate::run::Task;
use crate::subject::Subject;
use crate::track::SeriesPlace;
use engine::analysis::Avatar;
use engine::{Action, Analysis, Game, Observation, State};

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
    /// The number of actions to commit to.
    pub commit: Commitment,
    /// The current observation.
    pub observation: &'a Observation,
    /// The preceding action, which led to the current observation; `None` at the first decision.
    pub before: Option<Before<'a>>,
    /// The actions since the preceding look, with what came of each.
    pub played: &'a [Played],
    /// The available actions, [`Action::Nil`] first.
    pub actions: &'a [Action],
    /// The place of the level in a series that is played in one conversation; `None` for a level by itself.
    pub series: Option<SeriesView<'a>>,
}

/// The place of a level in a series, and what came before it.
#[derive(Clone, Copy, Debug)]
pub struct SeriesView<'a> {
    /// The place.
    pub place: SeriesPlace,
    /// The end of the level before, unless this is the first.
    pub previous: Option<&'a LevelEnd>,
}

/// The end of a level of a series, as the player has seen it.
#[derive(Clone, Debug)]
pub struct LevelEnd {
    /// The last observation.
    pub last: Observation,
    /// The observation before it, and the action between the two.
    pub before: Option<(Observation, Action)>,
    /// The number of actions played.
    pub steps: u64,
}

/// The preceding action.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The observation before that action.
    pub observation: &'a Observation,
    /// The action played.
    pub action: Action,
    /// The change of the score.
    pub reward: f64,
}

/// An action of a commitment, and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Played {
    /// The action asked for; [`Action::Nil`] where the player gave too few.
    pub asked: Action,
    /// `true` if the action was not available, so that nothing was done.
    pub is_unavailable: bool,
    /// Column and row of the avatar after it, if there is one.
    pub avatar: Option<(i32, i32)>,
    /// The change of the score.
    pub reward: f64,
}

/// The past of an episode as far as the next turn shows it.
#[derive(Debug, Default)]
pub(crate) struct Recent {
    /// The observation before the last action, the action and its reward.
    pub(crate) last: Option<(Observation, Action, f64)>,
    /// The actions since the last look.
    pub(crate) played: Vec<Played>,
}

impl<'a> Turn<'a> {
    /// The turn of an episode after `number` steps.
    pub(crate) fn of(
        task: &Task<'a>,
        number: u64,
        observation: &'a Observation,
        recent: &'a Recent,
        actions: &'a [Action],
        previous: Option<&'a LevelEnd>,
    ) -> Turn<'a> {
        let before = recent.last.as_ref().map(|(observation, action, reward)| Before {
            observation,
            action: *action,
            reward: *reward,
        });
        let Task { subject, max_steps: limit, commit, .. } = *task;
        let (level, played) = (task.level.number, recent.played.as_slice());
        let series = task.series.map(|place| SeriesView { place, previous });
        Turn { subject, level, number, limit, commit, observation, before, played, actions, series }
    }

    /// Returns the number of actions that the decision covers, at least one.
    pub fn due(&self) -> u64 {
        self.commit.due(self.limit.saturating_sub(self.number)).max(1)
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
        const NONE: &Recent = &Recent { last: None, played: Vec::new() };
        Turn::of(task, 0, &self.observation, NONE, &self.actions, None)
    }
}

/// Returns the actions available in a state: doing nothing, and the keys.
pub(crate) fn choices(game: &Game, state: &State) -> Vec<Action> {
    let keys = game.actions(state).iter().copied().filter(|&action| action != Action::Nil);
    std::iter::once(Action::Nil).chain(keys).collect()
}

/// Returns `true` if an action can do something in a game: where nothing can be shot, the use key is no choice.
pub fn is_of_use(analysis: &Analysis, action: Action) -> bool {
    let game = analysis.game();
    let by = |avatar: &Avatar| {
        game.actions_of(avatar.stype).contains(&action) && (action != Action::Use || avatar.has_use())
    };
    action == Action::Nil || analysis.avatars().iter().any(by)
}
