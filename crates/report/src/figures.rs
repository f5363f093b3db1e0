//! Figures with confidence intervals, such as fractions, means and quantiles.

use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};
use statistics::{Z95, bootstrap, quantile, wilson};

/// A fraction of a set of items, and its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// The number of counted items.
    pub count: u64,
    /// The total number of items.
    pub of: u64,
    /// The fraction's 95% Wilson interval.
    pub interval: [f64; 2],
}

impl Share {
    /// Creates the fraction `count` / `of`, and computes its interval.
    pub fn new(count: u64, of: u64) -> Share {
        let interval = wilson(count, of, Z95);
        Share { count, of, interval: [interval.low, interval.high] }
    }

    /// Returns the fraction of `true` answers.
    pub fn yes(answers: impl IntoIterator<Item = bool>) -> Share {
        let (mut count, mut of) = (0, 0);
        for answer in answers {
            count += u64::from(answer);
            of += 1;
        }
        Share::new(count, of)
    }

    /// Returns the fraction as a number between 0 and 1, or 0 if the total is 0.
    pub fn share(&self) -> f64 {
        self.count as f64 / self.of.max(1) as f64
    }
}

/// A mean over a set of items.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    /// The mean of the items' values.
    pub mean: f64,
    /// The 95% bootstrap interval, obtained by resampling the items.
    pub interval: [f64; 2],
    /// The number of items.
    pub count: u64,
    /// The name of an item in the singular, such as `level`. In JSON, the count's key is the plural of the
    /// name.
    pub item: &'static str,
}

const RESAMPLES: usize = 2000;

impl Mean {
    /// Returns the mean of the given values, one per item, or `None` if there are no values.
    pub fn over(item: &'static str, values: &[f64]) -> Option<Mean> {
        let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
        let interval = bootstrap(values, mean, RESAMPLES, 0.95, [0; 32])?;
        let [low, high] = [interval.low, interval.high];
        Some(Mean { mean: mean(values), interval: [low, high], count: values.len() as u64, item })
    }
}

impl Serialize for Mean {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(3))?;
        map.serialize_entry("mean", &self.mean)?;
        map.serialize_entry("interval", &self.interval)?;
        map.serialize_entry(&format!("{}s", self.item), &self.count)?;
        map.end()
    }
}

/// The quantiles of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantiles {
    /// The sample size.
    pub count: u64,
    /// The sample minimum.
    pub min: f64,
    /// The lower quartile.
    pub lower: f64,
    /// The sample median.
    pub median: f64,
    /// The upper quartile.
    pub upper: f64,
    /// The sample maximum.
    pub max: f64,
}

impl Quantiles {
    /// Returns the quantiles of the given values, or `None` if there are no values.
    pub fn of(values: &[f64]) -> Option<Quantiles> {
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
