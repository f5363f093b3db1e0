//! The Wilson score interval for a proportion (E. B. Wilson, "Probable inference, the law of succession, and
//! statistical inference", 1927). Unlike the textbook interval, it keeps its coverage with few trials and for
//! proportions near 0 and 1.

/// The quantile of the standard normal distribution for a two-sided 95% interval.
pub const Z95: f64 = 1.959963984540054;

/// A closed interval with `low ≤ high`. Intervals for proportions are within [0, 1], and intervals for
/// differences between proportions are within [−1, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The interval's lower bound.
    pub low: f64,
    /// The interval's upper bound.
    pub high: f64,
}

/// Returns the Wilson score interval for `successes` among `trials`. The confidence is given by `z` standard
/// deviations ([`Z95`] for 95%).
///
/// Without trials, the interval is [0, 1]. Without successes, `low` is exactly 0. If all trials succeed,
/// `high` is exactly 1. Counts above 2^53 are rounded to the nearest `f64`.
///
/// Both bounds are NaN if `successes` exceeds `trials`, or if `z` is negative or not finite.
pub fn wilson(successes: u64, trials: u64, z: f64) -> Interval {
    if successes > trials || !z.is_finite() || z < 0.0 {
        return Interval { low: f64::NAN, high: f64::NAN };
    }
    if trials == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let n = trials as f64;
    score_interval(successes as f64 / n, n, z)
}

/// Returns Wilson's interval for a proportion `p` among `n` trials. `p` must be a proportion, and `n` must be
/// positive. `n` may be fractional, because it can be an effective sample size.
pub(crate) fn score_interval(p: f64, n: f64, z: f64) -> Interval {
    let z2 = z * z;
    let scale = 1.0 + z2 / n;
    let centre = (p + z2 / (2.0 * n)) / scale;
    let half = z * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt() / scale;
    // Rounding can move the bounds slightly beyond their exact values.
    Interval {
        low: if p == 0.0 { 0.0 } else { (centre - half).clamp(0.0, p) },
        high: if p == 1.0 { 1.0 } else { (centre + half).clamp(p, 1.0) },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(successes: u64, trials: u64, z: f64, low: f64, high: f64, tolerance: f64) {
        let found = wilson(successes, trials, z);
        let close = |a: f64, b: f64| a - b <= tolerance && b - a <= tolerance;
        assert!(
            close(found.low, low) && close(found.high, high),
            "{successes} of {trials}: {found:?}, not [{low}, {high}]"
        );
    }

    /// The test vectors come from the evaluation paper's tables, to six digits, with the paper's z of 1.96.
    #[test]
    fn published_vectors() {
        for (successes, low, high) in [
            (0, 0.0, 0.133196),
            (1, 0.007096, 0.195445),
            (2, 0.022220, 0.249665),
            (3, 0.041667, 0.299562),
            (4, 0.064033, 0.346540),
            (6, 0.114962, 0.434301),
            (7, 0.142837, 0.475770),
            (9, 0.202477, 0.554818),
            (11, 0.266654, 0.629330),
            (13, 0.334982, 0.699690),
            (14, 0.370670, 0.733346),
            (15, 0.407391, 0.765969),
            (16, 0.445182, 0.797523),
            (17, 0.484099, 0.827950),
            (18, 0.524230, 0.857163),
            (19, 0.565699, 0.885038),
            (20, 0.608687, 0.911395),
            (24, 0.804555, 0.992904),
            (25, 0.866804, 1.0),
        ] {
            check(successes, 25, 1.96, low, high, 5.1e-7);
        }
        for (successes, low, high) in [
            (0, 0.0, 0.434491),
            (1, 0.036223, 0.624472),
            (2, 0.117618, 0.769280),
            (3, 0.230720, 0.882382),
            (4, 0.375528, 0.963777),
            (5, 0.565509, 1.0),
        ] {
            check(successes, 5, 1.96, low, high, 5.1e-7);
        }
        check(0, 10, 1.96, 0.0, 0.277540, 5.1e-7);
        check(5, 10, 1.96, 0.236590, 0.763410, 5.1e-7);
        check(347, 2246, 1.96, 0.140140, 0.170033, 5.1e-7);
    }

    /// The results agree with 60-digit decimal arithmetic to within the last one or two bits.
    #[test]
    fn exact_vectors() {
        check(1, 5, Z95, 0.03622410863243017, 0.6244653702374747, 2.3e-16);
        check(1, 25, Z95, 0.007096233501987259, 0.19544063736193734, 2.3e-16);
        check(19, 25, Z95, 0.5657031664457093, 0.8850368630659856, 2.3e-16);
        check(24, 25, Z95, 0.8045593626380626, 0.9929037664980127, 2.3e-16);
        check(347, 2246, Z95, 0.1401406982101038, 0.17003291695053233, 2.3e-16);
        check(1, 1000000, Z95, 1.765245767453715e-07, 5.664911804311442e-06, 2.3e-16);
    }

    /// Reports contain these bits, so any change must be deliberate.
    #[test]
    fn golden_bits() {
        let Interval { low, high } = wilson(19, 25, Z95);
        assert_eq!((low.to_bits(), high.to_bits()), (0x3fe2_1a3d_86e4_184c, 0x3fec_5238_d3d3_ee4a));
    }

    #[test]
    fn the_ends_are_exact_and_ordered() {
        assert_eq!(wilson(0, 0, Z95), Interval { low: 0.0, high: 1.0 });
        for trials in 1..=200 {
            let mut before = Interval { low: 0.0, high: 0.0 };
            for successes in 0..=trials {
                let now = wilson(successes, trials, Z95);
                let p = successes as f64 / trials as f64;
                assert!(0.0 <= now.low && now.low <= p && p <= now.high && now.high <= 1.0);
                assert_eq!(now.low == 0.0, successes == 0);
                assert_eq!(now.high == 1.0, successes == trials);
                assert!(now.low >= before.low && now.high > before.high);
                // The interval for failures mirrors the interval for successes.
                let mirror = wilson(trials - successes, trials, Z95);
                assert!((now.low + mirror.high - 1.0).abs() < 1e-15);
                before = now;
            }
        }
    }

    #[test]
    fn extremes() {
        assert_eq!(wilson(1, 2, 0.0), Interval { low: 0.5, high: 0.5 });
        let wide = wilson(u64::MAX / 2, u64::MAX, Z95);
        assert!(wide.low > 0.499_999_999 && wide.high < 0.500_000_001);
        assert!(wilson(u64::MAX, u64::MAX, Z95).low > 0.999_999);
    }

    #[test]
    fn what_cannot_be_is_not_a_number() {
        for found in [wilson(3, 2, Z95), wilson(1, 2, f64::NAN), wilson(1, 2, -1.0)] {
            assert!(found.low.is_nan() && found.high.is_nan(), "{found:?}");
        }
    }
}
