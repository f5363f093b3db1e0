//! Estimation of a player's ability from episodes on levels of known difficulty.
//!
//! The likelihood is integrated by quadrature over three kinds of unknowns: the match effects, which state how well
//! each game suits the player, their standard deviation, and the errors in the difficulties. No distribution is
//! approximated by a normal one, so even a player without wins gets an interval.

use super::logistic::{logistic, softplus};
use crate::intervals::wilson::{Interval, Z95};

/// A player's results on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlayedLevel {
    /// The level's difficulty.
    pub difficulty: f64,
    /// The standard error of the difficulty, without the component that all of the game's levels share.
    pub own: f64,
    /// The number of episodes won.
    pub won: f64,
    /// The number of episodes played. Identical episodes count once.
    pub of: f64,
}

/// A player's results on one game.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlayedGame {
    /// The standard error shared by the difficulties of all of the game's levels.
    pub common: f64,
    /// The results on the game's levels.
    pub levels: Vec<PlayedLevel>,
}

/// The lognormal prior for the standard deviation of a player's match effects, which state how well each game suits
/// the player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MismatchPrior {
    /// The median of the prior, in logits.
    pub median: f64,
    /// The standard deviation of the prior for the natural logarithm of the match effects' standard deviation. A match
    /// effect states how well a game suits the player.
    pub log_sd: f64,
}

impl Default for MismatchPrior {
    fn default() -> MismatchPrior {
        MismatchPrior { median: 1.0, log_sd: 0.7 }
    }
}

/// An estimated ability, with the components of its error. The components satisfy total² = sampling² +
/// mismatch² + link².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ability {
    /// The ability's posterior mean, in logits above the mean difficulty of the first release's levels.
    pub value: f64,
    /// The ability's total standard error.
    pub error: f64,
    /// The error component caused by the limited number of episodes, which is the error that would remain if each
    /// level's difficulty for this player were known.
    pub sampling: f64,
    /// The error component caused by games that suit the player better or worse than others, and by the errors in the
    /// games' difficulties.
    pub mismatch: f64,
    /// The error component caused by the error of the month's position relative to the first release.
    pub link: f64,
    /// The 95% interval of the ability.
    pub interval: Interval,
    /// For the lower end of the interval and for the upper end, `true` if the data determine that end. Without wins,
    /// there is no lower bound; without losses, there is no upper bound.
    pub is_bounded: [bool; 2],
    /// The posterior mean of the standard deviation of the player's match effects, which state how well each game suits
    /// the player.
    pub mismatch_sd: f64,
}

/// The distance between adjacent nodes in the grids of abilities and logits.
pub(super) const STEP: f64 = 0.15;
/// The number of nodes on either side of 0, which limits abilities to ±10.05 logits.
pub(super) const SIDE: i32 = 67;
/// The standard deviation of the prior for an ability.
pub(super) const ABILITY_SD: f64 = 5.0;
/// The grid for the standard deviation of match effects (how well each game suits the player): its smallest node, the
/// ratio between adjacent nodes, and the number of nodes.
const MISMATCHES: (f64, f64, usize) = (0.2, 1.4, 10);
/// The number of standard deviations at which a normal distribution is truncated.
pub(super) const TAIL: f64 = 5.0;
/// The number of parts into which each ability step is divided for computing the interval.
const PARTS: usize = 10;

