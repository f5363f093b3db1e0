//! The power of a planned comparison of two players over games, levels and runs, for given variances.
//!
//! In the model, the logit of a player's probability of winning is the sum of four terms: the player's ability, the
//! game's ease, the level's ease, and the match effect between player and game. The last three terms are normally
//! distributed and mutually independent. The test is [`paired_over_games`](crate::paired_over_games).

use crate::intervals::over_games::least_p;
use crate::student::student_quantile;
use libm::{exp, lgamma, log};
use statrs::function::erf::erfc;

/// The model's standard deviations, in logits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The standard deviation of game ease.
    pub games: f64,
    /// The standard deviation of level ease within a game.
    pub levels: f64,
    /// The standard deviation of the match effect between a player and a game: how much better the player performs on
    /// the game than on equally hard games.
    pub matches: f64,
}

impl Default for Spread {
    /// Returns standard deviations of 1.3 for games, 1.0 for levels and 0.9 for match effects. The values for games and
    /// levels were measured with built-in players. The value for match effects (how well a game suits a player) is
    /// based on the published results of fifteen language models on six games
    /// (`docs/reference/spec/paper-winrates.csv`), for which the maximum-likelihood estimate is 0.88.
    fn default() -> Spread {
        Spread { games: 1.3, levels: 1.0, matches: 0.9 }
    }
}

/// The design of a comparison: the numbers of games, levels per game, and runs per level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Design {
    /// The number of games.
    pub games: u64,
    /// The number of levels per game.
    pub levels: u64,
    /// The number of episodes per player and level.
    pub runs: u64,
}

/// The distance between nodes for integrating over a normal variable, in standard deviations. With [`SIDE`] nodes on
/// either side of 0, the trapezoidal rule is accurate to about 1e-7 for functions as smooth as the logistic function.
const STEP: f64 = 0.75;
/// The number of nodes on either side of 0 for integrating over a normal variable.
const SIDE: i32 = 6;

impl Design {
    /// Returns the number of episodes per player.
    pub fn episodes(&self) -> u64 {
        self.games * self.levels * self.runs
    }

    /// Returns the standard error of the difference between two players with the given win rates.
    pub fn standard_error(&self, rates: [f64; 2], spread: Spread) -> f64 {
        (self.moments(rates, spread).0 / self.games as f64).sqrt()
    }

    /// Returns the probability that the test over games at the significance level `alpha` distinguishes two players
    /// with the given win rates, and identifies the better one. Returns 0 if there are too few games for the test.
    /// Cost: O(1), about a millisecond.
    ///
    /// ```
    /// use infinite_arcade_statistics::{Design, Spread};
    /// // With the same 150 episodes, thirty games reveal a difference that six games do not.
    /// let power = |games, runs| {
    ///     Design { games, levels: 5, runs }.power([0.5, 0.25], Spread::default(), 0.05)
    /// };
    /// assert!(power(6, 5) < 0.65 && power(30, 1) > 0.95);
    /// ```
    pub fn power(&self, rates: [f64; 2], spread: Spread, alpha: f64) -> f64 {
        let least = least_p(self.games as usize);
        let episodes = self.levels * self.runs;
        if self.games < 2 || least > alpha || episodes == 0 {
            return 0.0;
        }
        let df = (self.games - 1) as f64;
        let (variance, skewness) = self.moments(rates, spread);
        let root = (self.games as f64).sqrt();
        let shift = (rates[0] - rates[1]) / variance.sqrt() * root;
        let skewness = skewness * shift.signum() / root;
        shifted_tail(student_quantile(alpha, df), df, shift.abs(), skewness)
    }

