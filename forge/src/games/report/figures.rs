//! Means over games.

use serde::{Deserialize, Serialize};
use statistics::bootstrap;

/// Resamples of an interval.
const RESAMPLES: usize = 2000;

/// A mean over games.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mean {
    /// The mean.
    pub mean: f64,
    /// Its bootstrap interval, 95 %, with the games drawn anew.
    pub interval: [f64; 2],
    /// Over how many games.
    pub games: u64,
}

impl Mean {
    /// The mean of some values; none of no values.
    pub(super) fn of(values: &[f64]) -> Option<Mean> {
        let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
        let interval = bootstrap(values, mean, RESAMPLES, 0.95, [0; 32])?;
        Some(Mean { mean: mean(values), interval: [interval.low, interval.high], games: values.len() as u64 })
    }
}