/// Estimates a player's ability. `link` is the error of the month's position on the scale, which the difficulties of
/// all levels share.
///
/// Returns `None` if there are no episodes, if a number is not finite, or if an entry has more wins than
/// episodes. Cost: O(levels + games) times several thousand.
///
/// ```
/// use infinite_arcade_statistics::scale::{MismatchPrior, PlayedGame, PlayedLevel, ability};
/// let level = |difficulty: f64, won: f64| PlayedLevel { difficulty, own: 0.2, won, of: 4.0 };
/// let game = |won| PlayedGame { common: 0.3, levels: vec![level(-1.0, won), level(1.0, won - 1.0)] };
/// let games: Vec<PlayedGame> = (0..12).map(|at| game(f64::from(at % 3 + 1))).collect();
/// let found = ability(&games, MismatchPrior::default(), 0.1).unwrap();
/// assert!(found.interval.low < -0.2 && -0.5 < found.interval.high, "{found:?}");
/// ```
pub fn ability(games: &[PlayedGame], prior: MismatchPrior, link: f64) -> Option<Ability> {
    let levels = || games.iter().flat_map(|game| &game.levels).filter(|level| level.of > 0.0);
    let is_valid = levels().all(|level| {
        level.difficulty.is_finite()
            && level.own.is_finite()
            && level.of.is_finite()
            && (0.0..=level.of).contains(&level.won)
    });
    let is_valid = is_valid && games.iter().all(|game| game.common.is_finite());
    if levels().next().is_none() || !is_valid || !link.is_finite() {
        return None;
    }
    let density = Density::new(games, prior);
    let (value, variance, mismatch_sd) = density.moments();
    let sampling = density.sampling(value, mismatch_sd).min(variance);
    let [low, high] = density.ends();
    let widened = |end: f64| {
        let (from, by) = (value - end, Z95 * link);
        (from * from + by * by).sqrt()
    };
    let won: f64 = levels().map(|level| level.won).sum();
    let of: f64 = levels().map(|level| level.of).sum();
    Some(Ability {
        value,
        error: (variance + link * link).sqrt(),
        sampling: sampling.sqrt(),
        mismatch: (variance - sampling).max(0.0).sqrt(),
        link,
        interval: Interval { low: value - widened(low), high: value + widened(high) },
        is_bounded: [won > 0.0, won < of],
        mismatch_sd,
    })
}

/// The posterior density on the grids of abilities and of mismatches (standard deviations of match effects).
struct Density<'a> {
    games: &'a [PlayedGame],
    /// The posterior weights, indexed by mismatch (the standard deviation of the match effects) and ability. The
    /// weights sum to 1.
    weights: Vec<Vec<f64>>,
    mismatches: Vec<f64>,
}

