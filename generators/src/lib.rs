//! Pure functions of a configuration and a seed that make levels and games.
//!
//! Generators never judge what they make: `snapshots::mint` is where a candidate meets its judges.

mod annealing;
mod error;
pub mod games;
mod generator;
pub mod levels;
mod search;

pub use annealing::{Annealing, AnnealingConfig};
pub use error::GenerateError;
pub use generator::Generator;
pub use search::{Evaluation, Search, Variation};

/// Bumped when any minted byte moves for an unchanged recipe.
pub const GENERATION: u32 = 3;
