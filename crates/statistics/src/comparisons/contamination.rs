//! Exact memory tests, which detect players that have memorised published content.
//!
//! A coin toss decided which of two items was published. The items are two renamings of a game, or two winning
//! episodes on a level. Only a player that knows the published item can tell which one it is. For any other player,
//! either item was equally likely to be published, whatever the player's results on the two sides.
//!
//! The distribution of the sum of the differences is therefore known without any assumption about players or
//! games (R. A. Fisher, *The Design of Experiments*, 1935, §21). If all nonzero differences are ±1, the test
//! reduces to Q. McNemar's ("Note on the sampling error of the difference between correlated proportions",
//! 1947).

use crate::planning::design::{Spread, logistic};

/// The result of a [`coin_test`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoinTest {
    /// The one-sided exact p-value: the probability of a sum at least this large if the player does not know which
    /// items were published.
    pub p: f64,
    /// The sum of the differences: results on published items minus results on withheld items.
    pub sum: i64,
    /// The number of pairs whose published and withheld items have different results. Equal results are not evidence.
    pub informative: usize,
}

/// Tests whether a player's results depend on which of two items was published. For each pair, `differences` contains
/// the result on the published item minus the result on the withheld item. A result is a number of wins, or the number
/// of episodes that begin like that item's winning episode. Both items must have the same number of episodes.
///
/// Cost: O(pairs · sum of the absolute differences).
///
/// ```
/// use infinite_arcade_statistics::coin_test;
/// // The results differ in eight of ten pairs of games, always in favour of the published game.
/// let found = coin_test(&[1, 1, 0, 2, 1, 1, 0, 1, 1, 3]);
/// assert_eq!((found.p, found.sum, found.informative), (1.0 / 256.0, 11, 8));
/// ```
pub fn coin_test(differences: &[i64]) -> CoinTest {
    let sum = differences.iter().sum();
    let sizes: Vec<usize> =
        differences.iter().filter(|&&one| one != 0).map(|one| one.unsigned_abs() as usize).collect();
    // `chances` contains the probability of each total. Each difference either counts towards the total (the published
    // item is better) or does not count (the withheld item is better).
    let mut chances = vec![1.0];
    for &size in &sizes {
        let mut next = vec![0.0; chances.len() + size];
        for (at, chance) in chances.iter().enumerate() {
            next[at] += chance / 2.0;
            next[at + size] += chance / 2.0;
        }
        chances = next;
    }
    let won: i64 = differences.iter().filter(|one| **one > 0).sum();
    let p: f64 = chances[won as usize..].iter().rev().sum();
    CoinTest { p: p.min(1.0), sum, informative: sizes.len() }
}

/// Returns the power of [`coin_test`] at the significance level `alpha`, for the given number of pairs (one published
/// and one withheld item) with one episode per item. The published item has the better result with probability `more`,
/// and the withheld item with probability `less`. Returns NaN unless both are probabilities with a sum of at most 1.
/// Cost: O(coins²).
pub fn coin_power(coins: u64, more: f64, less: f64, alpha: f64) -> f64 {
    if !(0.0..=1.0).contains(&more) || !(0.0..=1.0).contains(&less) || more + less > 1.0 + 1e-12 {
        return f64::NAN;
    }
    let either = (more + less).min(1.0);
    let detected = |informative: u64| {
        let fair = binomial(informative, 0.5);
        let mut tail = 0.0;
        let mut least = informative + 1;
        while least > 0 && tail + fair[least as usize - 1] <= alpha {
            least -= 1;
            tail += fair[least as usize];
        }
        let found = binomial(informative, if either > 0.0 { more / either } else { 0.5 });
        found[least as usize..].iter().sum::<f64>()
    };
    let informative = binomial(coins, either);
    (0..=coins).map(|count| informative[count as usize] * detected(count)).sum::<f64>().min(1.0)
}

/// Returns the binomial probability of each number of successes, from 0 to `trials`.
fn binomial(trials: u64, p: f64) -> Vec<f64> {
    if p <= 0.0 || p >= 1.0 {
        let mut sure = vec![0.0; trials as usize + 1];
        sure[if p <= 0.0 { 0 } else { trials as usize }] = 1.0;
        return sure;
    }
    let n = trials as f64;
    let (win, lose, all) = (libm::log(p), libm::log1p(-p), libm::lgamma(n + 1.0));
    let of = |k: u64| {
        let k = k as f64;
        let ways = all - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0);
        libm::exp(ways + k * win + (n - k) * lose)
    };
    (0..=trials).map(of).collect()
}

