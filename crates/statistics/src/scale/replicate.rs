//! The parametric bootstrap of a calibration. In each replicate, the same examinees (reference players) play the same
//! number of new games, which are drawn from the estimated model. If there are few episodes, Laplace's method shrinks
//! the spreads (standard deviations). The replicates measure this shrinkage and the variance of the estimates.

use super::calibration::{Calibration, spreads_of};
use super::logistic::logistic;
use super::plays::{GamePlays, Plays};
use super::posterior::Model;
use super::spreads::Spreads;
use crate::intervals::wilson::{Interval, Z95};
use crate::planning::draws::Draws;

/// A correlation, with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlated {
    /// The estimated correlation.
    pub value: f64,
    /// The correlation's 95% interval.
    pub interval: Interval,
}

impl Calibration {
    /// Simulates the results of the examinees (reference players) on new games drawn from the model, and returns the
    /// spreads (standard deviations) estimated from those results. The new games have the same numbers of levels and
    /// episodes as `games`. Returns `None` if the estimation fails. Cost: one [`Calibration::new`].
    pub fn replicate(&self, games: &[GamePlays], seed: u64) -> Option<Spreads> {
        let mut draws = Draws::new(seed);
        let model = Model::new(&self.examinees, games, None);
        let of_game = |(game, given): (usize, &GamePlays)| {
            let effects: Vec<f64> = (0..model.effects(game)).map(|_| draws.normal()).collect();
            let replay = |plays: &Plays| {
                let terms = model.terms(&self.spreads, game, plays.examinee, plays.level);
                let logit: f64 = terms.iter().map(|&(at, factor)| factor * effects[at]).sum();
                let chance = logistic(self.abilities[plays.examinee] + logit);
                Plays { won: draws.successes(chance, plays.of as u64) as f64, ..*plays }
            };
            GamePlays { levels: given.levels, plays: given.plays.iter().map(replay).collect() }
        };
        let games: Vec<GamePlays> = games.iter().enumerate().map(of_game).collect();
        spreads_of(&Model::new(&self.examinees, &games, None), self.spreads)
    }

    /// Returns the spreads (standard deviations), corrected for the bias found in the replicates. The correction
    /// subtracts the mean bias from logarithms of standard deviations, and from slopes. Without replicates, the spreads
    /// are unchanged.
    pub fn corrected(&self, replicates: &[Spreads]) -> Spreads {
        let has_readers = self.has_readers();
        let found = self.spreads.parameters(has_readers);
        let parameters: Vec<Vec<f64>> = replicates.iter().map(|one| one.parameters(has_readers)).collect();
        let moved = found.iter().enumerate().map(|(at, value)| {
            let mean = parameters.iter().map(|one| one[at]).sum::<f64>() / parameters.len().max(1) as f64;
            if parameters.is_empty() { *value } else { 2.0 * value - mean }
        });
        Spreads::from_parameters(&moved.collect::<Vec<f64>>())
    }

    /// Returns the correlation between level difficulties for planners and for readers (players that see only prompts),
    /// corrected for the bias found in the replicates. The interval is computed on Fisher's scale from the variation
    /// between replicates. Returns `None` if there are no readers, or fewer than two replicates.
    pub fn correlation(&self, replicates: &[Spreads]) -> Option<Correlated> {
        if replicates.len() < 2 || !self.has_readers() {
            return None;
        }
        let scale = |spreads: &Spreads| libm::atanh(spreads.correlation().clamp(-0.9999, 0.9999));
        let found: Vec<f64> = replicates.iter().map(scale).collect();
        let count = found.len() as f64;
        let mean = found.iter().sum::<f64>() / count;
        let variance = found.iter().map(|one| (one - mean) * (one - mean)).sum::<f64>() / (count - 1.0);
        let value = 2.0 * scale(&self.spreads) - mean;
        // The uncertainty of the bias depends on the number of replicates.
        let half = Z95 * (variance + variance / count).sqrt();
        let [low, high] = [value - half, value + half].map(libm::tanh);
        Some(Correlated { value: libm::tanh(value), interval: Interval { low, high } })
    }

    /// Returns `true` if any examinee (reference player) is a reader, which sees only prompts.
    pub fn has_readers(&self) -> bool {
        self.examinees.iter().any(|one| one.dimension == super::Dimension::Reader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::simulated::{Plan, Simulator};

    fn calibrated(anchors: usize) -> (Calibration, Vec<GamePlays>) {
        let spreads = Spreads { game: 1.6, level: 1.6, family: 1.5, ..Spreads::default() };
        let families = vec![1; 4];
        let plan =
            Plan { games: 30, levels: 3, families, runs: 3, anchors, anchor_runs: 3, replicates: 0, spreads };
        let mut simulator = Simulator::new(plan, 3);
        let plays = simulator.month(0.0, 0.0).plays;
        (Calibration::new(&simulator.examinees, &plays).unwrap().0, plays)
    }

    #[test]
    fn correlations_have_intervals() {
        let (found, plays) = calibrated(3);
        let replicates: Vec<Spreads> = (0..6).map(|seed| found.replicate(&plays, seed).unwrap()).collect();
        let correlation = found.correlation(&replicates).unwrap();
        assert!(correlation.interval.low < 0.75 && 0.6 < correlation.interval.high, "{correlation:?}");
        assert!(correlation.interval.low < correlation.value, "{correlation:?}");
        assert_eq!(found.correlation(&replicates[..1]), None);
    }

    #[test]
    fn corrections_move_against_the_bias() {
        let (found, plays) = calibrated(0);
        let all: Vec<Spreads> = (0..3).map(|seed| found.replicate(&plays, seed).unwrap()).collect();
        let corrected = found.corrected(&all);
        let mean = all.iter().map(|one| libm::log(one.game)).sum::<f64>() / 3.0;
        assert!((libm::log(corrected.game) - 2.0 * libm::log(found.spreads.game) + mean).abs() < 1e-12);
        assert_eq!(found.corrected(&[]).game, found.spreads.game);
        assert_eq!(found.correlation(&all), None);
    }
}
