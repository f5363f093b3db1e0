//! Wrong choices: deviations from a win, and their consequences.

use super::shortest::{Limits, shortest_win};
use base::Seed;
use engine::{Action, Analysis, Level, Outcome};

/// The minimum and maximum number of key presses per deviation.
const KEYS: (usize, usize) = (3, 5);

/// The consequences of deviations from a win.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Costs {
    /// The fraction of deviations after which the player is dead or no win is found.
    pub(super) traps: f64,
    /// The fraction of deviations after which the player is dead.
    pub(super) deaths: f64,
    /// The number of forward-model calls.
    pub(super) calls: u64,
}

/// Deviates from a win at `deviations` evenly spaced ticks, and then searches for a win within the limits. Each
/// deviation presses one different key a few times.
pub(super) fn deviate(
    analysis: &Analysis,
    level: &Level,
    win: &[Action],
    seed: Seed,
    deviations: usize,
    limits: Limits,
) -> Costs {
    let game = analysis.game();
    let mut sampler = seed.child("deviations", 0).sampler();
    let mut state = game.start(level, seed);
    let mut costs = Costs::default();
    let (mut tried, mut trapped, mut dead) = (0, 0, 0);
    let mut played = 0;
    for at in 0..deviations {
        let tick = at * win.len() / deviations.max(1);
        while played < tick {
            game.step(&mut state, win[played]);
            played += 1;
        }
        let others: Vec<Action> =
            game.actions(&state).iter().copied().filter(|&action| action != win[tick]).collect();
        if others.is_empty() {
            continue;
        }
        let (key, presses) = (*sampler.choose(&others), sampler.between(KEYS.0, KEYS.1));
        let mut other = state.clone();
        let outcome =
            (0..presses).map(|_| game.step(&mut other, key)).find(|&outcome| outcome != Outcome::Ongoing);
        tried += 1;
        match outcome {
            Some(Outcome::Won) => {}
            Some(_) => {
                dead += 1;
                trapped += 1;
            }
            None => {
                let found = shortest_win(analysis, &other, limits);
                costs.calls += found.calls;
                trapped += usize::from(found.win.is_none());
            }
        }
    }
    let share = |count: usize| count as f64 / tried.max(1) as f64;
    Costs { traps: share(trapped), deaths: share(dead), ..costs }
}
