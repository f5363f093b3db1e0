//! The interactions without which a board is not won, or not as soon.

use super::shortest::{Limits, shortest_win};
use base::Seed;
use engine::{Action, Analysis, Level, Outcome};
use std::collections::BTreeMap;

/// A win without an interaction that takes so many hundredths of the ticks, or more, is a different win.
const LONGER: usize = 115;

/// The games without one of the interactions, with their analyses.
pub(super) struct Ablations {
    without: BTreeMap<usize, Analysis>,
}

impl Ablations {
    /// Cost: an analysis for each interaction.
    pub(super) fn of(analysis: &Analysis) -> Ablations {
        let game = analysis.game();
        let lines = 0..game.description().interactions.len();
        Ablations { without: lines.map(|line| (line, Analysis::of(&game.without(line)))).collect() }
    }

    /// Tests whether a win of a level needs an interaction: without it the actions do not win, and no win is found that is about
    /// as short. Also returns the calls that it cost.
    pub(super) fn needs(
        &self,
        line: usize,
        level: &Level,
        win: &[Action],
        seed: Seed,
        calls: u64,
    ) -> (bool, u64) {
        let Some(analysis) = self.without.get(&line) else { return (false, 0) };
        let game = analysis.game();
        let start = game.start(level, seed);
        let mut state = start.clone();
        let mut played = 0;
        for &action in win {
            played += 1;
            match game.step(&mut state, action) {
                Outcome::Ongoing => {}
                Outcome::Won => return (false, played),
                _ => break,
            }
        }
        let ticks = (win.len() * LONGER).div_ceil(100).saturating_sub(1);
        let found = shortest_win(analysis, &start, Limits { calls, ticks });
        (found.win.is_none(), played + found.calls)
    }
}
