//! Statistics for win rates and scores: intervals, tests, corrections and summaries, a [scale] of difficulty and ability, and
//! exact tests of memory ([`coin_test`]), with the same bits on every machine except as noted below.
//!
//! This crate depends on no other crate of the workspace. It uses only `+ - * /`, square roots and `libm`, in a fixed
//! order; random draws come from ChaCha8 with the caller's seed. The exceptions are for reports only: the p-values of
//! [`student_p`], [`correlation_p`], [`welch()`] and [`paired_over_games`] and the sizes of [`Power`] and [`Design`] come
//! from a library's distributions, whose last digits may differ between machines.
//!
//! ```
//! use infinite_arcade_statistics::{Summary, Z95, wilson};
//!
//! let interval = wilson(19, 25, Z95);
//! assert!(interval.low > 0.56 && interval.high < 0.89);
//! assert_eq!(Summary::of(&[3.0, 1.0, 2.0]).map(|summary| summary.median), Some(2.0));
//! ```

mod bootstrap;
mod chi_squared;
mod clustered;
mod cohen;
mod contamination;
mod correction;
mod design;
mod difference;
mod draws;
mod fisher;
mod half_point;
pub mod memory_simulation;
mod over_games;
mod pearson;
mod power;
mod quantile;
pub mod scale;
pub mod simulation;
mod spearman;
mod stratified;
mod student;
mod summary;
mod welch;
mod wilson;

pub use bootstrap::{bootstrap, bootstrap_difference};
pub use chi_squared::chi_squared_p;
pub use clustered::clustered_mean;
pub use cohen::cohens_h;
pub use contamination::{CoinTest, Memoriser, coin_power, coin_test};
pub use correction::{benjamini_hochberg, bonferroni};
pub use design::{Design, Spread};
pub use difference::difference;
pub use fisher::fisher;
pub use half_point::{DoseTrials, HalfPoint, half_point};
pub use over_games::{PairedOverGames, RateOverGames, paired_over_games, rate_over_games, share_over_games};
pub use pearson::{correlation_p, pearson};
pub use power::{Power, fisher_power};
pub use quantile::quantile;
pub use spearman::spearman;
pub use stratified::{Stratified, Stratum, stratified};
pub use student::{student_p, student_quantile};
pub use summary::Summary;
pub use welch::{Welch, welch};
pub use wilson::{Interval, Z95, wilson};
