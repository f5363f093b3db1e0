//! Corrections for multiple tests (Y. Benjamini and Y. Hochberg, "Controlling the false discovery rate", 1995; C. E.
//! Bonferroni, "Teoria statistica delle classi e calcolo delle probabilità", 1936).

/// Returns the Benjamini–Hochberg adjusted p-values (q-values) for `p`, in the same order. If every null hypothesis
/// with a q-value of at most 5% is rejected, the expected fraction of false rejections is at most 5%. No q-value
/// exceeds 1. Cost: O(n log n).
///
/// All results are NaN if a value is not a probability.
///
/// ```
/// use infinite_arcade_statistics::benjamini_hochberg;
/// assert_eq!(benjamini_hochberg(&[0.01, 0.5, 0.02]), [0.03, 0.5, 0.03]);
/// ```
pub fn benjamini_hochberg(p: &[f64]) -> Vec<f64> {
    if !p.iter().all(|p| (0.0..=1.0).contains(p)) {
        return vec![f64::NAN; p.len()];
    }
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[b].total_cmp(&p[a]));
    let mut adjusted = vec![1.0; p.len()];
    let mut least: f64 = 1.0;
    for (above, &at) in order.iter().enumerate() {
        let rank = p.len() - above;
        least = least.min(p[at] * p.len() as f64 / rank as f64);
        adjusted[at] = least;
    }
    adjusted
}

/// Returns the Bonferroni adjusted p-values for `p`, in the same order. If every null hypothesis with an adjusted
/// value of at most 5% is rejected, the probability of one or more false rejections is at most 5%. No adjusted value
/// exceeds 1. Cost: O(n).
///
/// All results are NaN if a value is not a probability.
///
/// ```
/// use infinite_arcade_statistics::bonferroni;
/// assert_eq!(bonferroni(&[0.125, 0.5, 0.25]), [0.375, 1.0, 0.75]);
/// ```
pub fn bonferroni(p: &[f64]) -> Vec<f64> {
    if !p.iter().all(|p| (0.0..=1.0).contains(p)) {
        return vec![f64::NAN; p.len()];
    }
    p.iter().map(|one| (one * p.len() as f64).min(1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vector comes from `spec/06` §3.1.
    #[test]
    fn published_vector() {
        let found = benjamini_hochberg(&[0.01, 0.04, 0.03, 0.005, 0.5, 0.2, 0.008]);
        let expect = [0.023333333333, 0.056, 0.0525, 0.023333333333, 0.5, 0.233333333333, 0.023333333333];
        for (found, expect) in found.iter().zip(expect) {
            assert!((found - expect).abs() < 1e-8, "{found}, not {expect}");
        }
    }

    #[test]
    fn edges() {
        assert!(benjamini_hochberg(&[]).is_empty());
        assert_eq!(benjamini_hochberg(&[0.2]), [0.2]);
        assert_eq!(benjamini_hochberg(&[1.0, 1.0, 0.9]), [1.0, 1.0, 1.0]);
        assert_eq!(benjamini_hochberg(&[0.04, 0.04]), [0.04, 0.04]);
    }

    #[test]
    fn no_probability() {
        for adjusted in [benjamini_hochberg(&[0.5, f64::NAN]), bonferroni(&[0.5, 2.0])] {
            assert!(adjusted.len() == 2 && adjusted.iter().all(|p| p.is_nan()), "{adjusted:?}");
        }
    }
}