/// A player that has memorised some levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memoriser {
    /// The fraction of levels that the player knows.
    pub share: f64,
    /// The player's win rate on known levels.
    pub known: f64,
    /// The player's win rate on unknown levels.
    pub clean: f64,
}

impl Memoriser {
    /// Returns two probabilities for a level that exists in a published and in a withheld renaming: the player wins
    /// only the published one, and the player wins only the withheld one.
    pub fn sibling_chances(&self, spread: Spread) -> (f64, f64) {
        let ability = spread.ability(self.clean);
        let square =
            spread.games * spread.games + spread.levels * spread.levels + spread.matches * spread.matches;
        let (mut more, mut less, mut sum) = (0.0, 0.0, 0.0);
        for node in -50..=50 {
            let z = f64::from(node) * 0.1;
            let weight = libm::exp(-z * z / 2.0);
            let clean = logistic(ability + square.sqrt() * z);
            let published = self.share * self.known + (1.0 - self.share) * clean;
            more += weight * published * (1.0 - clean);
            less += weight * (1.0 - published) * clean;
            sum += weight;
        }
        (more / sum, less / sum)
    }

    /// Returns the probability that an episode begins like the published win, and the probability that it begins like
    /// the withheld win. Without memory, both are `by_chance`.
    pub fn prefix_chances(&self, by_chance: f64) -> (f64, f64) {
        let less = (1.0 - self.share) * by_chance;
        (self.share + less, less)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The p-value matches an enumeration of the outcomes of all random choices.
    #[test]
    fn every_fall_counted() {
        let differences = [3, -1, 0, 2, 1, -2, 1];
        let observed: i64 = differences.iter().sum();
        let falls = 0u32..1 << differences.len();
        let sum = |fall: u32| -> i64 {
            let signed = differences.iter().enumerate();
            signed.map(|(at, one)| if fall >> at & 1 == 1 { -one } else { *one }).sum()
        };
        let extreme = falls.clone().filter(|fall| sum(*fall) >= observed).count();
        let found = coin_test(&differences);
        assert_eq!((found.p, found.sum, found.informative), (extreme as f64 / 128.0, 4, 6));
    }

    #[test]
    fn nothing_known() {
        assert_eq!(coin_test(&[]), CoinTest { p: 1.0, sum: 0, informative: 0 });
        assert_eq!(coin_test(&[0; 9]).p, 1.0);
        assert_eq!(coin_test(&[-1, -1]).p, 1.0);
        assert!(coin_power(10, 0.8, 0.8, 0.01).is_nan() && coin_power(10, f64::NAN, 0.1, 0.01).is_nan());
        assert_eq!(coin_power(6, 1.0, 0.0, 0.01), 0.0);
        assert_eq!(coin_power(7, 1.0, 0.0, 0.01), 1.0);
    }

    /// For a player without memory, the test's error rate is at most its significance level.
    #[test]
    fn the_level_is_kept() {
        for (coins, each) in [(30, 0.05), (200, 0.05), (100, 0.2)] {
            let found = coin_power(coins, each, each, 0.01);
            assert!(found <= 0.01 && found > 0.0001, "{coins}, {each}: {found}");
        }
    }

    /// Checks that the wins of a player without memory do not depend on the random choice, and that memory helps only
    /// on the published item.
    #[test]
    fn chances() {
        let clean = Memoriser { share: 0.0, known: 0.9, clean: 0.27 };
        let (more, less) = clean.sibling_chances(Spread::default());
        assert!((more - less).abs() < 1e-12 && more < 0.27 * 0.73);
        let (more, less) = Memoriser { share: 0.5, ..clean }.sibling_chances(Spread::default());
        assert!(more > 3.0 * less);
        let (more, less) = Memoriser { share: 0.2, ..clean }.prefix_chances(0.05);
        assert!((more - 0.24).abs() < 1e-12 && (less - 0.04).abs() < 1e-12);
    }

    /// The test of beginnings detects a player that has memorised a fifth of the levels. The test of wins on two
    /// renamings needs a player that has memorised half of the levels.
    #[test]
    fn power_of_planned_tests() {
        let fifth = Memoriser { share: 0.2, known: 0.9, clean: 0.27 };
        let (more, less) = fifth.prefix_chances(0.07);
        assert!(coin_power(200, more, less, 0.01) > 0.99);
        let (more, less) = Memoriser { share: 0.5, ..fifth }.sibling_chances(Spread::default());
        assert!(coin_power(100, more, less, 0.01) > 0.95);
    }
}
