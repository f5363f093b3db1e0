//! Statistics for win rates and scores: intervals, tests, corrections and summaries that are the same bits on every machine.
//!
//! Depends on nothing of ours. Only `+ - * /` and square roots are used, in a stated order; what is drawn is drawn from
//! ChaCha8 with the caller's seed.
//!
//! ```
//! use statistics::{Summary, Z95, wilson};
//!
//! let interval = wilson(19, 25, Z95);
//! assert!(interval.low > 0.56 && interval.high < 0.89);
//! assert_eq!(Summary::of(&[3.0, 1.0, 2.0]).map(|summary| summary.median), Some(2.0));
//! ```

mod bootstrap;
mod correction;
mod difference;
mod fisher;
mod quantile;
mod spearman;
mod summary;
mod wilson;

pub use bootstrap::{bootstrap, bootstrap_difference};
pub use correction::benjamini_hochberg;
pub use difference::difference;
pub use fisher::fisher;
pub use quantile::quantile;
pub use spearman::spearman;
pub use summary::Summary;
pub use wilson::{Interval, Z95, wilson};
