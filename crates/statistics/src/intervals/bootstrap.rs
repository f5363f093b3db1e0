//! Percentile bootstrap intervals for statistics without a formula (B. Efron, "Bootstrap methods: another
//! look at the jackknife", 1979).
//!
//! The random numbers come from ChaCha8, and Lemire's method maps them to a range. Both algorithms are fixed, so the
//! same seed gives the same interval everywhere.

use super::wilson::Interval;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Returns the percentile interval for a statistic over `values`. For example, the statistic can be a mean, or a
/// difference in means between groups if each value states its group.
///
/// Draws `resamples` samples of the same size with replacement, and returns the range of the central fraction `level`
/// of their statistics (0.95 for 95%). With `m` resamples, the bounds are the values with rank
/// ⌊(1 − level) / 2 · (m − 1)⌋ from below and from above. Returns `None` if there are no values or resamples, if a
/// statistic is NaN, or if `level` is not within 0..1. Cost: O(resamples · values).
///
/// ```
/// use infinite_arcade_statistics::bootstrap;
/// let scores = [3.0, 4.0, 5.0, 4.0, 6.0, 2.0, 4.0, 5.0];
/// let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
/// let interval = bootstrap(&scores, mean, 1000, 0.95, [7; 32]).unwrap();
/// assert!(interval.low < 4.1 && 4.1 < interval.high);
/// ```
pub fn bootstrap<T: Copy>(
    values: &[T],
    statistic: impl Fn(&[T]) -> f64,
    resamples: usize,
    level: f64,
    seed: [u8; 32],
) -> Option<Interval> {
    if values.is_empty() || resamples == 0 || !(0.0..1.0).contains(&level) {
        return None;
    }
    let mut draws = ChaCha8Rng::from_seed(seed);
    let mut sample = Vec::with_capacity(values.len());
    let found = (0..resamples).map(|_| {
        redraw(&mut draws, values, &mut sample);
        statistic(&sample)
    });
    percentiles(found.collect(), level)
}

/// Returns the percentile interval for the mean of `ours` minus the mean of `theirs`. The method is the same as in
/// [`bootstrap`], but with a separate sample for each side. The sample from `ours` is drawn first. Returns `None` in
/// the same cases as [`bootstrap`], including if only one side has no values.
///
/// ```
/// use infinite_arcade_statistics::bootstrap_difference;
/// let interval = bootstrap_difference(&[3.0, 4.0, 5.0], &[1.0, 2.0], 1000, 0.95, [7; 32]).unwrap();
/// assert!(interval.low >= 1.0 && interval.high <= 4.0);
/// ```
pub fn bootstrap_difference(
    ours: &[f64],
    theirs: &[f64],
    resamples: usize,
    level: f64,
    seed: [u8; 32],
) -> Option<Interval> {
    if ours.is_empty() || theirs.is_empty() || resamples == 0 || !(0.0..1.0).contains(&level) {
        return None;
    }
    let mut draws = ChaCha8Rng::from_seed(seed);
    let mut sample = Vec::with_capacity(ours.len().max(theirs.len()));
    let mut mean = |values: &[f64]| {
        redraw(&mut draws, values, &mut sample);
        sample.iter().sum::<f64>() / sample.len() as f64
    };
    let found = (0..resamples).map(|_| mean(ours) - mean(theirs));
    percentiles(found.collect(), level)
}

/// Draws a sample of the same size as `values`, with replacement.
fn redraw<T: Copy>(draws: &mut ChaCha8Rng, values: &[T], sample: &mut Vec<T>) {
    sample.clear();
    sample.extend((0..values.len()).map(|_| values[below(draws, values.len())]));
}

fn percentiles(mut found: Vec<f64>, level: f64) -> Option<Interval> {
    if found.iter().any(|value| value.is_nan()) {
        return None;
    }
    found.sort_unstable_by(f64::total_cmp);
    let rank = ((1.0 - level) / 2.0 * (found.len() - 1) as f64) as usize;
    Some(Interval { low: found[rank], high: found[found.len() - 1 - rank] })
}

/// Draws uniformly from `0..bound`, without bias (D. Lemire, "Fast random integer generation in an interval", 2019).
pub(crate) fn below(draws: &mut ChaCha8Rng, bound: usize) -> usize {
    let bound = bound as u64;
    loop {
        let wide = u128::from(draws.next_u64()) * u128::from(bound);
        if wide as u64 >= bound.wrapping_neg() % bound {
            return (wide >> 64) as usize;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(sample: &[f64]) -> f64 {
        sample.iter().sum::<f64>() / sample.len() as f64
    }

    /// Reports contain these bits, so any change must be deliberate.
    #[test]
    fn golden() {
        let values: Vec<f64> = (0..25).map(f64::from).collect();
        let found = bootstrap(&values, mean, 999, 0.95, [1; 32]).unwrap();
        assert_eq!((found.low, found.high), GOLDEN);
    }

    const GOLDEN: (f64, f64) = (9.16, 14.96);

    /// If half of the values are 0 and half are 1, the mean of n values has a standard error of 1 / (2 √n).
    #[test]
    fn it_is_as_wide_as_theory_says() {
        let values: Vec<f64> = (0..400).map(|i| f64::from(i % 2)).collect();
        let found = bootstrap(&values, mean, 4000, 0.95, [2; 32]).unwrap();
        let half = 1.96 * 0.5 / 20.0;
        assert!((found.low - (0.5 - half)).abs() < 0.006, "{found:?}");
        assert!((found.high - (0.5 + half)).abs() < 0.006, "{found:?}");
    }

    #[test]
    fn samples_of_anything() {
        let values = [(0, 1.0), (1, 5.0)];
        let found = bootstrap(&values, |sample| sample.iter().map(|one| one.1).sum(), 50, 0.9, [3; 32]);
        assert_eq!(found, Some(Interval { low: 2.0, high: 10.0 }));
    }

    /// For a difference of two means, the squares of the standard errors add up.
    #[test]
    fn differences_are_as_wide_as_theory_says() {
        let [ours, theirs] = [(400, 3), (100, 2)].map(|(count, every): (u32, u32)| {
            (0..count).map(|i| f64::from(u8::from(i % every == 0))).collect::<Vec<f64>>()
        });
        let found = bootstrap_difference(&ours, &theirs, 4000, 0.95, [4; 32]).unwrap();
        let (p, q): (f64, f64) = (134.0 / 400.0, 0.5);
        let half = 1.96 * (p * (1.0 - p) / 400.0 + q * (1.0 - q) / 100.0).sqrt();
        assert!((found.low - (p - q - half)).abs() < 0.012, "{found:?}");
        assert!((found.high - (p - q + half)).abs() < 0.012, "{found:?}");
        assert_eq!(bootstrap_difference(&ours, &[], 10, 0.95, [0; 32]), None);
        let sure = bootstrap_difference(&[1.0; 3], &[0.0], 10, 0.95, [0; 32]);
        assert_eq!(sure, Some(Interval { low: 1.0, high: 1.0 }));
    }

    #[test]
    fn nothing_known() {
        assert_eq!(bootstrap(&[], mean, 10, 0.95, [0; 32]), None);
        assert_eq!(bootstrap(&[1.0], mean, 0, 0.95, [0; 32]), None);
        assert_eq!(bootstrap(&[f64::NAN], mean, 10, 0.95, [0; 32]), None);
        assert_eq!(bootstrap(&[4.0], mean, 1, 0.95, [0; 32]), Some(Interval { low: 4.0, high: 4.0 }));
    }
}
