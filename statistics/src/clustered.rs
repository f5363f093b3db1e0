//! Intervals for means over episodes of several games. Episodes of one game are alike, so twenty-five of them are not
//! twenty-five independent observations of a player: whole games are resampled, with all their episodes (A. C.
//! Davison and D. V. Hinkley, *Bootstrap Methods and their Application*, 1997, §3.8). The result holds for games like
//! these, not only for these games; with few games it is wide, and with fewer than about ten still too narrow.

use crate::bootstrap::bootstrap;
use crate::wilson::Interval;

/// Returns the percentile interval of the mean of all values, with games drawn with replacement. `None` without
/// values, if one is not a number, or if `level` is not within 0..1; clusters without values are left out. Cost:
/// O(values + resamples · clusters).
///
/// ```
/// use infinite_arcade_statistics::clustered_mean;
/// // One game is always won, the other never: nothing is known of a third.
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

/// Returns the percentile interval of the mean of ours minus the mean of theirs: a pair of clusters holds the values
/// of both sides on one game, and is drawn as a whole, so that the difficulty of a game cancels. `None` as for
/// [`clustered_mean`], or if no cluster has values on both sides; the others are left out.
///
/// ```
/// use infinite_arcade_statistics::clustered_difference;
/// let games = [(vec![1.0, 1.0], vec![0.0, 1.0]), (vec![0.0, 1.0], vec![0.0, 0.0])];
/// let interval = clustered_difference(&games, 999, 0.95, [7; 32]).unwrap();
/// assert_eq!((interval.low, interval.high), (0.5, 0.5));
/// ```
pub fn clustered_difference<C: AsRef<[f64]>>(
    clusters: &[(C, C)],
    resamples: usize,
    level: f64,
    seed: [u8; 32],
) -> Option<Interval> {
    let pairs: Vec<[(f64, f64); 2]> = clusters
        .iter()
        .map(|(ours, theirs)| [sum(ours.as_ref()), sum(theirs.as_ref())])
        .filter(|pair| pair.iter().all(|(_, count)| *count > 0.0))
        .collect();
    let difference = |sample: &[[(f64, f64); 2]]| {
        let mean = |side: usize| {
            let add = |sum: (f64, f64), pair: &[(f64, f64); 2]| (sum.0 + pair[side].0, sum.1 + pair[side].1);
            let (total, count) = sample.iter().fold((0.0, 0.0), add);
            total / count
        };
        mean(0) - mean(1)
    };
    bootstrap(&pairs, difference, resamples, level, seed)
}

/// Returns the sum and the number of values.
fn sum(values: &[f64]) -> (f64, f64) {
    (values.iter().sum(), values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bootstrap_difference;

    /// With identical episodes in each game, only the number of games counts.
    #[test]
    fn copies_add_nothing() {
        let games: Vec<f64> = (0..40).map(|game| f64::from(u8::from(game % 4 == 0))).collect();
        let repeated: Vec<Vec<f64>> = games.iter().map(|&value| vec![value; 25]).collect();
        let found = clustered_mean(&repeated, 2000, 0.95, [1; 32]).unwrap();
        let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
        assert_eq!(Some(found), bootstrap(&games, mean, 2000, 0.95, [1; 32]));
        // The standard error of a mean of 40 at 0.25: ±13 points.
        assert!((found.low - 0.116).abs() < 0.03 && (found.high - 0.384).abs() < 0.03, "{found:?}");
    }

    #[test]
    fn clusters_may_differ_in_size() {
        let found = clustered_mean(&[vec![1.0, 1.0, 1.0], vec![0.0], vec![]], 500, 0.95, [2; 32]).unwrap();
        assert_eq!((found.low, found.high), (0.0, 1.0));
    }

    /// Both players do better on easy games; paired, the difference is significant, unpaired it is not.
    #[test]
    fn pairs_cancel_what_both_share() {
        let rates: Vec<f64> = (0..10).map(|game| f64::from(game) / 10.0).collect();
        let pairs: Vec<(Vec<f64>, Vec<f64>)> =
            rates.iter().map(|rate| (vec![rate + 0.1; 5], vec![*rate; 5])).collect();
        let paired = clustered_difference(&pairs, 1000, 0.95, [3; 32]).unwrap();
        assert!((paired.low - 0.1).abs() < 1e-9 && (paired.high - 0.1).abs() < 1e-9, "{paired:?}");
        let ours: Vec<f64> = rates.iter().map(|rate| rate + 0.1).collect();
        assert!(bootstrap_difference(&ours, &rates, 1000, 0.95, [3; 32]).unwrap().low < 0.0);
    }

    #[test]
    fn nothing_known() {
        assert_eq!(clustered_mean::<Vec<f64>>(&[], 10, 0.95, [0; 32]), None);
        assert_eq!(clustered_mean(&[vec![f64::NAN]], 10, 0.95, [0; 32]), None);
        assert_eq!(clustered_difference(&[(vec![1.0], vec![])], 10, 0.95, [0; 32]), None);
    }
}
