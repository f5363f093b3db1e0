//! The rank correlation between two measures (C. Spearman, "The proof and measurement of association between
//! two things", 1904).

/// Returns Spearman's rank correlation over pairs of values, from −1 to 1, which is the correlation between the
/// ranks. Equal values share their mean rank. Returns `None` if there are fewer than two pairs, if all first values
/// or all second values are equal, or if a value is NaN. Cost: O(n log n).
///
/// ```
/// use infinite_arcade_statistics::spearman;
/// assert_eq!(spearman(&[(1.0, 5.0), (2.0, 6.0), (3.0, 9.0)]), Some(1.0));
/// ```
pub fn spearman(pairs: &[(f64, f64)]) -> Option<f64> {
    if pairs.len() < 2 || pairs.iter().any(|(x, y)| x.is_nan() || y.is_nan()) {
        return None;
    }
    let x = ranks(&pairs.iter().map(|pair| pair.0).collect::<Vec<f64>>());
    let y = ranks(&pairs.iter().map(|pair| pair.1).collect::<Vec<f64>>());
    // Ranks are multiples of one half, and their mean is known, so the following sums are exact.
    let mean = (pairs.len() - 1) as f64 / 2.0;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
    let spread = product(&x, &x) * product(&y, &y);
    (spread > 0.0).then(|| (product(&x, &y) / spread.sqrt()).clamp(-1.0, 1.0))
}

/// Returns the rank of each value, starting at 0. Equal values share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for tied in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let mean = first as f64 + (tied.len() - 1) as f64 / 2.0;
        tied.iter().for_each(|&at| ranks[at] = mean);
        first += tied.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vector comes from `spec/06` §3.1.
    #[test]
    fn published_vector() {
        let x = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0];
        let y = [0.9, 0.4, 0.4, 0.7, 0.1, 0.8, 0.5, 0.3];
        let pairs: Vec<(f64, f64)> = x.into_iter().zip(y).collect();
        let found = spearman(&pairs).unwrap();
        assert!((found - 0.8502303).abs() < 5e-8, "{found}");
    }

    #[test]
    fn orders_are_compared_and_not_distances() {
        assert_eq!(spearman(&[(0.0, 1.0), (1.0, 100.0), (2.0, 101.0)]), Some(1.0));
        assert_eq!(spearman(&[(0.0, 3.0), (1.0, 2.0), (2.0, -7.0)]), Some(-1.0));
        assert_eq!(spearman(&[(0.0, 1.0), (1.0, 1.0)]), None);
        assert_eq!(spearman(&[(0.0, 1.0)]), None);
        assert_eq!(spearman(&[(0.0, 1.0), (f64::NAN, 2.0)]), None);
    }
}
