//! Recordings of a fixed exploring player, and the kinds of events in them.

use super::masked::MaskedGame;
use super::seen::{Seen, Viewer};
use super::task::WorldModelTask;
use agents::TouchEverything;
use base::Seed;
use engine::{Action, Level, SpriteType, State};

/// The reciprocal of the probability that the exploring player chooses a random action. Without random actions, its
/// episodes would be alike.
const RANDOM_ODDS: usize = 4;

base::named_enum! {
    /// The most important event in a transition. The kinds are listed from least to most important.
    pub enum TransitionKind {
        /// Nothing visible changed.
        Nothing = "nothing",
        /// The player's sprite moved, and nothing else changed.
        PlayerMoved = "player moved",
        /// Another sprite moved.
        SpriteMoved = "sprite moved",
        /// Sprites appeared, disappeared or changed their type, or the player's resources or health changed.
        Changed = "something changed",
        /// The score or the outcome changed.
        Result = "score or outcome",
    }
}

/// A recorded episode.
#[derive(Clone, Debug)]
pub(super) struct Recording {
    /// The index of the level in the masked game.
    pub(super) level: usize,
    pub(super) actions: Vec<Action>,
    /// The observations: one before the first action, and one after each action.
    pub(super) seen: Vec<Seen>,
    /// The kind of each transition.
    pub(super) kinds: Vec<TransitionKind>,
}

/// Records episodes on each level in turn. The exploring player starts each episode without experience. In every second
/// round through the levels, a random walk is recorded instead, because it does things that a player has no reason to
/// do.
pub(super) fn record(
    masked: &MaskedGame,
    viewer: &Viewer,
    episodes: u64,
    steps: usize,
    seed: Seed,
) -> Vec<Recording> {
    let record = |episode: u64| {
        let level = episode as usize % masked.levels.len();
        let is_walk = (episode as usize / masked.levels.len()) % 2 == 1;
        let seed = seed.child("episode", episode);
        let (mut player, mut sampler) = (TouchEverything::new(seed.child("player", 0)), seed.sampler());
        let mut state = start(viewer, &masked.levels[level].level);
        let mut recording = Recording::new(viewer, level, &state);
        while recording.actions.len() < steps && !state.is_over() {
            let keys = viewer.game.actions(&state);
            let chosen = player.act(&viewer.game.observe(&state), keys, 1).first().copied();
            let action = match (is_walk, recording.actions.last()) {
                (true, Some(&last)) if sampler.ratio(1, 2) => last,
                (false, _) if !sampler.ratio(1, RANDOM_ODDS) => chosen.unwrap_or(Action::Nil),
                _ => *sampler.choose(&Action::ALL),
            };
            recording.step(viewer, &mut state, if keys.contains(&action) { action } else { Action::Nil });
        }
        recording
    };
    (0..episodes).map(record).collect()
}

/// Starts a level. The true game's levels are deterministic, so the seed matters only to games written by the examined
/// player.
pub(super) fn start(viewer: &Viewer, level: &Level) -> State {
    viewer.game.start(level, Seed::from_text("world model"))
}

impl Recording {
    /// Plays actions from the start of a level until the episode is over, and records them.
    pub(super) fn of_actions(task: &WorldModelTask, level: usize, actions: &[Action]) -> Recording {
        let viewer = Viewer::new(&task.masked.game, &task.names);
        let mut state = start(&viewer, &task.masked.levels[level].level);
        let mut recording = Recording::new(&viewer, level, &state);
        for &action in actions {
            if state.is_over() {
                break;
            }
            recording.step(&viewer, &mut state, action);
        }
        recording
    }

    fn new(viewer: &Viewer, level: usize, first: &State) -> Recording {
        Recording { level, actions: Vec::new(), seen: vec![viewer.see(first)], kinds: Vec::new() }
    }

    fn step(&mut self, viewer: &Viewer, state: &mut State, action: Action) {
        let before = state.clone();
        viewer.game.step(state, action);
        let seen = viewer.see(state);
        let last = self.seen.last().expect("the first observation is there");
        self.kinds.push(kind(viewer, (&before, last), (state, &seen)));
        self.actions.push(action);
        self.seen.push(seen);
    }

    /// Plays the actions in another game, and calls `each` with the index of each transition and the observation after
    /// it, until `each` returns `false`.
    pub(super) fn replay(&self, viewer: &Viewer, level: &Level, mut each: impl FnMut(usize, &Seen) -> bool) {
        let mut state = start(viewer, level);
        for (number, &action) in self.actions.iter().enumerate() {
            viewer.game.step(&mut state, action);
            if !each(number, &viewer.see(&state)) {
                return;
            }
        }
    }
}

/// Returns the kind of a transition, from the states and observations before and after it.
fn kind(viewer: &Viewer, before: (&State, &Seen), after: (&State, &Seen)) -> TransitionKind {
    let ((old, seen), (new, now)) = (before, after);
    if seen.score != now.score || seen.outcome != now.outcome {
        return TransitionKind::Result;
    }
    let shown = |stype: &SpriteType| !viewer.game.is_hidden(*stype);
    let counts = |state: &State| {
        viewer.game.sprite_types().filter(shown).map(|stype| state.rects(stype).count()).collect::<Vec<_>>()
    };
    if counts(old) != counts(new) || seen.resources != now.resources || seen.health != now.health {
        return TransitionKind::Changed;
    }
    let avatar = new.avatar_type();
    let others = |state: &State| {
        let others = viewer.game.sprite_types().filter(|stype| shown(stype) && Some(*stype) != avatar);
        others.map(|stype| state.rects(stype).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    match seen.board == now.board {
        true => TransitionKind::Nothing,
        false if others(old) != others(new) => TransitionKind::SpriteMoved,
        false => TransitionKind::PlayerMoved,
    }
}
