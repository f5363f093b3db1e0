//! Recordings of episodes.

use super::Case;
use base::{Sampler, Seed};
use engine::{Action, Meeting, Outcome, SpriteRecord, SpriteType, State, Watch};

/// The state at the end of a tick.
pub struct Frame {
    /// All sprites, including dead avatars, sorted by creation number.
    pub sprites: Vec<SpriteRecord>,
    /// The interactions executed in the tick.
    pub meetings: Vec<Meeting>,
    /// The indices of the executed interaction lines.
    pub lines: Vec<usize>,
    /// The type of the avatar.
    pub avatar: Option<SpriteType>,
    /// The outcome of the episode so far.
    pub outcome: Outcome,
    /// The score at the end of the tick.
    pub score: f64,
    /// The counters' values.
    pub counters: Vec<i32>,
}

/// A recorded episode. It has one more frame than actions, because the first frame is the initial state.
pub struct Play {
    /// The seed for the game's randomness.
    pub seed: Seed,
    /// The episode's actions.
    pub actions: Vec<Action>,
    /// The initial state, and the state at the end of each tick.
    pub frames: Vec<Frame>,
    /// The size of a cell.
    pub block: i32,
}

#[derive(Default)]
struct Seen {
    meetings: Vec<Meeting>,
    lines: Vec<usize>,
}

/// The maximum number of recorded meetings per tick.
const MEETINGS: usize = 1000;

impl Watch for Seen {
    fn interaction(&mut self, line: usize) {
        if self.lines.last() != Some(&line) && self.lines.len() < MEETINGS {
            self.lines.push(line);
        }
    }

    fn wants_meetings(&self) -> bool {
        self.meetings.len() < MEETINGS
    }

    fn meeting(&mut self, meeting: Meeting) {
        self.meetings.push(meeting);
    }
}

/// The maximum number of sprites in a recorded state, beyond which recording stops.
const SPRITES: usize = 400;

impl Play {
    /// Plays until the episode is over, `choose` returns no action, or there are too many sprites.
    pub fn record(case: &Case, seed: Seed, mut choose: impl FnMut(&State) -> Option<Action>) -> Play {
        let game = &case.game;
        let mut state = game.start(&case.level, seed);
        let frame = |state: &State, seen: Seen| Frame {
            sprites: game.records(state),
            meetings: seen.meetings,
            lines: seen.lines,
            avatar: state.avatar_type(),
            outcome: state.outcome(),
            score: state.score(),
            counters: state.counters().to_vec(),
        };
        let frames = vec![frame(&state, Seen::default())];
        let mut play = Play { seed, actions: Vec::new(), frames, block: state.block() };
        while !state.is_over() && play.frames.last().is_some_and(|last| last.sprites.len() <= SPRITES) {
            let Some(action) = choose(&state) else { break };
            let mut seen = Seen::default();
            game.step_watched(&mut state, action, &mut seen);
            play.actions.push(action);
            play.frames.push(frame(&state, seen));
        }
        play
    }

    /// Plays the given actions.
    pub fn of(case: &Case, seed: Seed, actions: &[Action]) -> Play {
        let mut actions = actions.iter().copied();
        Play::record(case, seed, |_| actions.next())
    }

    /// Plays at random. Keys are often held down, as human players hold them.
    pub fn random(case: &Case, seed: Seed, ticks: usize) -> Play {
        let mut sampler = seed.child("actions", 0).sampler();
        let (mut held, mut left, mut played) = (Action::Nil, 0, 0);
        Play::record(case, seed, |state| {
            played += 1;
            if left == 0 {
                held = *sampler.choose(case.game.actions(state));
                left = sampler.between(1, 5);
            }
            left -= 1;
            (played <= ticks).then_some(held)
        })
    }

    /// Plays towards one of the terminations by looking one step ahead. Plays at random otherwise.
    pub fn greedy(case: &Case, seed: Seed, ticks: usize) -> Play {
        let mut sampler = seed.child("actions", 1).sampler();
        let goals = case.analysis.goals();
        let goal = (!goals.is_empty()).then(|| sampler.below(goals.len()));
        let mut played = 0;
        Play::record(case, seed, |state| {
            played += 1;
            let actions = case.game.actions(state);
            let random = |sampler: &mut Sampler| *sampler.choose(actions);
            let Some(goal) = goal.filter(|_| played % 3 > 0 && actions.len() > 1) else {
                return (played <= ticks).then(|| random(&mut sampler));
            };
            let missing = |action: Action| {
                let mut next = state.fork(seed.child("fork", played as u64));
                case.game.step(&mut next, action);
                case.analysis.missing(&goals[goal], &next)
            };
            let now = case.analysis.missing(&goals[goal], state);
            let better = actions.iter().copied().find(|&action| missing(action) < now);
            let action = better.unwrap_or_else(|| random(&mut sampler));
            (played <= ticks).then_some(action)
        })
    }
}

/// Returns episodes of a case: idle episodes, random episodes, and episodes that play towards the
/// terminations. For some cases, also returns a long episode.
pub fn plays(case: &Case, seed: Seed) -> Vec<Play> {
    let mut sampler = seed.child("plays", 0).sampler();
    let mut plays = vec![
        Play::of(case, seed.child("idle", 0), &[Action::Nil; 12]),
        Play::random(case, seed.child("random", 0), 40),
        Play::random(case, seed.child("random", 1), 40),
        Play::greedy(case, seed.child("greedy", 0), 30),
    ];
    if sampler.ratio(1, 8) {
        plays.push(Play::random(case, seed.child("random", 2), 260));
        plays.push(Play::greedy(case, seed.child("greedy", 1), 60));
    }
    plays
}
