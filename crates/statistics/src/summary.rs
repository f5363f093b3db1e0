//! A summary of a sample of scores: the count, the mean, the extremes and the median.

/// A summary of a sample.
///
/// The summary does not depend on the order of the values, so shards and threads may deliver the values in
/// any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// The number of values (at least 1).
    pub count: usize,
    /// The arithmetic mean, within `min..=max`.
    pub mean: f64,
    /// The smallest value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
    /// The middle value, or the mean of the two middle values.
    pub median: f64,
}

impl Summary {
    /// Returns the summary of `values`. Returns `None` if there are no values, or if a value is not finite, because
    /// no summary would be correct in these cases.
    ///
    /// The mean is the sum divided by the count. The values are added one by one from the smallest to the
    /// largest (`f64::total_cmp`). Values are expected to be small enough for a finite sum. If the sum is
    /// infinite, the mean and the median equal the extreme with the same sign. Cost: O(n log n), plus one
    /// copy.
    pub fn of(values: &[f64]) -> Option<Summary> {
        if !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let count = sorted.len();
        let sum = sorted[1..].iter().fold(min, |sum, value| sum + value);
        // A computed mean can lie beyond the extremes because of rounding. For example, 0.1 + 0.1 + 0.1
        // exceeds 0.3.
        let mean = (sum / count as f64).clamp(min, max);
        let (below, above) = (sorted[(count - 1) / 2], sorted[count / 2]);
        let median = if count % 2 == 1 { below } else { ((below + above) / 2.0).clamp(below, above) };
        Some(Summary { count, mean, min, max, median })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(values: &[f64], mean: f64, min: f64, max: f64, median: f64) {
        let expect = Summary { count: values.len(), mean, min, max, median };
        assert_eq!(Summary::of(values), Some(expect));
    }

    #[test]
    fn small_samples() {
        check(&[5.0], 5.0, 5.0, 5.0, 5.0);
        check(&[4.0, 1.0], 2.5, 1.0, 4.0, 2.5);
        check(&[3.0, -1.0, 10.0], 4.0, -1.0, 10.0, 3.0);
        check(&[1.0, 2.0, 3.0, 10.0], 4.0, 1.0, 10.0, 2.5);
        check(&[0.0, -0.0], 0.0, -0.0, 0.0, 0.0);
    }

    #[test]
    fn nothing_or_no_number_has_no_summary() {
        for values in [&[][..], &[f64::NAN], &[1.0, f64::INFINITY], &[f64::NEG_INFINITY, 1.0]] {
            assert_eq!(Summary::of(values), None);
        }
    }

    /// If the values were summed in the order in which they are given, the mean would depend on that order.
    #[test]
    fn order_does_not_matter() {
        let values = [1e16, 1.0, -1e16, 1.0, 0.1, 0.7];
        let expect = Summary::of(&values).expect("finite");
        for turn in 0..values.len() {
            let mut turned = values;
            turned.rotate_left(turn);
            assert_eq!(Summary::of(&turned), Some(expect));
            turned.reverse();
            assert_eq!(Summary::of(&turned), Some(expect));
        }
        // When the values are summed from the smallest up, -1e16 absorbs the small values one by one. Summed in the
        // given order, the result would be 1.8.
        assert_eq!(expect.mean, 0.0);
    }

    #[test]
    fn the_mean_stays_between_the_extremes() {
        // The computed value of (0.1 + 0.1 + 0.1) / 3.0 is 0.10000000000000002.
        check(&[0.1; 3], 0.1, 0.1, 0.1, 0.1);
        check(&[f64::MAX; 2], f64::MAX, f64::MAX, f64::MAX, f64::MAX);
    }
}
