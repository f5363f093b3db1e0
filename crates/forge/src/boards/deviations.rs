//! Deviations from a win: wrong keys at some tick.

use base::Seed;
use engine::{Action, Game, Level, Outcome};

/// The minimum and maximum number of key presses per deviation.
const KEYS: (usize, usize) = (3, 5);

/// A deviation from a win: from a tick of the win, the player presses a different key a few times.
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

    /// Plays a win up to the deviation, and then the deviation. Returns `true` if the player loses during the deviation.
    /// Costs a replay of a part of the win.
    pub(super) fn kills(&self, game: &Game, level: &Level, win: &[Action], seed: Seed) -> bool {
        let mut state = game.start(level, seed);
        let keys = win[..self.tick].iter().copied().chain([self.key; KEYS.1].into_iter().take(self.presses));
        let mut outcomes = keys.map(|key| game.step(&mut state, key));
        outcomes.find(|outcome| *outcome != Outcome::Ongoing).is_some_and(|outcome| outcome != Outcome::Won)
    }
}
