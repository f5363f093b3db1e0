//! Statistics for win rates and scores. The crate provides intervals, tests, corrections and summaries, a [scale] of
//! difficulty and ability, and exact memory tests ([`coin_test`]).
//!
//! The results are bit-identical on every machine, with the exceptions listed below. The crate depends on no
//! other workspace crate. It uses only `+ - * /`, square roots and `libm`, in a fixed order. Random numbers
//! come from ChaCha8, with the caller's seed.
//!
//! The exceptions are the p-values from [`student_p`], [`correlation_p`], [`welch()`] and [`paired_over_games`], and
//! the sample sizes computed by [`Power`] and [`Design`]. They are computed with distributions from a library. Their
//! last digits may differ between machines, so they are intended only for reports.
//!
//! ```
//! use infinite_arcade_statistics::{Summary, Z95, wilson};
//!
//! let interval = wilson(19, 25, Z95);
//! assert!(interval.low > 0.56 && interval.high < 0.89);
//! assert_eq!(Summary::of(&[3.0, 1.0, 2.0]).map(|summary| summary.median), Some(2.0));
//! ```

mod chi_squared;
mod comparisons;
mod intervals;
pub mod memory_simulation;
mod planning;
mod quantile;
pub mod scale;
pub mod simulation;
mod student;
mod summary;

pub use chi_squared::chi_squared_p;
pub use comparisons::cohen::cohens_h;
pub use comparisons::contamination::{CoinTest, Memoriser, coin_power, coin_test};
pub use comparisons::correction::{benjamini_hochberg, bonferroni};
pub use comparisons::fisher::fisher;
pub use comparisons::pearson::{correlation_p, pearson};
pub use comparisons::spearman::spearman;
pub use comparisons::stratified::{Stratified, Stratum, stratified};
pub use comparisons::welch::{Welch, welch};
pub use intervals::bootstrap::{bootstrap, bootstrap_difference};
pub use intervals::clustered::clustered_mean;
pub use intervals::difference::difference;
pub use intervals::half_point::{DoseTrials, HalfPoint, half_point};
pub use intervals::over_games::{
    PairedOverGames, RateOverGames, paired_over_games, rate_over_games, share_over_games,
};
pub use intervals::ratio::{Bounded, ratio, weighted_mean};
pub use intervals::wilson::{Interval, Z95, wilson};
pub use planning::design::{Design, Spread};
pub use planning::power::{Power, fisher_power};
pub use quantile::quantile;
pub use student::{student_p, student_quantile};
pub use summary::Summary;
