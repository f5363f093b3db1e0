//! Simulations of evaluations under the model in [`Design`]. They measure the coverage of intervals and the error
//! rates of tests. `cargo xtask simulate` prints full tables, and the tests of this crate run small simulations.

use crate::comparisons::stratified::{Stratum, stratified};
use crate::intervals::clustered::clustered_mean;
use crate::intervals::over_games::{paired_over_games, rate_over_games};
use crate::intervals::wilson::{Z95, wilson};
use crate::planning::design::{Design, Spread, logistic};
use crate::planning::draws::Draws;

/// The coverage of several intervals: the fraction of simulated evaluations whose nominal 95% interval
/// contains the true win rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// The coverage of [`rate_over_games`].
    pub over_games: f64,
    /// The coverage of the percentile bootstrap over entire games.
    pub bootstrap: f64,
    /// The coverage of [`wilson`], which treats episodes as independent.
    pub episodes: f64,
}

/// The power of several tests: the fraction of simulated evaluations in which a test at the 5% level
/// distinguishes two players.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detections {
    /// The power of [`paired_over_games`].
    pub over_games: f64,
    /// The power of the exact test within levels, [`stratified`].
    pub within_levels: f64,
}

/// The dependence between a player's episodes on the same level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Episodes {
    /// The episodes are independent, given the probability of winning.
    Independent,
    /// All episodes are copies of the first episode, as for a greedy player on a deterministic level.
    Copies,
}

/// The number of bootstrap resamples.
const RESAMPLES: usize = 400;

/// A random sequence of evaluations, determined by its seed.
pub struct Simulation {
    draws: Draws,
    design: Design,
    spread: Spread,
}

impl Simulation {
    /// Creates a simulation.
    pub fn new(design: Design, spread: Spread, seed: u64) -> Simulation {
        Simulation { draws: Draws::new(seed), design, spread }
    }

    /// Returns the intervals' coverage for a player with the given win rate. Cost: O(trials · (episodes +
    /// games · resamples)).
    pub fn coverage(&mut self, rate: f64, trials: u64) -> Coverage {
        let ability = self.spread.ability(rate);
        let mut covered = [0u64; 3];
        for trial in 0..trials {
            let games: Vec<(u64, u64)> = (self.evaluation([ability; 2], Episodes::Independent).iter())
                .map(|levels| {
                    let won = levels.iter().map(|level| level.successes[0]).sum();
                    (won, levels.iter().map(|level| level.trials[0]).sum())
                })
                .collect();
            let shares: Vec<Vec<f64>> = games
                .iter()
                .map(|(won, of)| (0..*of).map(|one| f64::from(u8::from(one < *won))).collect())
                .collect();
            let (won, of) = games.iter().fold((0, 0), |sum, game| (sum.0 + game.0, sum.1 + game.1));
            let mut seed = [0; 32];
            seed[..8].copy_from_slice(&trial.to_le_bytes());
            let intervals = [
                rate_over_games(&games, 0.95).map(|found| found.interval),
                clustered_mean(&shares, RESAMPLES, 0.95, seed),
                Some(wilson(won, of, Z95)),
            ];
            for (count, interval) in covered.iter_mut().zip(intervals) {
                *count += u64::from(interval.is_some_and(|found| found.low <= rate && rate <= found.high));
            }
        }
        let [over_games, bootstrap, episodes] = covered.map(|count| count as f64 / trials as f64);
        Coverage { over_games, bootstrap, episodes }
    }

    /// Returns the fraction of evaluations that distinguish two players with the given win rates. Cost:
    /// O(trials · episodes²).
    pub fn detections(&mut self, rates: [f64; 2], episodes: Episodes, trials: u64) -> Detections {
        let abilities = rates.map(|rate| self.spread.ability(rate));
        let mut found = [0u64; 2];
        for _ in 0..trials {
            let games = self.evaluation(abilities, episodes);
            let mean = |levels: &Vec<Stratum>, side: usize| {
                let rate = |level: &Stratum| level.successes[side] as f64 / level.trials[side] as f64;
                levels.iter().map(rate).sum::<f64>() / levels.len() as f64
            };
            let pairs: Vec<[f64; 2]> =
                games.iter().map(|levels| [mean(levels, 0), mean(levels, 1)]).collect();
            let all: Vec<Stratum> = games.into_iter().flatten().collect();
            let p = [paired_over_games(&pairs, 0.95).map_or(1.0, |found| found.p), stratified(&all).p];
            for (count, p) in found.iter_mut().zip(p) {
                *count += u64::from(p <= 0.05);
            }
        }
        let [over_games, within_levels] = found.map(|count| count as f64 / trials as f64);
        Detections { over_games, within_levels }
    }

    /// Simulates an evaluation of two players. Returns the results on the levels of each game.
    fn evaluation(&mut self, abilities: [f64; 2], episodes: Episodes) -> Vec<Vec<Stratum>> {
        let Design { games, levels, runs } = self.design;
        let game = |this: &mut Simulation| {
            let game = this.spread.games * this.draws.normal();
            let fit = [0, 1].map(|_| this.spread.matches * this.draws.normal());
            let level = |this: &mut Simulation| {
                let level = game + this.spread.levels * this.draws.normal();
                let wins = [0, 1].map(|side: usize| {
                    let chance = logistic(abilities[side] + level + fit[side]);
                    match episodes {
                        Episodes::Independent => this.draws.successes(chance, runs),
                        Episodes::Copies => u64::from(this.draws.uniform() < chance) * runs,
                    }
                });
                Stratum { successes: wins, trials: [runs; 2] }
            };
            (0..levels).map(|_| level(this)).collect()
        };
        (0..games).map(|_| game(self)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simulation(games: u64, matches: f64) -> Simulation {
        Simulation::new(Design { games, levels: 5, runs: 5 }, Spread { matches, ..Spread::default() }, 30)
    }

    /// With a thousand evaluations, a fraction of 95% has a standard error of 0.7 percentage points.
    #[test]
    fn intervals_cover_from_six_games_on() {
        for (rate, games) in [(0.07, 6), (0.07, 18), (0.5, 6), (0.5, 18), (0.9, 6), (0.9, 30)] {
            let found = simulation(games, 0.0).coverage(rate, 1000);
            assert!((0.91..=0.975).contains(&found.over_games), "{rate} on {games} games: {found:?}");
            assert!(found.episodes < 0.8, "{rate} on {games} games: {found:?}");
        }
    }

    /// The limit is 5% plus two standard errors of 0.7 percentage points. The test within levels makes claims only
    /// about the levels that were played.
    #[test]
    fn equal_players_are_seldom_told_apart() {
        for (games, episodes) in [(6, Episodes::Independent), (18, Episodes::Copies)] {
            let found = simulation(games, 1.2).detections([0.5, 0.5], episodes, 1000);
            assert!(found.over_games < 0.065, "{games} games: {found:?}");
            assert!(found.within_levels > 0.15, "{games} games: {found:?}");
        }
    }

    #[test]
    fn power_is_as_stated() {
        for (design, rates) in [
            (Design { games: 6, levels: 5, runs: 5 }, [0.6, 0.3]),
            (Design { games: 30, levels: 5, runs: 1 }, [0.3, 0.15]),
            (Design { games: 60, levels: 1, runs: 1 }, [0.6, 0.35]),
        ] {
            let stated = design.power(rates, Spread::default(), 0.05);
            let found =
                Simulation::new(design, Spread::default(), 31).detections(rates, Episodes::Independent, 1000);
            assert!((found.over_games - stated).abs() < 0.05, "{design:?}: {stated} stated, {found:?}");
        }
    }
}
