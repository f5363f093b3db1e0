//! The linear correlation between two measures (K. Pearson, "Note on regression and inheritance in the case
//! of two parents", 1895).

use crate::student::student_p;

/// Returns Pearson's correlation over pairs of values, from −1 to 1. Returns `None` if there are fewer than two
/// pairs, if all first values or all second values are equal, or if a value is not finite. Cost: O(n).
///
/// ```
/// use infinite_arcade_statistics::pearson;
/// assert_eq!(pearson(&[(1.0, 5.0), (2.0, 7.0), (3.0, 9.0)]), Some(1.0));
/// ```
pub fn pearson(pairs: &[(f64, f64)]) -> Option<f64> {
    if pairs.len() < 2 || pairs.iter().any(|(x, y)| !x.is_finite() || !y.is_finite()) {
        return None;
    }
    let constant = |side: fn(&(f64, f64)) -> f64| pairs.iter().all(|pair| side(pair) == side(&pairs[0]));
    if constant(|pair| pair.0) || constant(|pair| pair.1) {
        return None;
    }
    let count = pairs.len() as f64;
    let mean = |side: fn(&(f64, f64)) -> f64| pairs.iter().map(side).sum::<f64>() / count;
    let (x, y) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let product = |a: fn(f64, f64) -> f64| pairs.iter().map(|pair| a(pair.0 - x, pair.1 - y)).sum::<f64>();
    let (xx, yy) = (product(|x, _| x * x), product(|_, y| y * y));
    let spread = (xx * yy).sqrt();
    (spread > 0.0).then(|| (product(|x, y| x * y) / spread).clamp(-1.0, 1.0))
}

/// Returns the two-sided p-value for a correlation `r` over `pairs` pairs, which is the probability that unrelated
/// pairs correlate at least as strongly. Returns `None` if there are fewer than three pairs, or if `r` is not within
/// −1..=1.
///
/// For [`pearson`], the p-value is exact if the first or the second values are normally distributed. For
/// [`spearman`](crate::spearman), the p-value is an approximation that is accurate for about ten or more pairs.
///
/// ```
/// use infinite_arcade_statistics::correlation_p;
/// assert!((correlation_p(0.8830926, 8).unwrap() - 0.00365248).abs() < 1e-7);
/// ```
pub fn correlation_p(r: f64, pairs: usize) -> Option<f64> {
    let df = pairs.checked_sub(2).filter(|&df| df > 0 && (-1.0..=1.0).contains(&r))? as f64;
    // If r = ±1, t is infinite and p is 0.
    Some(student_p(r * (df / (1.0 - r * r)).sqrt(), df))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bonferroni;
    use crate::spearman;

    const X: [f64; 8] = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0];
    const Y: [f64; 8] = [0.9, 0.4, 0.4, 0.7, 0.1, 0.8, 0.5, 0.3];

    #[track_caller]
    fn close(found: f64, expect: f64) {
        assert!((found - expect).abs() <= 1e-8 * expect.abs(), "{found}, not {expect}");
    }

    /// The test vectors come from `spec/06` §3.1 (.8830926, p .00365248; .8502303, p .00748355). The
    /// additional digits were computed with decimal arithmetic.
    #[test]
    fn published_vectors() {
        let pairs: Vec<(f64, f64)> = X.into_iter().zip(Y).collect();
        let (linear, ordered) = (pearson(&pairs).unwrap(), spearman(&pairs).unwrap());
        close(linear, 0.883092622465265);
        close(correlation_p(linear, 8).unwrap(), 0.00365247731516369);
        close(ordered, 0.850230301897704);
        close(correlation_p(ordered, 8).unwrap(), 0.00748355217395917);
    }

    /// The six correlations over 2250 episodes come from `spec/06` §5.5. The smallest p-values are about 1e-238.
    #[test]
    fn published_corrections() {
        let r = [0.21, -0.28, -0.18, -0.10, 0.30, 0.62];
        let p = r.map(|r| correlation_p(r, 2250).unwrap());
        let printed = [4.6e-23, 5.0e-41, 4.6e-17, 1.2e-5, 3.1e-47, 2.4e-238];
        let exact = [
            4.58611299172956e-23,
            5.01739860287289e-41,
            4.62843221894001e-17,
            1.20432258168045e-05,
            3.07339487843912e-47,
            2.41592556213764e-238,
        ];
        for ((found, printed), exact) in bonferroni(&p).into_iter().zip(printed).zip(exact) {
            assert!((found - printed).abs() < 0.012 * printed, "{found}, not {printed}");
            close(found, exact);
        }
    }

    #[test]
    fn lines_and_nothing_to_compare() {
        assert_eq!(pearson(&[(0.0, 3.0), (1.0, 2.0), (2.0, 1.0)]), Some(-1.0));
        assert_eq!(correlation_p(-1.0, 3), Some(0.0));
        assert_eq!(correlation_p(0.0, 3), Some(1.0));
        assert_eq!(correlation_p(1.0, 2), None);
        // The computed mean of three values of 0.1 is not 0.1, but the values are equal.
        assert_eq!(pearson(&[(0.1, 1.0), (0.1, 2.0), (0.1, 4.0)]), None);
        assert_eq!(pearson(&[(0.0, 1.0)]), None);
        assert_eq!(pearson(&[(0.0, 1.0), (f64::NAN, 2.0)]), None);
    }
}
