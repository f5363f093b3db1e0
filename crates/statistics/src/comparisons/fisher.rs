//! Fisher's exact test for equal success rates in two groups (R. A. Fisher, "On the interpretation of χ² from
//! contingency tables, and the calculation of P", 1922).
//!
//! The hypergeometric probabilities are computed from the ratios of adjacent probabilities, using only `*`, `/` and
//! sums in a fixed order. Logarithms of factorials are avoided, because their last bits differ between platforms.

/// The factor up to which a table that seems more likely than the observed table counts as equally likely, because of
/// rounding errors. It is smaller than any true difference between tables of counts that fit in memory.
pub(crate) const SAME: f64 = 1.0 + 1e-7;

/// Returns the two-sided p-value for equal success rates, given the `successes` among the `trials` of two groups. The
/// p-value is the total probability of all tables with the same totals that are no more likely than the observed
/// table.
///
/// Returns 1 if there is nothing to compare: no trials, only successes, or no successes. Returns NaN if a
/// group has more successes than trials. Cost: O(number of tables with these totals), which is at most the
/// size of the smaller group.
///
/// ```
/// use infinite_arcade_statistics::fisher;
/// // The groups have 16 and 4 wins in 25 trials each.
/// assert!((fisher([16, 4], [25, 25]) - 0.001208589982).abs() < 1e-11);
/// ```
pub fn fisher(successes: [u64; 2], trials: [u64; 2]) -> f64 {
    let Some(tables) = Tables::of(successes, trials) else { return f64::NAN };
    let observed = tables.weights[(successes[0] - tables.first) as usize] * SAME;
    let total = ascending(tables.weights.iter().copied());
    let extreme = ascending(tables.weights.iter().copied().filter(|&weight| weight <= observed));
    (extreme / total).min(1.0)
}

/// All tables with the same totals. A table is identified by the number of successes in the first group.
pub(crate) struct Tables {
    /// The minimum number of successes in the first group.
    pub(crate) first: u64,
    /// The probability of each table, starting at `first`, relative to the most likely table. The weights do
    /// not overflow, and underflowing weights are negligible.
    pub(crate) weights: Vec<f64>,
}

impl Tables {
    /// Computes the tables. Returns `None` if a group has more successes than trials.
    pub(crate) fn of(successes: [u64; 2], trials: [u64; 2]) -> Option<Tables> {
        if successes[0] > trials[0] || successes[1] > trials[1] {
            return None;
        }
        let won = successes[0] + successes[1];
        let (first, last) = (won.saturating_sub(trials[1]), won.min(trials[0]));
        // The ratio is the next table's probability divided by the current table's probability.
        let ratio = |k: u64| {
            let up = (trials[0] - k) as f64 * (won - k) as f64;
            let down = (k + 1) as f64 * (trials[1] + k + 1 - won) as f64;
            up / down
        };
        let mode = (first..last).find(|&k| ratio(k) < 1.0).unwrap_or(last);
        let mut weights = vec![1.0; (last - first + 1) as usize];
        for k in mode..last {
            weights[(k + 1 - first) as usize] = weights[(k - first) as usize] * ratio(k);
        }
        for k in (first..mode).rev() {
            weights[(k - first) as usize] = weights[(k + 1 - first) as usize] / ratio(k);
        }
        Some(Tables { first, weights })
    }
}

/// Sums the values in ascending order, which minimises rounding errors.
pub(crate) fn ascending(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    values.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(n: u64, a: u64, b: u64, expect: f64) {
        for (a, b) in [(a, b), (b, a), (n - a, n - b)] {
            let p = fisher([a, b], [n, n]);
            // The result must match the ten digits printed in the specification.
            assert!((p - expect).abs() <= 5.1e-10 * expect, "{a} and {b} of {n}: {p}, not {expect}");
        }
    }

    /// The test vectors come from `spec/06` §3.1.
    #[test]
    fn published_vectors() {
        for (a, b, expect) in [
            (5, 0, 0.0079365079),
            (4, 0, 0.0476190476),
            (3, 0, 0.1666666667),
            (2, 0, 0.4444444444),
            (1, 0, 1.0),
            (5, 1, 0.0476190476),
            (4, 1, 0.2063492063),
            (3, 1, 0.5238095238),
            (5, 2, 0.1666666667),
            (5, 3, 0.4444444444),
            (4, 2, 0.5238095238),
            (3, 2, 1.0),
        ] {
            let p = fisher([a, b], [5, 5]);
            assert!((p - expect).abs() <= 1e-10, "{a} and {b} of 5: {p}, not {expect}");
        }
        for (a, b, expect) in [
            (0, 1, 1.0),
            (0, 2, 0.4897959184),
            (0, 4, 0.1098567086),
            (0, 13, 2.930898044e-5),
            (2, 7, 0.1383332155),
            (8, 2, 0.07375494096),
            (9, 2, 0.03742966153),
            (13, 4, 0.01565261089),
            (16, 4, 0.001208589982),
            (18, 10, 0.04500454048),
            (20, 13, 0.07176742642),
            (15, 6, 0.0208617051),
            (24, 0, 4.113578873e-13),
        ] {
            check(25, a, b, expect);
        }
    }

    /// The expected values were calculated by hand. Given the totals, the first group has 0, 1 or 2 successes in 10,
    /// 20 and 6 of 36 equally likely cases. The tables with at most 10 cases have 16 cases in total, and the tables
    /// with at most 6 cases have 6.
    #[test]
    fn groups_of_different_size() {
        for (k, expect) in [(0, 16.0 / 36.0), (1, 1.0), (2, 6.0 / 36.0)] {
            let p = fisher([k, 2 - k], [4, 5]);
            assert!((p - expect).abs() < 1e-15, "{k}: {p}");
        }
    }

    #[test]
    fn nothing_to_compare() {
        assert_eq!(fisher([0, 0], [0, 0]), 1.0);
        assert_eq!(fisher([0, 0], [7, 3]), 1.0);
        assert_eq!(fisher([7, 3], [7, 3]), 1.0);
        assert_eq!(fisher([4, 0], [7, 0]), 1.0);
    }

    #[test]
    fn large_tables_neither_overflow_nor_vanish() {
        assert_eq!(fisher([5000, 0], [5000, 5000]), 0.0);
        assert!(fisher([2500, 2500], [5000, 5000]) > 0.999_999);
        let p = fisher([2600, 2500], [5000, 5000]);
        assert!((0.04..0.05).contains(&p), "{p}");
    }

    #[test]
    fn more_successes_than_trials() {
        assert!(fisher([3, 0], [2, 2]).is_nan() && fisher([0, 3], [2, 2]).is_nan());
    }
}
