//! Simulations of players that replay published solutions, and of players without memory. They measure how
//! often [`coin_test`] flags each kind of player.

use crate::comparisons::contamination::{Memoriser, coin_test};
use crate::planning::design::{Spread, logistic};
use crate::planning::draws::Draws;

/// A simulated player, and the conditions under which it plays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemoryTrial {
    /// The simulated player.
    pub player: Memoriser,
    /// The decrease in ability caused by new names, in logits. Neither of the two renamings of a game (siblings) uses
    /// the names that the player knows.
    pub hurt: f64,
    /// The standard deviation, in logits, of the decrease in ability across different sets of names for the same
    /// game.
    pub names: f64,
    /// The standard deviations of game, level and match effects.
    pub spread: Spread,
}

impl MemoryTrial {
    /// Returns the power of the test on siblings (two renamings of a game, of which a random choice published one). The
    /// power is the fraction of `trials` in which the test has p ≤ `alpha`. There are `pairs` random choices, each with
    /// one episode per renaming.
    pub fn siblings(&self, pairs: usize, alpha: f64, trials: u64, seed: u64) -> f64 {
        let mut draws = Draws::new(seed);
        let ability = self.spread.ability(self.player.clean);
        let Spread { games, levels, matches } = self.spread;
        let all = (games * games + levels * levels + matches * matches).sqrt();
        let mut pair = || {
            let logit = ability - self.hurt + all * draws.normal();
            let clean = [0, 1].map(|_| logistic(logit + self.names * draws.normal()));
            let is_known = draws.uniform() < self.player.share;
            let published = if is_known { self.player.known } else { clean[0] };
            draws.successes(published, 1) as i64 - draws.successes(clean[1], 1) as i64
        };
        flagged(trials, alpha, || (0..pairs).map(|_| pair()).collect())
    }

    /// Returns the power of the test on siblings (two renamings of a game) if each random choice applies to several
    /// pairs of episodes. `pairs` contains the number of pairs for each choice. These pairs are the levels of a game,
    /// which share the game's difficulty and names.
    pub fn sibling_games(&self, pairs: &[u64], alpha: f64, trials: u64, seed: u64) -> f64 {
        let mut draws = Draws::new(seed);
        let ability = self.spread.ability(self.player.clean);
        let Spread { games, levels, matches } = self.spread;
        let of_game = (games * games + matches * matches).sqrt();
        let mut coin = |pairs: u64| {
            let logit = ability - self.hurt + of_game * draws.normal();
            let [published, sealed] = [0, 1].map(|_| logit + self.names * draws.normal());
            let mut difference = 0;
            for _ in 0..pairs {
                let level = levels * draws.normal();
                let is_known = draws.uniform() < self.player.share;
                let chance = if is_known { self.player.known } else { logistic(published + level) };
                difference += draws.successes(chance, 1) as i64;
                difference -= draws.successes(logistic(sealed + level), 1) as i64;
            }
            difference
        };
        flagged(trials, alpha, || pairs.iter().map(|pairs| coin(*pairs)).collect())
    }

    /// Returns the power of the witness prefix test, with one episode on each of `levels` levels. Without
    /// memory, an episode begins like each of the two witnesses with probability `by_chance`.
    pub fn prefixes(&self, levels: usize, by_chance: f64, alpha: f64, trials: u64, seed: u64) -> f64 {
        let mut draws = Draws::new(seed);
        let mut level = || {
            if draws.uniform() < self.player.share {
                return 1;
            }
            let drawn = draws.uniform();
            i64::from(drawn < by_chance) - i64::from(drawn > 1.0 - by_chance)
        };
        flagged(trials, alpha, || (0..levels).map(|_| level()).collect())
    }
}

fn flagged(trials: u64, alpha: f64, mut differences: impl FnMut() -> Vec<i64>) -> f64 {
    let count = (0..trials).filter(|_| coin_test(&differences()).p <= alpha).count();
    count as f64 / trials as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparisons::contamination::coin_power;

    fn trial(share: f64) -> MemoryTrial {
        let player = Memoriser { share, known: 0.9, clean: 0.27 };
        MemoryTrial { player, hurt: 1.0, names: 0.5, spread: Spread::default() }
    }

    /// A player without memory whose ability suffers from new names is flagged in at most 1% of the trials.
    #[test]
    fn clean_players_are_seldom_flagged() {
        let found = trial(0.0).siblings(100, 0.01, 10_000, 1);
        assert!(found <= 0.01, "{found}");
        let found = trial(0.0).prefixes(200, 0.07, 0.01, 10_000, 2);
        assert!(found <= 0.01, "{found}");
    }

    #[test]
    fn memorisers_are_found() {
        let found = trial(0.2).prefixes(200, 0.07, 0.01, 1000, 3);
        assert!(found >= 0.9, "{found}");
        let found = MemoryTrial { hurt: 0.0, ..trial(0.5) }.siblings(100, 0.01, 1000, 4);
        assert!(found >= 0.95, "{found}");
    }

    /// Several levels of the same game are less informative than levels from different games. The test's error rate
    /// stays at or below its significance level.
    #[test]
    fn games_of_several_levels() {
        let known = MemoryTrial { hurt: 0.0, ..trial(0.5) };
        let [apart, together] =
            [vec![1; 60], vec![5; 12]].map(|pairs| known.sibling_games(&pairs, 0.01, 1000, 6));
        assert!(apart > together && together > 0.3, "{apart} {together}");
        let alone = known.siblings(60, 0.01, 1000, 7);
        assert!((apart - alone).abs() < 0.06, "{apart} {alone}");
        let clean = trial(0.0).sibling_games(&[5; 40], 0.01, 4000, 8);
        assert!(clean <= 0.014, "{clean}");
    }

    /// The predicted power matches the simulated power.
    #[test]
    fn power_is_as_stated() {
        let trial = MemoryTrial { hurt: 0.0, names: 0.0, ..trial(0.3) };
        let (more, less) = trial.player.sibling_chances(trial.spread);
        let (stated, found) = (coin_power(100, more, less, 0.01), trial.siblings(100, 0.01, 2000, 5));
        assert!((stated - found).abs() < 0.05, "{stated} stated, {found}");
    }
}
