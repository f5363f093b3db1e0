//! Student's t distribution ("Student", "The probable error of a mean", 1908).
//!
//! The p-values come from a library that uses the platform's logarithm, so their last digits may differ
//! between machines. They are intended for reports and must not be used in minted content. Quantiles for
//! intervals are the same on every machine (see [`student_quantile`]).

use statrs::function::beta::beta_reg;

/// Returns the two-sided p-value for `t`, which is the probability that a t variable with `df` degrees of freedom is
/// at least as far from 0 as `t`. Tiny values keep their relative precision. Returns NaN if `t` is NaN, or if `df` is
/// not positive and finite. Cost: O(1).
///
/// ```
/// use infinite_arcade_statistics::student_p;
/// assert!((student_p(2.83, 400.0) - 0.00488943).abs() < 1e-8);
/// ```
pub fn student_p(t: f64, df: f64) -> f64 {
    if t.is_nan() || !df.is_finite() || df <= 0.0 {
        return f64::NAN;
    }
    if t.is_infinite() {
        return 0.0;
    }
    // The tail is computed directly, because subtracting the complement from 1 would lose all digits.
    beta_reg(df / 2.0, 0.5, df / (df + t * t)).clamp(0.0, 1.0)
}

/// Returns the value that a t variable with `df` degrees of freedom exceeds in absolute value with
/// probability `p`. For example, the value is 2.57 for a `p` of 0.05 and a `df` of 5. Returns NaN if `p` is
/// not within 0..1, or if `df` is not positive and finite.
///
/// The result is bit-identical on every machine for an integer `df` up to a million and a `p` of at least
/// 0.0001. All intervals in releases are within this range. There, the result comes from the finite series
/// for integer degrees of freedom (M. Abramowitz and I. A. Stegun, *Handbook of Mathematical Functions*,
/// 1964, 26.7.3 and 26.7.4). The series loses digits for smaller `p`. Cost: about sixty evaluations of
/// [`student_p`], or O(`df`).
///
/// ```
/// use infinite_arcade_statistics::student_quantile;
/// assert!((student_quantile(0.05, 5.0) - 2.570581836).abs() < 1e-9);
/// ```
pub fn student_quantile(p: f64, df: f64) -> f64 {
    if !(p > 0.0 && p < 1.0 && df.is_finite() && df > 0.0) {
        return f64::NAN;
    }
    let is_in_series = df <= 1e6 && df.fract() == 0.0 && p >= 1e-4;
    let tail = |t: f64| if is_in_series { series(t, df) } else { student_p(t, df) };
    let mut high = 1.0;
    while tail(high) > p && high < f64::MAX / 4.0 {
        high *= 2.0;
    }
    // The bisection ends when the midpoint equals one of the bounds.
    let mut low = 0.0;
    loop {
        let middle = (low + high) / 2.0;
        if middle <= low || middle >= high {
            return middle;
        }
        if tail(middle) > p {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Returns the two-sided p-value for integer degrees of freedom. The error is about one rounding error per
/// degree of freedom.
fn series(t: f64, df: f64) -> f64 {
    let square = df / (df + t * t);
    let sine = t / (df + t * t).sqrt();
    let is_odd = df % 2.0 == 1.0;
    // Each term is a power of the squared cosine, multiplied by its factor.
    let (mut term, mut sum) = (1.0, 0.0);
    let mut at = if is_odd { 1.0 } else { 0.0 };
    while at < df - 1.0 {
        sum += term;
        at += 2.0;
        term *= square * (at - 1.0) / at;
    }
    let within = match is_odd {
        true => (libm::atan(t / df.sqrt()) + sine * square.sqrt() * sum) * std::f64::consts::FRAC_2_PI,
        false => sine * sum,
    };
    1.0 - within
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(t: f64, df: f64, expect: f64) {
        let found = student_p(t, df);
        assert!((found - expect).abs() <= 1e-8 * expect, "t {t}, df {df}: {found}, not {expect}");
    }

    /// The test vectors come from `spec/06` §3.1 (0.00488943 and 0.234674). The additional digits were
    /// computed with decimal arithmetic.
    #[test]
    fn published_vectors() {
        check(2.83, 400.0, 0.00488943350331646);
        check(-1.19, 450.0, 0.234673825204481);
    }

    /// One and two degrees of freedom have closed formulas.
    #[test]
    fn formulas() {
        check(1.0, 1.0, 0.5);
        for t in [0.1, 1.5, 7.0, 1000.0] {
            // This expression equals 1 − s without cancellation.
            let root: f64 = t * t + 2.0;
            check(t, 2.0, 2.0 / (root + t * root.sqrt()));
        }
    }

    #[test]
    fn extremes() {
        assert_eq!(student_p(0.0, 7.0), 1.0);
        assert_eq!(student_p(f64::NEG_INFINITY, 7.0), 0.0);
    }

    /// The expected values are the 97.5% points in printed tables.
    #[test]
    fn quantiles() {
        for (df, expect) in [(1.0, 12.7062047), (2.0, 4.30265273), (5.0, 2.57058184), (29.0, 2.04522964)] {
            let found = student_quantile(0.05, df);
            assert!((found - expect).abs() < 1e-7, "df {df}: {found}, not {expect}");
        }
        for (p, df) in [(0.5, 3.0), (1e-9, 7.0), (0.999, 40.0)] {
            let back = student_p(student_quantile(p, df), df);
            assert!((back / p - 1.0).abs() < 1e-11, "{p}, {df}: {back}");
        }
        assert!(
            [(0.0, 5.0), (1.0, 5.0), (f64::NAN, 5.0), (0.05, 0.0)]
                .iter()
                .all(|&(p, df)| student_quantile(p, df).is_nan())
        );
    }

    /// The expected values come from thirty-digit arithmetic.
    #[test]
    fn series_are_exact() {
        for (t, df, expect) in [
            (0.5, 1.0, 0.704832764699133),
            (2.0, 2.0, 0.183503419072274),
            (2.5, 5.0, 0.0544900993423762),
            (0.01, 999.0, 0.992023283928495),
            (2.0, 120.0, 0.0477585273403284),
            (1.9, 10_000.0, 0.0574618568273861),
        ] {
            let found = series(t, df);
            // Each term adds its own rounding error.
            assert!((found - expect).abs() < 1e-16 * (10.0 + df), "t {t}, df {df}: {found}, not {expect}");
        }
    }

    #[test]
    fn series_and_library_agree() {
        for df in (1..60).map(f64::from) {
            for t in [0.01, 0.5, 1.0, 2.0, 4.0] {
                let (ours, library) = (series(t, df), student_p(t, df));
                assert!((ours - library).abs() < 1e-12, "t {t}, df {df}: {ours}, not {library}");
            }
        }
    }

    #[test]
    fn no_freedom() {
        assert!([0.0, -1.0, f64::INFINITY, f64::NAN].iter().all(|&df| student_p(1.0, df).is_nan()));
        assert!(student_p(f64::NAN, 1.0).is_nan());
    }
}
