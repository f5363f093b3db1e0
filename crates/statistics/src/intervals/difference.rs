//! An interval for the difference between two win rates. The hybrid score interval remains reliable with few
//! trials and for rates near 0 and 1 (R. G. Newcombe, "Interval estimation for the difference between
//! independent proportions", 1998, method 10).

use super::wilson::{Interval, wilson};

/// Returns the interval for the first proportion minus the second proportion, within [−1, 1]. The confidence is given
/// by `z` standard deviations ([`Z95`](crate::Z95) for 95%). If a side has no trials, its rate may be any proportion.
///
/// Both bounds are NaN if [`wilson`] returns NaN for a side.
///
/// ```
/// use infinite_arcade_statistics::{Z95, difference};
/// let interval = difference([16, 4], [25, 25], Z95);
/// assert!(interval.low > 0.2 && interval.high < 0.7); // 48 points apart: the first wins more.
/// ```
pub fn difference(successes: [u64; 2], trials: [u64; 2], z: f64) -> Interval {
    let (a, b) = (wilson(successes[0], trials[0], z), wilson(successes[1], trials[1], z));
    if trials.contains(&0) || a.low.is_nan() || b.low.is_nan() {
        return Interval { low: a.low - b.high, high: a.high - b.low };
    }
    let p = [0, 1].map(|side: usize| successes[side] as f64 / trials[side] as f64);
    let apart = |x: f64, y: f64| (x * x + y * y).sqrt();
    let middle = p[0] - p[1];
    Interval {
        low: (middle - apart(p[0] - a.low, b.high - p[1])).clamp(-1.0, middle),
        high: (middle + apart(a.high - p[0], p[1] - b.low)).clamp(middle, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Z95;

    #[track_caller]
    fn check(successes: [u64; 2], trials: [u64; 2], low: f64, high: f64) {
        let found = difference(successes, trials, Z95);
        // The result must match the four printed digits.
        assert!(
            (found.low - low).abs() < 5.1e-5 && (found.high - high).abs() < 5.1e-5,
            "{successes:?} of {trials:?}: {found:?}, not [{low}, {high}]"
        );
    }

    /// The examples come from Newcombe's table II, method 10.
    #[test]
    fn published_vectors() {
        check([56, 48], [70, 80], 0.0524, 0.3339);
        check([9, 3], [10, 10], 0.1705, 0.8090);
        check([6, 2], [7, 7], 0.0582, 0.8062);
        check([5, 0], [56, 29], -0.0381, 0.1926);
        check([0, 0], [10, 20], -0.1611, 0.2775);
        check([0, 0], [10, 10], -0.2775, 0.2775);
        check([10, 0], [10, 20], 0.6791, 1.0);
        check([10, 0], [10, 10], 0.6075, 1.0);
    }

    #[test]
    fn sides_swap_signs_and_nothing_known_is_everything() {
        let (a, b) = (difference([7, 2], [25, 30], Z95), difference([2, 7], [30, 25], Z95));
        assert!((a.low + b.high).abs() < 1e-15 && (a.high + b.low).abs() < 1e-15);
        assert_eq!(difference([0, 0], [0, 0], Z95), Interval { low: -1.0, high: 1.0 });
        let half = difference([5, 0], [5, 0], Z95);
        assert!(half.low > -0.5 && half.low < -0.4 && half.high == 1.0, "{half:?}");
        let no_counts = difference([9, 1], [5, 5], Z95);
        assert!(no_counts.low.is_nan() && no_counts.high.is_nan());
    }
}
