//! Welch's test for equal means in two groups with possibly different variances (B. L. Welch, "The
//! generalization of 'Student's' problem when several different population variances are involved", 1947).

use crate::student::student_p;

/// The result of Welch's t test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Welch {
    /// The t statistic: the mean of `ours` minus the mean of `theirs`, in units of the standard error.
    pub t: f64,
    /// The degrees of freedom, computed by the Welch–Satterthwaite equation.
    pub df: f64,
    /// The test's two-sided p-value.
    pub p: f64,
}

/// Performs Welch's t test on the means of `ours` and `theirs`. Returns `None` if a side has fewer than two
/// values, if a value is not finite, or if neither side varies. Cost: O(n).
///
/// ```
/// use infinite_arcade_statistics::welch;
/// let test = welch(&[0.2, 0.4, 0.5, 0.6, 0.9], &[0.1, 0.1, 0.2, 0.3, 0.3, 0.4, 0.8]).unwrap();
/// assert!((test.t - 1.396501).abs() < 1e-6 && (test.p - 0.198555).abs() < 1e-6);
/// ```
pub fn welch(ours: &[f64], theirs: &[f64]) -> Option<Welch> {
    let (a, b) = (Side::of(ours)?, Side::of(theirs)?);
    let square = a.square + b.square;
    if square <= 0.0 {
        return None;
    }
    let t = (a.mean - b.mean) / square.sqrt();
    // Dividing first prevents underflow, which squaring the small squares again would cause.
    let (share, rest) = (a.square / square, b.square / square);
    let df = 1.0 / (share * share / a.df + rest * rest / b.df);
    Some(Welch { t, df, p: student_p(t, df) })
}

/// A sample's mean, its squared standard error, and its degrees of freedom.
struct Side {
    mean: f64,
    square: f64,
    df: f64,
}

impl Side {
    fn of(values: &[f64]) -> Option<Side> {
        if values.len() < 2 || !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let count = values.len() as f64;
        // The computed mean of equal values may differ from them in the last bit, although their variance is
        // 0.
        if values.iter().all(|value| *value == values[0]) {
            return Some(Side { mean: values[0], square: 0.0, df: count - 1.0 });
        }
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        Some(Side { mean, square: squares / (count - 1.0) / count, df: count - 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(ours: &[f64], theirs: &[f64], t: f64, df: f64, p: f64) {
        let found = welch(ours, theirs).unwrap();
        for (found, expect) in [(found.t, t), (found.df, df), (found.p, p)] {
            assert!((found - expect).abs() <= 1e-8 * expect.abs(), "{found}, not {expect}");
        }
        let swapped = welch(theirs, ours).unwrap();
        assert!((swapped.t + found.t).abs() < 1e-12 && (swapped.p - found.p).abs() < 1e-12);
    }

    /// The test vectors come from `spec/06` §3.1 (t 1.396501, df 8.353065, p .198555; t −5.418683, df
    /// 5.102377, p .00272304). The additional digits were computed with decimal arithmetic.
    #[test]
    fn published_vectors() {
        check(
            &[0.2, 0.4, 0.5, 0.6, 0.9],
            &[0.1, 0.1, 0.2, 0.3, 0.3, 0.4, 0.8],
            1.39650145524538,
            8.35306502434076,
            0.19855541055422,
        );
        check(
            &[14.0, 10.0, 22.0, 9.0, 15.0],
            &[136.0, 90.0, 210.0, 151.0, 60.0, 180.0],
            -5.41868267844137,
            5.10237738259532,
            0.00272303776533877,
        );
    }

    /// If one side has no variance, the test reduces to a t test on the other side's mean.
    #[test]
    fn one_side_is_sure() {
        let found = welch(&[1.0, 2.0, 3.0], &[0.1, 0.1, 0.1]).unwrap();
        assert!((found.df - 2.0).abs() < 1e-12 && (found.t - 1.9 * 3f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn nothing_to_compare() {
        assert_eq!(welch(&[1.0], &[1.0, 2.0]), None);
        assert_eq!(welch(&[0.1; 3], &[0.7; 4]), None);
        assert_eq!(welch(&[1.0, f64::NAN], &[1.0, 2.0]), None);
        assert_eq!(welch(&[], &[]), None);
    }
}
