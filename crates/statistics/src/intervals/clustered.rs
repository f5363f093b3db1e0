//! The cluster bootstrap for means over the episodes of several games.
//!
//! Episodes of the same game are similar, so twenty-five such episodes are not twenty-five independent observations
//! of a player. Therefore, entire games are resampled with all their episodes (A. C. Davison and D. V. Hinkley,
//! *Bootstrap Methods and their Application*, 1997, §3.8). The interval applies to similar games in general, not only
//! to the games that were played.
//!
//! With fewer than about thirty games, the interval is too narrow. If all games agree, the interval has no
//! width. For win rates, [`rate_over_games`](crate::rate_over_games) is better.

use super::bootstrap::bootstrap;
use super::wilson::Interval;

/// Returns the percentile interval for the mean of all values, by resampling whole clusters with replacement.
/// Clusters without values are ignored. Returns `None` if there are no values, if a value is NaN, or if `level` is
/// not within 0..1. Cost: O(values + resamples · clusters).
///
/// ```
/// use infinite_arcade_statistics::clustered_mean;
/// // One game is always won and the other never, so nothing is known about a third game.
/// let games = [vec![1.0; 25], vec![0.0; 25]];
/// let interval = clustered_mean(&games, 999, 0.95, [7; 32]).unwrap();
/// assert_eq!((interval.low, interval.high), (0.0, 1.0));
/// ```
pub fn clustered_mean<C: AsRef<[f64]>>(
    clusters: &[C],
    resamples: usize,
    level: f64,
    seed: [u8; 32],
) -> Option<Interval> {
    let sums: Vec<(f64, f64)> =
        clusters.iter().map(|values| sum(values.as_ref())).filter(|(_, count)| *count > 0.0).collect();
    let mean = |sample: &[(f64, f64)]| {
        let (total, count) =
            sample.iter().fold((0.0, 0.0), |sum, cluster| (sum.0 + cluster.0, sum.1 + cluster.1));
        total / count
    };
    bootstrap(&sums, mean, resamples, level, seed)
}

/// Returns the sum and the number of values.
fn sum(values: &[f64]) -> (f64, f64) {
    (values.iter().sum(), values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// If all episodes of a game are identical, only the number of games matters.
    #[test]
    fn copies_add_nothing() {
        let games: Vec<f64> = (0..40).map(|game| f64::from(u8::from(game % 4 == 0))).collect();
        let repeated: Vec<Vec<f64>> = games.iter().map(|&value| vec![value; 25]).collect();
        let found = clustered_mean(&repeated, 2000, 0.95, [1; 32]).unwrap();
        let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
        assert_eq!(Some(found), bootstrap(&games, mean, 2000, 0.95, [1; 32]));
        // The standard error of a mean of 40 values at 0.25 gives an interval of ±13 percentage points.
        assert!((found.low - 0.116).abs() < 0.03 && (found.high - 0.384).abs() < 0.03, "{found:?}");
    }

    #[test]
    fn clusters_may_differ_in_size() {
        let found = clustered_mean(&[vec![1.0, 1.0, 1.0], vec![0.0], vec![]], 500, 0.95, [2; 32]).unwrap();
        assert_eq!((found.low, found.high), (0.0, 1.0));
    }

    #[test]
    fn nothing_known() {
        assert_eq!(clustered_mean::<Vec<f64>>(&[], 10, 0.95, [0; 32]), None);
        assert_eq!(clustered_mean(&[vec![f64::NAN]], 10, 0.95, [0; 32]), None);
    }
}
