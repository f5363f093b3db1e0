//! A stratified test that compares two players level by level. Pooling levels of different difficulty can hide a
//! difference, or create one that does not exist. This test compares only episodes on the same level, and sums the
//! evidence (N. Mantel and W. Haenszel, "Statistical aspects of the analysis of data from retrospective studies of
//! disease", 1959).
//!
//! The test is exact. Given the totals on every level, all assignments of wins to episodes are equally likely. One
//! side's number of wins is therefore a sum of independent hypergeometric variables, whose distribution is computed
//! exactly. A permutation test within strata would estimate the same distribution by sampling.

use super::fisher::{SAME, Tables, ascending};

/// The numbers of successes and trials of two groups on one level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stratum {
    /// The number of successes in each group.
    pub successes: [u64; 2],
    /// The number of trials in each group.
    pub trials: [u64; 2],
}

/// The comparison of two groups over all levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stratified {
    /// The two-sided exact p-value. With a single stratum, it equals the result of [`fisher`](super::fisher).
    pub p: f64,
    /// The first group's rate minus the second group's rate, as a weighted mean over the levels. The weights,
    /// from Mantel and Haenszel, are based on the harmonic means of the numbers of trials. `None` if no level
    /// has trials in both groups.
    pub difference: Option<f64>,
    /// Mantel and Haenszel's estimate of the common odds ratio: the first group's odds divided by the second group's.
    /// Infinite if all evidence favours the first group; `None` if there is no evidence for either group.
    pub odds_ratio: Option<f64>,
}

/// Compares two groups within strata. If a group has more successes than trials, `p` is NaN and the other
/// fields are `None`.
///
/// Cost: O(successes · tables), which is at most the square of the total number of trials.
///
/// ```
/// use infinite_arcade_statistics::{Stratum, stratified};
/// // On each of five levels, one player wins all five episodes, and the other wins one.
/// let levels = [Stratum { successes: [5, 1], trials: [5, 5] }; 5];
/// let test = stratified(&levels);
/// assert!(test.p < 1e-5);
/// assert!((test.difference.unwrap() - 0.8).abs() < 1e-12);
/// ```
pub fn stratified(strata: &[Stratum]) -> Stratified {
    let (mut weights, mut observed) = (vec![1.0], 0);
    let (mut gain, mut weight, mut odds, mut against) = (0.0, 0.0, 0.0, 0.0);
    for Stratum { successes: [a, b], trials: [m, n] } in strata.iter().copied() {
        let Some(tables) = Tables::of([a, b], [m, n]) else {
            return Stratified { p: f64::NAN, difference: None, odds_ratio: None };
        };
        weights = convolved(&weights, &tables.weights);
        observed += (a - tables.first) as usize;
        if m == 0 || n == 0 {
            continue;
        }
        let [a, b, m, n] = [a, b, m, n].map(|count| count as f64);
        let share = m * n / (m + n);
        weight += share;
        gain += share * (a / m - b / n);
        odds += a * (n - b) / (m + n);
        against += b * (m - a) / (m + n);
    }
    let bound = weights[observed] * SAME;
    let extreme = ascending(weights.iter().copied().filter(|&weight| weight <= bound));
    let p = (extreme / ascending(weights.iter().copied())).min(1.0);
    Stratified {
        p,
        difference: (weight > 0.0).then(|| gain / weight),
        odds_ratio: (odds + against > 0.0).then(|| odds / against),
    }
}

