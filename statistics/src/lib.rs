//! Statistics for win rates and scores: intervals and summaries that are the same bits on every machine.
//!
//! Depends on nothing of ours. Only `+ - * /` and square roots are used, in a stated order.
//!
//! ```
//! use statistics::{Summary, Z95, wilson};
//!
//! let interval = wilson(19, 25, Z95);
//! assert!(interval.low > 0.56 && interval.high < 0.89);
//! assert_eq!(Summary::of(&[3.0, 1.0, 2.0]).map(|summary| summary.median), Some(2.0));
//! ```

mod summary;
mod wilson;

pub use summary::Summary;
pub use wilson::{Interval, Z95, wilson};