    /// Returns the smallest win rate above `base` that the test at the significance level `alpha` distinguishes from
    /// `base` with the given power. Returns `None` if there is no such rate.
    pub fn detectable(&self, base: f64, spread: Spread, alpha: f64, power: f64) -> Option<f64> {
        let (mut low, mut high) = (base, 0.999);
        if low >= high || self.power([high, base], spread, alpha) < power {
            return None;
        }
        for _ in 0..24 {
            let middle = (low + high) / 2.0;
            if self.power([middle, base], spread, alpha) < power {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }

    /// Returns the variance and the skewness of the difference between the two players' rates on one game.
    fn moments(&self, rates: [f64; 2], spread: Spread) -> (f64, f64) {
        let ability = rates.map(|rate| spread.ability(rate));
        let (levels, runs) = (self.levels as f64, self.runs as f64);
        // `powers` contains the sums of the powers of a game's mean difference. `inner` is the sum of the variances
        // about that mean. `cross` is the sum of the products of the variances and the mean difference.
        let (mut powers, mut inner, mut cross) = ([0.0; 3], 0.0, 0.0);
        for (game, weight) in nodes() {
            // The entry for each match effect (how well the game suits a player) contains its weight, the mean rate on
            // this game, and the rates on each of the game's levels.
            let of_side = |side: usize| -> Vec<(f64, f64, Vec<f64>)> {
                let with = |(fit, weight): (f64, f64)| {
                    let centre = ability[side] + spread.games * game + spread.matches * fit;
                    let rates: Vec<f64> =
                        nodes().map(|(level, _)| logistic(centre + spread.levels * level)).collect();
                    let mean = nodes().zip(&rates).map(|((_, weight), rate)| weight * rate).sum();
                    (weight, mean, rates)
                };
                nodes().map(with).collect()
            };
            let sides = [of_side(0), of_side(1)];
            for (one, ours, our_levels) in &sides[0] {
                for (two, theirs, their_levels) in &sides[1] {
                    let weight = weight * one * two;
                    let apart = ours - theirs;
                    let each =
                        nodes().zip(our_levels.iter().zip(their_levels)).map(|((_, weight), (a, b))| {
                            let between = (a - b - apart) * (a - b - apart);
                            weight * (between + (a * (1.0 - a) + b * (1.0 - b)) / runs)
                        });
                    let within = each.sum::<f64>() / levels;
                    powers[0] += weight * apart;
                    powers[1] += weight * apart * apart;
                    powers[2] += weight * apart * apart * apart;
                    inner += weight * within;
                    cross += weight * apart * within;
                }
            }
        }
        let [mean, square, cube] = powers;
        let variance = square - mean * mean + inner;
        let third = cube - 3.0 * mean * square + 2.0 * mean * mean * mean + 3.0 * (cross - mean * inner);
        (variance, third / (variance * variance.sqrt()))
    }
}

impl Spread {
    /// Returns the ability at which the mean win rate over games and levels is `rate`.
    pub fn ability(&self, rate: f64) -> f64 {
        let all = (self.games * self.games + self.levels * self.levels + self.matches * self.matches).sqrt();
        let (mut low, mut high) = (-30.0, 30.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            // Wide distributions need more nodes.
            let mean: f64 = (-80..=80)
                .map(|node| {
                    let z = f64::from(node) * 0.1;
                    density(z) * 0.1 * logistic(middle + all * z)
                })
                .sum();
            if mean < rate {
                low = middle;
            } else {
                high = middle;
            }
        }
        (low + high) / 2.0
    }
}

/// Returns the nodes for integrating over a standard normal variable, with their weights.
fn nodes() -> impl Iterator<Item = (f64, f64)> {
    (-SIDE..=SIDE).map(|node| {
        let z = f64::from(node) * STEP;
        (z, density(z) * STEP)
    })
}

fn density(z: f64) -> f64 {
    exp(-z * z / 2.0) / (2.0 * std::f64::consts::PI).sqrt()
}

pub(crate) fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + exp(-x))
}

