//! The chi-squared distribution (K. Pearson, "On the criterion that a given system of deviations …", 1900).

/// Returns the probability that a chi-squared variable with `df` degrees of freedom is at least `value`.
///
/// The probability is computed with the finite series for integer degrees of freedom (M. Abramowitz and I. A.
/// Stegun, *Handbook of Mathematical Functions*, 1964, 26.4.4 and 26.4.5). The result is bit-identical on
/// every machine. Returns NaN if `df` is 0 or if `value` is NaN. Cost: O(`df`).
///
/// ```
/// use infinite_arcade_statistics::chi_squared_p;
/// assert!((chi_squared_p(19.675, 11) - 0.05).abs() < 1e-5);
/// ```
pub fn chi_squared_p(value: f64, df: u64) -> f64 {
    if df == 0 || value.is_nan() {
        return f64::NAN;
    }
    if value <= 0.0 {
        return 1.0;
    }
    let half = value / 2.0;
    // The terms of the series are x^k e^(−x) / Γ(k + 1). The series begins at k = 0 for even degrees of freedom, and
    // at k = 1/2 for odd ones.
    let is_odd = df % 2 == 1;
    let root = half.sqrt();
    let (mut sum, mut k) = if is_odd { (libm::erfc(root), 0.5) } else { (0.0, 0.0) };
    let mut term = match is_odd {
        true => root * libm::exp(-half) * std::f64::consts::FRAC_2_SQRT_PI,
        false => libm::exp(-half),
    };
    for _ in 0..df / 2 {
        sum += term;
        k += 1.0;
        term *= half / k;
    }
    sum.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values come from `chi2.sf` in scipy 1.17.
    #[test]
    fn known_values() {
        for (value, df, expect) in [
            (3.841458820694124, 1, 0.05),
            (0.1, 1, 0.751829634045849),
            (5.991464547107979, 2, 0.05),
            (10.0, 3, 0.01856613546304325),
            (10.0, 4, 0.04042768199451279),
            (30.0, 11, 0.0015845952573066058),
            (200.0, 10, 1.6139305336977317e-37),
        ] {
            let found = chi_squared_p(value, df);
            assert!((found / expect - 1.0).abs() < 1e-6, "{value}, {df}: {found}, not {expect}");
        }
        assert!(chi_squared_p(1.0, 0).is_nan() && chi_squared_p(f64::NAN, 2).is_nan());
        assert_eq!(chi_squared_p(0.0, 5), 1.0);
    }
}
