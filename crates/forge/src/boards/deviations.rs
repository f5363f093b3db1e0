//! Wrong choices: deviations from a win, and their consequences.

use super::shortest::{Limits, shortest_win};
use base::Seed;
use engine::{Action, Analysis, Game, Level, Outcome, State};

/// The minimum and maximum number of key presses per deviation.
const KEYS: (usize, usize) = (3, 5);

/// A deviation from a win: at one tick, the player presses a wrong key and repeats it a few times.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deviation {
    tick: usize,
    key: Action,
    presses: usize,
}

impl Deviation {
    /// Draws up to `count` deviations from a win, at evenly spaced ticks. Costs one replay of the win.
    pub(super) fn draw(
        game: &Game,
        level: &Level,
        win: &[Action],
        seed: Seed,
        count: usize,
    ) -> Vec<Deviation> {
        let mut sampler = seed.child("deviations", 0).sampler();
        let mut state = game.start(level, seed);
        let mut played = 0;
        let draw = |at: usize| {
            let tick = at * win.len() / count.max(1);
            while played < tick {
                game.step(&mut state, win[played]);
                played += 1;
            }
            let actions = game.actions(&state).iter().copied();
            let others: Vec<Action> = actions.filter(|&action| action != win[tick]).collect();
            let key = (!others.is_empty()).then(|| *sampler.choose(&others))?;
            Some(Deviation { tick, key, presses: sampler.between(KEYS.0, KEYS.1) })
        };
        (0..count).filter_map(draw).collect()
    }

    /// Plays a win up to the deviation, and then the deviation itself. Returns the resulting state and outcome. Costs
    /// at most one replay of the win.
    pub(super) fn play(&self, game: &Game, level: &Level, win: &[Action], seed: Seed) -> (State, Outcome) {
        let mut state = game.start(level, seed);
        let keys = win[..self.tick].iter().copied().chain([self.key; KEYS.1].into_iter().take(self.presses));
        let mut outcome = Outcome::Ongoing;
        for key in keys {
            outcome = game.step(&mut state, key);
            if outcome != Outcome::Ongoing {
                break;
            }
        }
        (state, outcome)
    }

    /// Returns `true` if the player loses during the deviation.
    pub(super) fn kills(&self, game: &Game, level: &Level, win: &[Action], seed: Seed) -> bool {
        !matches!(self.play(game, level, win, seed).1, Outcome::Ongoing | Outcome::Won)
    }
}

/// The consequences of deviations from a win.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Costs {
    /// The fraction of deviations after which the player is dead or no win is found.
    pub(super) traps: f64,
    /// The fraction of deviations after which the player is dead.
    pub(super) deaths: f64,
    /// The tick of the last deviation that has a cost, as a fraction of the tick of the last deviation tried.
    pub(super) last: f64,
    /// The number of forward-model calls spent on testing the deviations.
    pub(super) calls: u64,
}

/// Measures the consequences of deviations. After each deviation, a search looks for a win within the limits.
pub(super) fn costs(
    deviations: &[Deviation],
    analysis: &Analysis,
    level: &Level,
    win: &[Action],
    seed: Seed,
    limits: Limits,
) -> Costs {
    let mut costs = Costs::default();
    let (mut trapped, mut dead, mut last) = (0, 0, 0);
    for deviation in deviations {
        let is_trapped = match deviation.play(analysis.game(), level, win, seed) {
            (_, Outcome::Won) => false,
            (state, Outcome::Ongoing) => {
                let found = shortest_win(analysis, &state, limits);
                costs.calls += found.calls;
                found.win.is_none()
            }
            _ => {
                dead += 1;
                true
            }
        };
        if is_trapped {
            trapped += 1;
            last = deviation.tick;
        }
    }
    let latest = deviations.last().map_or(0, |deviation| deviation.tick).max(1);
    let share = |count: usize| count as f64 / deviations.len().max(1) as f64;
    Costs { traps: share(trapped), deaths: share(dead), last: last as f64 / latest as f64, ..costs }
}
