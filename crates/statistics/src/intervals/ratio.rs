//! Intervals for means and ratios of independent estimates, from the intervals of the estimates.

use super::wilson::Interval;

/// An estimate with its interval.
pub type Bounded = (f64, Interval);

/// Returns the mean of independent estimates with the given weights, and its interval. The distances to the limits
/// add up in quadrature (MOVER; G. Y. Zou and A. Donner, "Construction of confidence limits about effect measures: a
/// general approach", 2008). Returns `None` if the weights do not add up to a positive number.
///
/// ```
/// use infinite_arcade_statistics::{Interval, weighted_mean};
/// let half = (0.5, Interval { low: 0.4, high: 0.6 });
/// let (mean, interval) = weighted_mean(&[(half, 1.0), (half, 1.0)]).unwrap();
/// assert_eq!(mean, 0.5);
/// assert!((interval.high - 0.5 - 0.1 / 2f64.sqrt()).abs() < 1e-12);
/// ```
pub fn weighted_mean(parts: &[(Bounded, f64)]) -> Option<Bounded> {
    let total: f64 = parts.iter().map(|(_, weight)| weight).sum();
    if total <= 0.0 {
        return None;
    }
    let mean = parts.iter().map(|((value, _), weight)| value * weight).sum::<f64>() / total;
    let distance = |end: fn(&Bounded) -> f64| {
        let distances = parts.iter().map(|(part, weight)| end(part) * weight);
        distances.map(|distance| distance * distance).sum::<f64>().sqrt() / total
    };
    let low = mean - distance(|(value, interval)| value - interval.low);
    let high = mean + distance(|(value, interval)| interval.high - value);
    Some((mean, Interval { low, high }))
}

/// Returns the ratio of two independent estimates that are not negative, and its interval (MOVER for ratios; A. Donner
/// and G. Y. Zou, "Closed-form confidence intervals for functions of the normal mean and standard deviation", 2012).
/// Returns `None` if the denominator's interval contains 0.
///
/// ```
/// use infinite_arcade_statistics::{Interval, ratio};
/// let rate = (0.4, Interval { low: 0.3, high: 0.5 });
/// let (value, interval) = ratio(rate, (0.8, Interval { low: 0.8, high: 0.8 })).unwrap();
/// assert_eq!(value, 0.5);
/// assert!((interval.low - 0.375).abs() < 1e-12 && (interval.high - 0.625).abs() < 1e-12);
/// ```
pub fn ratio((over, of_over): Bounded, (under, of_under): Bounded) -> Option<Bounded> {
    if of_under.low <= 0.0 {
        return None;
    }
    let product = over * under;
    let root = |end: f64, other: f64| {
        let square = product * product - end * other * (2.0 * over - end) * (2.0 * under - other);
        square.max(0.0).sqrt()
    };
    let [low, high] = [of_under.low, of_under.high];
    let least = (product - root(of_over.low, high)) / (high * (2.0 * under - high));
    let most = (product + root(of_over.high, low)) / (low * (2.0 * under - low));
    Some((over / under, Interval { low: least, high: most }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ratio's interval is wider than it would be without the denominator's uncertainty.
    #[test]
    fn both_estimates_are_uncertain() {
        let rate = (0.4, Interval { low: 0.3, high: 0.5 });
        let (_, exact) = ratio(rate, (0.9, Interval { low: 0.9, high: 0.9 })).unwrap();
        let (_, vague) = ratio(rate, (0.9, Interval { low: 0.82, high: 0.95 })).unwrap();
        assert!(vague.low < exact.low && exact.high < vague.high, "{exact:?} {vague:?}");
        assert_eq!(ratio(rate, (0.1, Interval { low: 0.0, high: 0.3 })), None);
        assert_eq!(weighted_mean(&[]), None);
    }
}
