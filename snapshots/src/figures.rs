//! Figures with their bands.

use serde::{Deserialize, Serialize};
use statistics::{Z95, bootstrap, quantile, wilson};

/// So many of so many.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// How many.
    pub count: u64,
    /// Of how many.
    pub of: u64,
    /// Wilson's interval of the share, 95 %.
    pub interval: [f64; 2],
}

impl Share {
    /// So many of so many.
    pub fn new(count: u64, of: u64) -> Share {
        let interval = wilson(count, of, Z95);
        Share { count, of, interval: [interval.low, interval.high] }
    }

    /// How many of some answers are yes.
    pub(crate) fn yes(answers: impl IntoIterator<Item = bool>) -> Share {
        let (mut count, mut of) = (0, 0);
        for answer in answers {
            count += u64::from(answer);
            of += 1;
        }
        Share::new(count, of)
    }

    /// The share, from 0 to 1; 0 of nothing.
    pub fn share(&self) -> f64 {
        self.count as f64 / self.of.max(1) as f64
    }
}

/// A mean over levels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its bootstrap interval, 95 %, with the levels drawn anew.
    pub interval: [f64; 2],
    /// Over how many levels.
    pub levels: u64,
}

/// Resamples of an interval.
const RESAMPLES: usize = 2000;

impl Estimate {
    /// The mean of some values; none of no values.
    pub(crate) fn of(values: &[f64]) -> Option<Estimate> {
        let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
        let interval = bootstrap(values, mean, RESAMPLES, 0.95, [0; 32])?;
        let [low, high] = [interval.low, interval.high];
        Some(Estimate { mean: mean(values), interval: [low, high], levels: values.len() as u64 })
    }
}

/// A sample in a few numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantiles {
    /// Of how many values.
    pub count: u64,
    /// The smallest.
    pub min: f64,
    /// A quarter is at most this.
    pub lower: f64,
    /// The middle.
    pub median: f64,
    /// Three quarters are at most this.
    pub upper: f64,
    /// The greatest.
    pub max: f64,
}

impl Quantiles {
    /// The quantiles of some values; none of no values.
    pub(crate) fn of(values: &[f64]) -> Option<Quantiles> {
        let at = |share| quantile(values, share);
        Some(Quantiles {
            count: values.len() as u64,
            min: at(0.0)?,
            lower: at(0.25)?,
            median: at(0.5)?,
            upper: at(0.75)?,
            max: at(1.0)?,
        })
    }
}