/// Returns an upper tail of the noncentral t distribution: the probability that a normal variable with mean
/// `shift`, divided by √(χ²/`df`) for an independent χ² with `df` degrees of freedom, exceeds `quantile`.
///
/// Means of skewed values are correlated with their standard errors. Therefore, the root is multiplied by
/// √(1 + `skewness` · z), where z is the deviation of the normal variable.
fn shifted_tail(quantile: f64, df: f64, shift: f64, skewness: f64) -> f64 {
    // The integral is over s = √(χ²/df). The density of s is 2 (df/2)^(df/2) / Γ(df/2) · s^(df−1) · exp(−df s²/2).
    let scale = (df / 2.0) * log(df / 2.0) - lgamma(df / 2.0) + std::f64::consts::LN_2;
    let (most, parts) = (1.0 + 8.0 / (2.0 * df).sqrt(), 1000);
    let step = most / f64::from(parts);
    let at = |part: i32| {
        let s = (f64::from(part) + 0.5) * step;
        let weight = exp(scale + (df - 1.0) * log(s) - df * s * s / 2.0);
        // A few steps of a contraction find the smallest deviation at which the test detects the difference.
        let mut least = quantile * s - shift;
        for _ in 0..8 {
            least = quantile * s * (1.0 + skewness * least.clamp(-3.0, 3.0)).max(0.0).sqrt() - shift;
        }
        weight * step * erfc(least / std::f64::consts::SQRT_2) / 2.0
    };
    (0..parts).map(at).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values are 1 − scipy.stats.nct.cdf(t, df, shift).
    #[test]
    fn noncentral_tails() {
        for (quantile, df, shift, expect) in NONCENTRAL {
            let found = shifted_tail(quantile, df, shift, 0.0);
            assert!((found - expect).abs() < 1e-6, "{quantile}, {df}, {shift}: {found}, not {expect}");
        }
    }

    const NONCENTRAL: [(f64, f64, f64, f64); 4] = [
        (2.570581836, 5.0, 2.5, 0.5225903169),
        (2.570581836, 5.0, 0.7, 0.0833342999),
        (2.10982, 17.0, 2.9, 0.7802734134),
        (1.98, 119.0, 1.2, 0.2207873802),
    ];

    #[test]
    fn abilities_have_their_rates() {
        let none = Spread { games: 0.0, levels: 0.0, matches: 0.0 };
        assert!((none.ability(0.25) - log(1.0 / 3.0)).abs() < 1e-9);
        assert!(Spread::default().ability(0.5).abs() < 1e-9);
        // Random effects move mean rates towards 0.5, so a mean rate of 0.1 requires an ability further from 0.
        assert!(Spread::default().ability(0.1) < none.ability(0.1) - 0.5);
    }

    /// Without random effects, the difference on a game has the variance of a difference between two binomials.
    #[test]
    fn variances_without_spread() {
        let none = Spread { games: 0.0, levels: 0.0, matches: 0.0 };
        let found = Design { games: 10, levels: 4, runs: 3 }.standard_error([0.5, 0.2], none);
        assert!((found - ((0.25 + 0.16) / 120.0f64).sqrt()).abs() < 1e-6, "{found}");
    }

    #[test]
    fn more_games_beat_more_runs() {
        let spread = Spread::default();
        let power = |games, levels, runs| Design { games, levels, runs }.power([0.5, 0.3], spread, 0.05);
        assert!(power(30, 1, 1) > power(6, 5, 1) && power(30, 5, 1) > power(6, 5, 5));
        assert_eq!((power(5, 5, 5), power(0, 5, 5), power(6, 0, 5)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn what_is_detectable_has_its_power() {
        let (design, spread) = (Design { games: 18, levels: 5, runs: 3 }, Spread::default());
        for base in [0.01, 0.1, 0.5] {
            let rate = design.detectable(base, spread, 0.05, 0.8).unwrap();
            let power = design.power([rate, base], spread, 0.05);
            assert!((power - 0.8).abs() < 1e-3, "{base}: {rate}, {power}");
        }
        assert_eq!(design.detectable(0.95, spread, 0.05, 0.8), None);
        assert_eq!(Design { games: 3, ..design }.detectable(0.1, spread, 0.05, 0.8), None);
    }
}