impl<'a> Density<'a> {
    fn new(games: &'a [PlayedGame], prior: MismatchPrior) -> Density<'a> {
        let (least, ratio, count) = MISMATCHES;
        let mismatches: Vec<f64> =
            std::iter::successors(Some(least), |sd| Some(sd * ratio)).take(count).collect();
        let mut logs: Vec<Vec<f64>> = (mismatches.iter())
            .map(|sd| {
                let z = (libm::log(*sd) - libm::log(prior.median)) / prior.log_sd;
                let of_ability = |node: i32| {
                    let at = f64::from(node) * STEP / ABILITY_SD;
                    -0.5 * (at * at + z * z)
                };
                (-SIDE..=SIDE).map(of_ability).collect()
            })
            .collect();
        for game in games.iter().filter(|game| game.levels.iter().any(|level| level.of > 0.0)) {
            let widest = (mismatches[count - 1] * mismatches[count - 1] + game.common * game.common).sqrt();
            let reach = SIDE + (TAIL * widest / STEP) as i32 + 1;
            let likelihoods = game.likelihoods(reach);
            for (logs, sd) in logs.iter_mut().zip(&mismatches) {
                let kernel = kernel((sd * sd + game.common * game.common).sqrt());
                let half = kernel.len() / 2;
                let mut means = vec![0.0; logs.len()];
                for (first, weight) in ((reach - SIDE) as usize - half..).zip(&kernel) {
                    let moved = means.iter_mut().zip(&likelihoods[first..]);
                    moved.for_each(|(mean, value)| *mean += value * weight);
                }
                logs.iter_mut().zip(&means).for_each(|(log, mean)| *log += libm::log(*mean));
            }
        }
        let most = logs.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut weights = logs;
        weights.iter_mut().flatten().for_each(|log| *log = libm::exp(*log - most));
        let total: f64 = weights.iter().flatten().sum();
        weights.iter_mut().flatten().for_each(|weight| *weight /= total);
        Density { games, weights, mismatches }
    }

    /// Returns the posterior density on the ability grid.
    fn abilities(&self) -> Vec<f64> {
        (0..self.weights[0].len()).map(|at| self.weights.iter().map(|of| of[at]).sum()).collect()
    }

    /// Returns the posterior mean and variance of the ability, and the posterior mean of the mismatch (the standard
    /// deviation of the match effects).
    fn moments(&self) -> (f64, f64, f64) {
        let all = self.abilities();
        let nodes = || (-SIDE..=SIDE).map(|node| f64::from(node) * STEP).zip(&all);
        let mean: f64 = nodes().map(|(at, weight)| at * weight).sum();
        let variance: f64 = nodes().map(|(at, weight)| (at - mean) * (at - mean) * weight).sum();
        let mismatch = self.mismatches.iter().zip(&self.weights);
        (mean, variance, mismatch.map(|(sd, weights)| sd * weights.iter().sum::<f64>()).sum())
    }

    /// Returns the 2.5% and 97.5% quantiles of the ability. The log density is interpolated by cubics.
    fn ends(&self) -> [f64; 2] {
        let logs: Vec<f64> =
            self.abilities().into_iter().map(|weight| libm::log(weight.max(1e-300))).collect();
        let last = logs.len() - 1;
        let fine: Vec<f64> = (0..=last * PARTS)
            .map(|place| {
                let (at, part) = ((place / PARTS).clamp(1, last - 2), place as f64 / PARTS as f64);
                let t = part - at as f64;
                let [a, b, c, d] = [logs[at - 1], logs[at], logs[at + 1], logs[at + 2]];
                let cubic = -a * t * (t - 1.0) * (t - 2.0) / 6.0
                    + b * (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0
                    - c * (t + 1.0) * t * (t - 2.0) / 2.0
                    + d * (t + 1.0) * t * (t - 1.0) / 6.0;
                libm::exp(cubic)
            })
            .collect();
        let total: f64 = fine.iter().sum();
        [0.025, 0.975].map(|share| {
            let mut sum = 0.0;
            let place = fine.iter().position(|weight| {
                sum += weight;
                sum >= share * total
            });
            let place = place.unwrap_or(last * PARTS);
            // Each node represents half a part on either side.
            let over = (sum - share * total) / fine[place];
            (place as f64 + 0.5 - over) / PARTS as f64 * STEP - f64::from(SIDE) * STEP
        })
    }

    /// Returns the variance that the estimated ability would have if each level's difficulty for this player were
    /// known.
    fn sampling(&self, ability: f64, mismatch: f64) -> f64 {
        let information: f64 = (self.games.iter())
            .flat_map(|game| game.levels.iter().map(move |level| (game, level)))
            .map(|(game, level)| {
                let variance = mismatch * mismatch + game.common * game.common + level.own * level.own;
                let each = nodes().map(|(z, weight)| {
                    let chance = logistic(ability - level.difficulty + variance.sqrt() * z);
                    weight * chance * (1.0 - chance)
                });
                level.of * each.sum::<f64>()
            })
            .sum();
        1.0 / information
    }
}

impl PlayedGame {
    /// Returns the likelihood of the game's episodes for each logit from `-reach` to `reach` steps. The errors of the
    /// individual levels' difficulties are integrated out.
    pub(super) fn likelihoods(&self, reach: i32) -> Vec<f64> {
        let mut all = vec![1.0; 2 * reach as usize + 1];
        for level in self.levels.iter().filter(|level| level.of > 0.0) {
            let is_single = level.of == 1.0 && (level.won == 0.0 || level.won == 1.0);
            let likelihood = |logit: f64| match is_single {
                true => logistic(if level.won > 0.0 { logit } else { -logit }),
                false => libm::exp(level.won * logit - level.of * softplus(logit)),
            };
            for (at, node) in all.iter_mut().zip(-reach..) {
                let centre = f64::from(node) * STEP - level.difficulty;
                let each = nodes().map(|(z, weight)| weight * likelihood(centre + level.own * z));
                *at *= each.sum::<f64>();
            }
        }
        all
    }
}

/// Returns the nodes for integrating over a standard normal variable by the trapezoidal rule, with their
/// weights.
pub(super) fn nodes() -> impl Iterator<Item = (f64, f64)> {
    // The weights are exp(−z²/2) for z from 0 to 3, divided by the sum over all nodes.
    const WEIGHTS: [f64; 4] = [0.399050279652450, 0.242036229376345, 0.054005582622414, 0.004433048175244];
    (-3i32..=3).map(|z| (f64::from(z), WEIGHTS[z.unsigned_abs() as usize]))
}

/// Returns the weights of a zero-mean normal distribution at the grid steps around 0.
pub(super) fn kernel(sd: f64) -> Vec<f64> {
    let half = (TAIL * sd / STEP) as i32;
    let mut weights: Vec<f64> = (-half..=half)
        .map(|node| {
            let z = f64::from(node) * STEP / sd;
            libm::exp(-0.5 * z * z)
        })
        .collect();
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= total);
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    fn games(count: usize, won: f64, of: f64) -> Vec<PlayedGame> {
        let level = |difficulty: f64| PlayedLevel { difficulty, own: 0.1, won, of };
        vec![PlayedGame { common: 0.1, levels: vec![level(-0.5), level(0.5)] }; count]
    }

    #[test]
    fn the_weights_of_nodes_are_a_distribution() {
        let (sum, square) =
            nodes().fold((0.0, 0.0), |(sum, square), (z, weight)| (sum + weight, square + weight * z * z));
        assert!((sum - 1.0).abs() < 1e-12 && (square - 1.0).abs() < 0.03, "{sum}, {square}");
    }

    #[test]
    fn half_of_the_plays_won_is_the_mean_difficulty() {
        let found = ability(&games(30, 1.0, 2.0), MismatchPrior::default(), 0.0).unwrap();
        assert!(found.value.abs() < 1e-9 && found.is_bounded == [true, true], "{found:?}");
        let parts = found.sampling * found.sampling + found.mismatch * found.mismatch;
        assert!((parts.sqrt() - found.error).abs() < 1e-12, "{found:?}");
        // The interval is symmetric, and its width corresponds to the error.
        assert!((found.interval.high + found.interval.low).abs() < 1e-6, "{found:?}");
        assert!((found.interval.high / found.error - Z95).abs() < 0.1, "{found:?}");
    }

    /// If a level's difficulty is known, splitting its episodes among several entries does not change the result.
    #[test]
    fn plays_may_be_counted_together() {
        let level = |won: f64, of: f64| PlayedLevel { difficulty: 0.5, own: 0.0, won, of };
        let found = |levels: Vec<PlayedLevel>| {
            let games = vec![PlayedGame { common: 0.1, levels }; 20];
            ability(&games, MismatchPrior::default(), 0.0).unwrap()
        };
        let together = found(vec![level(1.0, 3.0)]);
        let apart = found(vec![level(1.0, 1.0), level(0.0, 1.0), level(0.0, 1.0)]);
        assert!((together.value - apart.value).abs() < 1e-9, "{together:?} {apart:?}");
        assert!((together.error - apart.error).abs() < 1e-9, "{together:?} {apart:?}");
    }

    #[test]
    fn the_link_widens() {
        let sure = ability(&games(30, 1.0, 2.0), MismatchPrior::default(), 0.0).unwrap();
        let linked = ability(&games(30, 1.0, 2.0), MismatchPrior::default(), 0.5).unwrap();
        assert_eq!(linked.value, sure.value);
        assert!((linked.error * linked.error - sure.error * sure.error - 0.25).abs() < 1e-12);
        assert!(linked.interval.high > sure.interval.high + 0.3);
    }

    /// Without wins, the ability has no lower bound.
    #[test]
    fn no_wins_bound_one_side() {
        let found = ability(&games(30, 0.0, 2.0), MismatchPrior::default(), 0.1).unwrap();
        assert!(found.is_bounded == [false, true] && found.interval.high < -1.5, "{found:?}");
        let found = ability(&games(30, 2.0, 2.0), MismatchPrior::default(), 0.1).unwrap();
        assert!(found.is_bounded == [true, false] && found.interval.low > 1.5, "{found:?}");
    }

    #[test]
    fn nothing_known() {
        let none = |games: &[PlayedGame]| ability(games, MismatchPrior::default(), 0.1).is_none();
        assert!(none(&[]) && none(&games(3, 0.0, 0.0)) && none(&games(3, 3.0, 2.0)));
        assert!(none(&games(3, f64::NAN, 2.0)) && none(&games(3, 1.0, f64::INFINITY)));
    }
}