/// Returns the weight of each sum of two independent numbers, relative to the most likely sum.
fn convolved(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; a.len() + b.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            sums[i + j] += a * b;
        }
    }
    let most = sums.iter().copied().fold(0.0, f64::max);
    sums.iter_mut().for_each(|weight| *weight /= most);
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fisher;

    fn stratum(a: u64, m: u64, b: u64, n: u64) -> Stratum {
        Stratum { successes: [a, b], trials: [m, n] }
    }

    #[test]
    fn one_stratum_is_fisher() {
        for (a, m, b, n) in [(5, 5, 0, 5), (16, 25, 4, 25), (3, 7, 6, 9), (0, 5, 0, 4)] {
            let found = stratified(&[stratum(a, m, b, n)]).p;
            let expect = fisher([a, b], [m, n]);
            assert!((found - expect).abs() <= 1e-12 * expect, "{found}, not {expect}");
        }
    }

    /// Checks two levels, each with one win and one trial per side. The first side has 0, 1 or 2 wins with
    /// probabilities of 1/4, 2/4 and 1/4.
    #[test]
    fn worked_by_hand() {
        let found = stratified(&[stratum(1, 1, 0, 1), stratum(1, 1, 0, 1)]);
        assert_eq!((found.p, found.difference, found.odds_ratio), (0.5, Some(1.0), Some(f64::INFINITY)));
        assert_eq!(stratified(&[stratum(1, 1, 0, 1), stratum(0, 1, 1, 1)]).p, 1.0);
    }

    /// The p-value matches an enumeration of all assignments of wins to episodes on each level.
    #[test]
    fn every_deal_counted() {
        let strata = [stratum(3, 4, 1, 3), stratum(2, 2, 2, 4), stratum(1, 3, 0, 2)];
        let mut sums = std::collections::BTreeMap::from([(0, 1u64)]);
        for Stratum { successes: [a, b], trials: [m, n] } in strata {
            let mut next = std::collections::BTreeMap::new();
            for deal in (0u64..1 << (m + n)).filter(|deal| u64::from(deal.count_ones()) == a + b) {
                let ours = u64::from((deal & ((1 << m) - 1)).count_ones());
                sums.iter().for_each(|(sum, ways)| *next.entry(sum + ours).or_default() += ways);
            }
            sums = next;
        }
        let observed = sums[&6];
        let extreme: u64 = sums.values().filter(|&&ways| ways <= observed).sum();
        let expect = extreme as f64 / sums.values().sum::<u64>() as f64;
        let found = stratified(&strata).p;
        assert!((found - expect).abs() < 1e-12, "{found}, not {expect}");
    }

    /// The data are the admissions to six departments at Berkeley (P. J. Bickel and others, "Sex bias in
    /// graduate admissions", 1975). Women were admitted less often overall, but slightly more often within
    /// departments. The common odds ratio is known.
    #[test]
    fn pooling_misleads() {
        let departments = [
            stratum(512, 825, 89, 108),
            stratum(353, 560, 17, 25),
            stratum(120, 325, 202, 593),
            stratum(138, 417, 131, 375),
            stratum(53, 191, 94, 393),
            stratum(22, 373, 24, 341),
        ];
        let found = stratified(&departments);
        assert!((found.odds_ratio.unwrap() - 0.9046968).abs() < 5e-8, "{found:?}");
        assert!(found.p > 0.2 && found.difference.unwrap() < 0.0, "{found:?}");
        let total = |side: usize| {
            let of = |counts: fn(&Stratum) -> [u64; 2]| departments.iter().map(|s| counts(s)[side]).sum();
            (of(|s| s.successes), of(|s| s.trials))
        };
        let ((a, m), (b, n)): ((u64, u64), (u64, u64)) = (total(0), total(1));
        assert!(fisher([a, b], [m, n]) < 1e-15 && a * n > b * m);
    }

    #[test]
    fn nothing_to_compare() {
        let none = Stratified { p: 1.0, difference: None, odds_ratio: None };
        assert_eq!(stratified(&[]), none);
        assert_eq!(stratified(&[stratum(3, 5, 0, 0)]), none);
        let even = stratified(&[stratum(0, 5, 0, 5), stratum(5, 5, 5, 5)]);
        assert_eq!((even.p, even.difference, even.odds_ratio), (1.0, Some(0.0), None));
    }

    #[test]
    fn many_levels_neither_overflow_nor_vanish() {
        let found = stratified(&[stratum(5, 5, 0, 5); 500]);
        assert!(found.p >= 0.0 && found.p < 1e-100, "{found:?}");
        assert!(stratified(&[stratum(3, 5, 3, 5); 500]).p > 0.999_999);
    }
}
