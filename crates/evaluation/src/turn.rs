//! A player's view at one decision.

use crate::commitment::Commitment;
use crate::metrics::EndCause;
use crate::run::Task;
use crate::subject::Subject;
use crate::track::SeriesPlace;
use engine::analysis::Avatar;
use engine::{Action, Analysis, Game, Observation, State};

/// A player's view at one decision: the facts about the entire episode, and an observation of the current
/// state. The state itself is never shown, because a player could use it to look ahead.
#[derive(Clone, Copy, Debug)]
pub struct Turn<'a> {
    /// The game of the episode. A player may read its rules, but not its levels.
    pub subject: &'a Subject,
    /// The level number, for use in logs.
    pub level: usize,
    /// The number of actions played before this decision.
    pub number: u64,
    /// The maximum number of actions per episode.
    pub limit: u64,
    /// The number of actions that the player commits to.
    pub commit: Commitment,
    /// The current observation.
    pub observation: &'a Observation,
    /// The preceding action, which led to the current observation, or `None` at the first decision.
    pub before: Option<Before<'a>>,
    /// The actions since the preceding decision, with their results.
    pub played: &'a [Played],
    /// The available actions, with [`Action::Nil`] first.
    pub actions: &'a [Action],
    /// The level's position in a series of levels played in one conversation, or `None` for a level played
    /// alone.
    pub series: Option<SeriesView<'a>>,
    /// The rules that ended the game, as far as they are known. `None` while the game goes on.
    pub cause: Option<EndCause>,
}

/// A level's position in a series, with the end of the previous level.
#[derive(Clone, Copy, Debug)]
pub struct SeriesView<'a> {
    /// The level's position in the series.
    pub place: SeriesPlace,
    /// The end of the previous level, or `None` for the first level.
    pub previous: Option<&'a LevelEnd>,
}

/// The end of a level in a series, as seen by the player.
#[derive(Clone, Debug)]
pub struct LevelEnd {
    /// The last observation of the level.
    pub last: Observation,
    /// The second-to-last observation, and the action that followed it.
    pub before: Option<(Observation, Action)>,
    /// The number of actions played in the level.
    pub steps: u64,
}

/// The preceding action and its result.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The observation before the action.
    pub observation: &'a Observation,
    /// The action played.
    pub action: Action,
    /// The change in score caused by the action.
    pub reward: f64,
}

/// One of the actions of a decision, with its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Played {
    /// The requested action, or [`Action::Nil`] if the player stated too few actions.
    pub asked: Action,
    /// `true` if the action was unavailable, in which case the player did nothing.
    pub is_unavailable: bool,
    /// The avatar's column and row after the action, if there is an avatar.
    pub avatar: Option<(i32, i32)>,
    /// The change in score caused by the action.
    pub reward: f64,
}

/// The part of an episode's recent past that the next turn shows.
#[derive(Debug, Default)]
pub(crate) struct Recent {
    /// The observation before the last action, the action itself, and its reward.
    pub(crate) last: Option<(Observation, Action, f64)>,
    /// The actions played since the last decision.
    pub(crate) played: Vec<Played>,
}

impl<'a> Turn<'a> {
    /// Creates an episode's turn after `number` actions.
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
        Turn {
            subject,
            level,
            number,
            limit,
            commit,
            observation,
            before,
            played,
            actions,
            series,
            cause: None,
        }
    }

    /// Returns the number of actions in the decision (at least one).
    pub fn due(&self) -> u64 {
        self.commit.due(self.limit.saturating_sub(self.number)).max(1)
    }
}

/// The start of an episode as seen by a player, used to inspect prompts without playing.
#[derive(Clone, Debug)]
pub struct Observed {
    observation: Observation,
    actions: Vec<Action>,
}

impl Observed {
    /// Observes an episode's first state.
    pub fn first(task: &Task<'_>) -> Observed {
        let game = &task.subject.game;
        let state = game.start(&task.level.level, task.chance());
        Observed { observation: game.observe(&state), actions: choices(game, &state) }
    }

    /// Returns the episode's first turn.
    pub fn turn<'a>(&'a self, task: &Task<'a>) -> Turn<'a> {
        const NONE: &Recent = &Recent { last: None, played: Vec::new() };
        Turn::of(task, 0, &self.observation, NONE, &self.actions, None)
    }
}

/// Returns the actions available in a state: doing nothing, and the available keys.
pub(crate) fn choices(game: &Game, state: &State) -> Vec<Action> {
    let keys = game.actions(state).iter().copied().filter(|&action| action != Action::Nil);
    std::iter::once(Action::Nil).chain(keys).collect()
}

/// Returns `true` if an action can have an effect in a game. For example, the use key has no effect if
/// nothing can be shot.
pub fn is_of_use(analysis: &Analysis, action: Action) -> bool {
    let game = analysis.game();
    let by = |avatar: &Avatar| {
        game.actions_of(avatar.stype).contains(&action) && (action != Action::Use || avatar.has_use())
    };
    action == Action::Nil || analysis.avatars().iter().any(by)
}
