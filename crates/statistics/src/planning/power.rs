//! Power analysis for win rates. It computes the number of episodes needed to detect a difference, and is intended
//! for planning a run. For example, with five episodes per side, only two kinds of result are significant: five wins
//! against at most one win, and four wins against none.
//!
//! [`Power`] uses the arcsine transformation (J. Cohen, *Statistical Power Analysis for the Behavioral Sciences*,
//! 1988, §6.4). [`fisher_power`] computes the power of the test that is performed after the run, by summing over all
//! tables. Fisher's test is more conservative, especially with few trials.

use crate::comparisons::cohen::{angle, cohens_h};
use crate::comparisons::fisher::fisher;
use statrs::function::erf::erfc_inv;

/// The error rates of a comparison between two win rates. Both sides have the same number of trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// The probability that a two-sided test reports a nonexistent difference, usually 0.05.
    pub alpha: f64,
    /// The probability of detecting an actual difference, usually 0.8.
    pub power: f64,
}

impl Default for Power {
    fn default() -> Power {
        Power { alpha: 0.05, power: 0.8 }
    }
}

impl Power {
    /// Returns the smallest Cohen's h that `trials` trials per side can detect. A result above π means that
    /// no difference can be detected. Without trials, the result is infinite.
    ///
    /// ```
    /// use infinite_arcade_statistics::Power;
    /// // With 25 episodes per side, a difference of h = 0.79 can be detected, such as 0.1 against 0.44.
    /// let h = Power::default().detectable_h(25);
    /// assert!((h - 0.7924).abs() < 1e-4);
    /// ```
    pub fn detectable_h(&self, trials: u64) -> f64 {
        self.deviations() * (2.0 / trials as f64).sqrt()
    }

    /// Returns the nearest rate below `base` and the nearest rate above it that `trials` trials per side can
    /// distinguish from `base`. A rate is `None` if there is no such rate on its side, or if `base` is not a
    /// proportion.
    ///
    /// ```
    /// use infinite_arcade_statistics::Power;
    /// let [worse, better] = Power::default().detectable(25, 0.1);
    /// assert_eq!(worse, None);
    /// assert!((better.unwrap() - 0.4328).abs() < 1e-3);
    /// ```
    pub fn detectable(&self, trials: u64, base: f64) -> [Option<f64>; 2] {
        let (h, base) = (self.detectable_h(trials), angle(base));
        [base - h, base + h].map(|angle| {
            let sine = libm::sin(angle / 2.0);
            (0.0..=std::f64::consts::PI).contains(&angle).then_some(sine * sine)
        })
    }

    /// Returns the number of trials per side needed to distinguish `p` from `q`. Returns `None` if the rates
    /// are equal, or if a value is not a proportion.
    ///
    /// ```
    /// use infinite_arcade_statistics::Power;
    /// assert_eq!(Power::default().needed(0.5, 0.7), Some(93));
    /// ```
    pub fn needed(&self, p: f64, q: f64) -> Option<u64> {
        let h = cohens_h(p, q);
        let ratio = self.deviations() / h;
        (h.abs() > 0.0).then(|| (2.0 * ratio * ratio).ceil() as u64)
    }

    /// Returns the size, in standard deviations, of a difference that is detected with the required power.
    fn deviations(&self) -> f64 {
        quantile(1.0 - self.alpha / 2.0) + quantile(self.power)
    }
}

