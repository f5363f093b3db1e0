//! Puzzles of pushed things, made backwards: all positions from which a floor plan can be solved are searched, and the
//! farthest one becomes the level.

mod backward;
mod floor;
mod floor_plan;
mod rules;
mod strays;
#[cfg(test)]
mod tests;
mod trail;
mod variation;

pub use strays::{StrayConfig, StrayLevel, StrayLevels};
pub use variation::{PuzzleConfig, PuzzleTarget, PuzzleVariation};
