//! Levels on request, as made by `arcade generate levels`.
//!
//! A search proposes levels, a cheap look at each level guides the search, and the panel makes the final decision with
//! its own seeds. Levels of the constructive and the search method depend only on their number and the seed. Levels of
//! the evolutionary method come from one archive. No byte depends on the number of threads.

pub(crate) mod aim;
mod axes;
mod improve;
mod look;
mod make;
mod order;
pub mod report;

pub use make::{LevelSet, LevelsError, make_levels, unconstrained_pool};
pub use order::{Effort, LevelOrder, MadeLevel, Method};
