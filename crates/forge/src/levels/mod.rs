//! Levels on request: what `arcade generate levels` makes.
//!
//! A search proposes levels, a cheap look at each tells it what to try next, and the panel has the last word with dice of its
//! own. Levels of the constructive and the search method depend on their number and the seed alone; those of the
//! evolutionary one come from one archive. No byte depends on the number of threads.

pub(crate) mod aim;
mod axes;
mod improve;
mod look;
mod make;
mod order;
pub mod report;

pub use make::{LevelSet, LevelsError, make_levels, unconstrained_pool};
pub use order::{Effort, LevelOrder, MadeLevel, Method};
