//! Quantiles of a sample (R. J. Hyndman and Y. Fan, "Sample quantiles in statistical packages", 1996, definition 7).

/// Returns the quantile of `values` at `share`, where 0.5 is the median. The quantile is the value with rank
/// `share · (n − 1)` from below, counted from 0, with linear interpolation between adjacent values. Returns `None` if
/// there are no values, if a value is not finite, or if `share` is not within 0..=1. Cost: O(n log n), plus one copy.
///
/// ```
/// use infinite_arcade_statistics::quantile;
/// assert_eq!(quantile(&[4.0, 1.0, 2.0], 0.25), Some(1.5));
/// ```
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    if !(0.0..=1.0).contains(&share) || values.is_empty() || !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let rank = share * (sorted.len() - 1) as f64;
    let below = (rank as usize).min(sorted.len() - 1);
    let above = (below + 1).min(sorted.len() - 1);
    let (low, high) = (sorted[below], sorted[above]);
    // Rounding can move the interpolated value beyond the values on either side, so it is clamped.
    Some((low + (rank - below as f64) * (high - low)).clamp(low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_between_values_are_interpolated() {
        let values = [30.0, 10.0, 20.0, 40.0, 50.0];
        for (share, expect) in [(0.0, 10.0), (0.25, 20.0), (0.4, 26.0), (0.5, 30.0), (0.9, 46.0), (1.0, 50.0)]
        {
            let found = quantile(&values, share).unwrap();
            assert!((found - expect).abs() < 1e-12, "{share}: {found}");
        }
        assert_eq!(quantile(&[7.0], 0.3), Some(7.0));
        assert_eq!(quantile(&[1.0, 2.0], 0.5), Some(1.5));
    }

    #[test]
    fn nothing_known() {
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[1.0, f64::NAN], 0.5), None);
    }
}