/// Returns the probability that [`fisher`] returns at most `alpha` if two players with win rates `rates` play
/// `trials` episodes. Returns NaN if a rate is not a proportion. Cost: cubic in the number of trials, so a few
/// hundred trials are feasible.
///
/// ```
/// use infinite_arcade_statistics::fisher_power;
/// // With five episodes per side, only 74 of 100 evaluations distinguish a player who always wins from a player
/// // with a win rate of 0.2.
/// let power = fisher_power([1.0, 0.2], [5, 5], 0.05);
/// assert!((power - 0.73728).abs() < 1e-12);
/// ```
pub fn fisher_power(rates: [f64; 2], trials: [u64; 2], alpha: f64) -> f64 {
    if !rates.iter().all(|rate| (0.0..=1.0).contains(rate)) {
        return f64::NAN;
    }
    let [ours, theirs] = [0, 1].map(|side: usize| binomial(rates[side], trials[side]));
    let mut seen = 0.0;
    for (a, chance) in ours.iter().enumerate() {
        for (b, other) in theirs.iter().enumerate() {
            if chance * other > 0.0 && fisher([a as u64, b as u64], trials) <= alpha {
                seen += chance * other;
            }
        }
    }
    seen.min(1.0)
}

/// Returns the binomial probabilities of 0 to `trials` successes.
fn binomial(rate: f64, trials: u64) -> Vec<f64> {
    let mut chances = vec![1.0];
    for _ in 0..trials {
        let next = |k: usize| {
            let won = if k > 0 { chances[k - 1] * rate } else { 0.0 };
            won + chances.get(k).map_or(0.0, |chance| chance * (1.0 - rate))
        };
        chances = (0..=chances.len()).map(next).collect();
    }
    chances
}

/// Returns the quantile of the standard normal distribution.
fn quantile(share: f64) -> f64 {
    -std::f64::consts::SQRT_2 * erfc_inv(2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Z95;

    #[test]
    fn quantiles() {
        assert!((quantile(0.975) - Z95).abs() < 1e-12);
        assert!((quantile(0.8) - 0.8416212335729143).abs() < 1e-12);
        assert!(quantile(0.5).abs() < 1e-15);
    }

    /// The expected values come from Cohen's table 6.4.1 for a two-sided test at the 5% level with a power of
    /// 0.8.
    #[test]
    fn published_sizes() {
        let ask = Power::default();
        for (h, expect) in [(0.2, 392.0), (0.5, 63.0), (0.8, 25.0), (1.0, 16.0)] {
            let ratio = ask.deviations() / h;
            assert_eq!((2.0 * ratio * ratio).round(), expect, "{h}");
        }
    }

    #[test]
    fn sizes_and_differences_agree() {
        let ask = Power { alpha: 0.01, power: 0.9 };
        for base in [0.0, 0.1, 0.5, 0.97] {
            for other in ask.detectable(40, base).into_iter().flatten() {
                let needed = ask.needed(base, other).unwrap();
                assert!((40..=41).contains(&needed), "{base} and {other}: {needed}");
            }
        }
        assert_eq!(ask.detectable(3, 0.5), [None, None]);
        assert_eq!(ask.needed(0.4, 0.4), None);
        assert_eq!(ask.detectable_h(0), f64::INFINITY);
    }

    /// With five trials per side, only three results are significant: five wins against none, four against
    /// none, and five against one.
    #[test]
    fn five_a_side() {
        assert_eq!(fisher_power([1.0, 0.0], [5, 5], 0.05), 1.0);
        let (p, q): (f64, f64) = (0.9, 0.1);
        let (five, four) = (p * p * p * p * p, 5.0 * p * p * p * p * q);
        let expect = five * (five + four) + four * five;
        // In the mirror image, the worse player is the lucky one.
        let (none, one) = (q * q * q * q * q, 5.0 * q * q * q * q * p);
        let expect = expect + none * (none + one) + one * none;
        let found = fisher_power([p, q], [5, 5], 0.05);
        assert!((found - expect).abs() < 1e-12, "{found}, not {expect}");
    }

    /// The arcsine approximation gives about the number of trials that Fisher's test requires, but Fisher's test is
    /// more conservative.
    #[test]
    fn the_approximation_is_near() {
        for (p, q) in [(0.1, 0.4), (0.5, 0.7), (0.05, 0.2)] {
            let needed = Power::default().needed(p, q).unwrap();
            let found = fisher_power([p, q], [needed, needed], 0.05);
            assert!((0.65..0.82).contains(&found), "{p} and {q} at {needed}: {found}");
        }
    }
}
