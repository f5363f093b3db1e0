//! Cohen's h, an effect size for two proportions that is independent of the number of trials (J. Cohen,
//! *Statistical Power Analysis for the Behavioral Sciences*, 1988, chapter 6).

/// Returns Cohen's h, `2 asin √p − 2 asin √q`, within [−π, π]. By convention, an h of 0.2 is small, 0.5 is
/// medium, and 0.8 is large.
///
/// The arcsine transformation gives a proportion from `n` trials a variance of about `1 / n`, regardless of the
/// proportion. Equal values of h are therefore equally hard to detect. Returns NaN if a value is not a proportion.
///
/// ```
/// use infinite_arcade_statistics::cohens_h;
/// assert!((cohens_h(0.64, 0.16) - 1.0315567).abs() < 1e-7);
/// ```
pub fn cohens_h(p: f64, q: f64) -> f64 {
    angle(p) - angle(q)
}

/// Returns `2 asin √p`, or NaN if `p` is not a proportion.
pub(crate) fn angle(p: f64) -> f64 {
    2.0 * libm::asin(p.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vectors come from `spec/06` §3.1. Additional digits were computed with decimal arithmetic.
    #[test]
    #[expect(clippy::approx_constant, reason = "printed like the others")]
    fn published_vectors() {
        for (p, q, printed, exact) in [
            (1.0, 0.0, 3.141593, 3.14159265358979),
            (0.8, 0.0, 2.214297, 2.21429743558818),
            (0.6, 0.0, 1.772154, 1.77215424758523),
            (0.4, 0.0, 1.369438, 1.36943840600457),
            (0.2, 0.0, 0.927295, 0.927295218001612),
            (0.8, 0.2, 1.287002, 1.28700221758657),
            (16.0 / 25.0, 4.0 / 25.0, 1.031557, 1.03155674386825),
            (0.0, 2.0 / 25.0, -0.573513, -0.573513104423097),
        ] {
            let found = cohens_h(p, q);
            assert!((found - printed).abs() < 5.1e-7, "{p}, {q}: {found}, not {printed}");
            assert!((found - exact).abs() < 1e-13, "{p}, {q}: {found}, not {exact}");
            assert_eq!(cohens_h(q, p), -found);
        }
        assert_eq!(cohens_h(0.3, 0.3), 0.0);
    }

    #[test]
    fn no_proportion() {
        assert!([f64::NAN, -0.1, 1.1].iter().all(|&p| cohens_h(p, 0.5).is_nan()));
    }
}
