//! Games with one interaction disabled, to measure the interaction's effect.
//!
//! The disabled interaction still occurs and draws the same random numbers, but has no consequences. The
//! random-number stream does not shift, so episodes in the two games are identical up to the interaction's first
//! consequence.

use crate::game::Game;
use crate::rules::{EffectInfo, Rules};
use base::Digest;
use std::sync::OnceLock;

impl Game {
    /// Returns the game in which interaction `line` (an index into
    /// [`Description::interactions`](crate::Description)) draws its random numbers but has no consequences. A
    /// level that fits one of the two games also fits the other. The returned game's digest is not that of
    /// any text. Cost: one copy of the rules.
    ///
    /// # Panics
    /// Panics if the game has no such interaction.
    pub fn without(&self, line: usize) -> Game {
        assert!(line < self.description().interactions.len(), "interaction {line} is one of the game's");
        let mut rules = Rules { all_warnings: OnceLock::new(), ..self.0.rules.clone() };
        for info in rules.effects.iter_mut().filter(|info| info.line == line) {
            *info = EffectInfo {
                apply_score: false,
                score_faults: info.score_faults,
                in_batch: info.in_batch,
                steady: info.steady,
                line,
                ..EffectInfo::of(info.effect.disabled())
            };
        }
        for timed in rules.timed.iter_mut().filter(|timed| timed.line == line) {
            timed.score_change = 0;
            timed.apply_score = false;
        }
        rules.digest = Digest::of(format!("{} without interaction {line}", rules.digest).as_bytes());
        Game::of(rules)
    }
}
