//! The derivatives of the marginal likelihood with respect to the parameters of the spreads (standard deviations). Each
//! derivative requires one pass over the results. The dependence of the modes on the spreads is handled by the adjoint
//! method, which solves one linear system for all parameters.

use super::{Model, Posterior};
use crate::scale::logistic::logistic;
use crate::scale::plays::Dimension;
use crate::scale::spreads::{PLANNERS_ONLY, Spreads, WITH_READERS};
use arrayvec::ArrayVec;
use nalgebra::{DMatrix, DVector};

/// Values for the results of one examinee (reference player) on a level, evaluated at the mode.
struct Place {
    rest: f64,
    weight: f64,
    /// The derivative of the weight with respect to the logit, multiplied by the logit's variance.
    bend: f64,
    /// The covariances between the logit and the game effects that appear as terms of the logit.
    covariances: ArrayVec<f64, 6>,
}

impl Model<'_> {
    /// Returns the derivatives of the marginal likelihood with respect to the parameters of the spreads (standard
    /// deviations). They are evaluated at a mode of a model with unknown abilities. Cost: about one step towards the
    /// mode.
    pub(in crate::scale) fn slope(&self, spreads: &Spreads, posterior: &Posterior) -> Vec<f64> {
        let shared = &posterior.modes.shared;
        let mut pull = DVector::<f64>::zeros(shared.len());
        let mut pulls = Vec::with_capacity(self.games.len());
        let mut places = Vec::with_capacity(self.games.len());
        for (game, own) in posterior.modes.games.iter().enumerate() {
            let gain = &posterior.gains[game];
            let by_shared = gain * &posterior.covariance;
            let covariance: DMatrix<f64> =
                posterior.curvature.games[game].within.inverse() + &by_shared * gain.transpose();
            let mut own_pull = DVector::<f64>::zeros(own.len());
            let of_row = |row: &super::Row| {
                let chance = logistic(row.logit(shared, own));
                let covariances: ArrayVec<f64, 6> = (row.own.iter())
                    .map(|&(at, _)| {
                        let within = row.own.iter().map(|&(other, b)| b * covariance[(at, other)]);
                        let with = row.shared.iter().map(|&(other, b)| b * by_shared[(at, other)]);
                        within.sum::<f64>() - with.sum::<f64>()
                    })
                    .collect();
                let own_variance: f64 =
                    row.own.iter().zip(&covariances).map(|((_, a), covariance)| a * covariance).sum();
                let shared_variance: f64 = (row.shared.iter())
                    .map(|&(at, a)| {
                        let with = row.own.iter().map(|&(other, b)| b * by_shared[(other, at)]);
                        let among =
                            row.shared.iter().map(|&(other, b)| b * posterior.covariance[(at, other)]);
                        a * (among.sum::<f64>() - with.sum::<f64>())
                    })
                    .sum();
                let weight = row.of * chance * (1.0 - chance);
                let bend = weight * (1.0 - 2.0 * chance) * (own_variance + shared_variance);
                row.own.iter().for_each(|&(at, a)| own_pull[at] += a * bend);
                row.shared.iter().for_each(|&(at, a)| pull[at] += a * bend);
                Place { rest: row.won - row.of * chance, weight, bend, covariances }
            };
            places.push(self.rows(spreads, game).iter().map(of_row).collect::<Vec<Place>>());
            pull -= gain.tr_mul(&own_pull);
            pulls.push(own_pull);
        }
        let moved = &posterior.covariance * pull;
        let mut slope = vec![0.0; if self.has_readers { WITH_READERS } else { PLANNERS_ONLY }];
        for (game, own) in posterior.modes.games.iter().enumerate() {
            let own_moved =
                posterior.curvature.games[game].within.solve(&pulls[game]) - &posterior.gains[game] * &moved;
            for (row, place) in self.rows(spreads, game).iter().zip(&places[game]) {
                let by_shared: f64 = row.shared.iter().map(|&(at, a)| a * moved[at]).sum();
                let by_own: f64 = row.own.iter().map(|&(at, a)| a * own_moved[at]).sum();
                let turn = place.bend - place.weight * (by_shared + by_own);
                for (parameter, at, factor) in self.term_slopes(spreads, game, row.examinee, row.level) {
                    let covariance: f64 = (row.own.iter().zip(&place.covariances))
                        .filter(|((other, _), _)| *other == at)
                        .map(|(_, covariance)| covariance)
                        .sum();
                    let determinant =
                        turn * own[at] + 2.0 * place.weight * covariance + place.rest * own_moved[at];
                    slope[parameter] += factor * (place.rest * own[at] - 0.5 * determinant);
                }
            }
        }
        slope
    }

    /// Returns the derivatives of the factors in [`Model::terms`]. Each entry contains the parameter, the
    /// effect's index and the derivative.
    fn term_slopes(
        &self,
        spreads: &Spreads,
        game: usize,
        examinee: usize,
        level: usize,
    ) -> ArrayVec<(usize, usize, f64), 8> {
        let (layout, level) = (&self.layouts[game], 1 + level);
        let mut slopes = ArrayVec::new();
        match self.examinees[examinee].dimension {
            Dimension::Planner => slopes.extend([(0, 0, -spreads.game), (1, level, -spreads.level)]),
            Dimension::Reader => slopes.extend([
                (0, 0, -spreads.game_slope * spreads.game),
                (1, level, -spreads.level_slope * spreads.level),
                (4, 0, -spreads.game),
                (5, level, -spreads.level),
                (6, layout.readers, -spreads.game_rest),
                (7, layout.readers + level, -spreads.level_rest),
            ]),
        }
        match (layout.matches[examinee], self.examinees[examinee].dimension) {
            ((Some(family), Some(own)), _) => {
                slopes.extend([(2, family, spreads.family), (3, own, spreads.planner)])
            }
            ((Some(only), None), _) => {
                let (family, own) = (spreads.family * spreads.family, spreads.planner * spreads.planner);
                let both = (family + own).sqrt();
                slopes.extend([(2, only, family / both), (3, only, own / both)]);
            }
            ((None, Some(own)), _) => slopes.push((8, own, spreads.reader)),
            ((None, None), _) => {}
        }
        slopes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::simulated::{Plan, Simulator};

    /// The derivatives match finite differences, with and without readers (players that see only prompts).
    #[test]
    fn derivatives_are_those_of_differences() {
        for anchors in [0, 2] {
            let spreads = Spreads { game: 1.6, level: 1.2, family: 1.1, planner: 0.7, ..Spreads::default() };
            let plan = Plan {
                games: 8,
                levels: 3,
                families: vec![2, 1, 1],
                runs: 3,
                anchors,
                anchor_runs: 2,
                replicates: 0,
                spreads,
            };
            let mut simulator = Simulator::new(plan, 5);
            let plays = simulator.month(0.3, 0.0).plays;
            let model = Model::new(&simulator.examinees, &plays, None);
            let at = spreads.parameters(model.has_readers());
            let marginal = |parameters: &[f64]| {
                model.posterior(&Spreads::from_parameters(parameters), None).unwrap().marginal
            };
            let found = model.slope(&spreads, &model.posterior(&spreads, None).unwrap());
            assert_eq!(found.len(), at.len());
            for (parameter, derivative) in found.iter().enumerate() {
                let moved = |by: f64| {
                    let mut near = at.clone();
                    near[parameter] += by;
                    marginal(&near)
                };
                let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
                assert!((difference - derivative).abs() < 1e-4, "{parameter}: {derivative} {difference}");
            }
        }
    }
}
