//! Level generators for any game. The roles of sprite types (such as wall, danger, collectable, key or spawner) are
//! derived from the rules.

mod config;
mod construct;
mod examples;
pub(crate) mod grid;
mod measures;
pub(crate) mod palette;
mod placement;
mod puzzles;
mod symmetry;
mod vary;

pub use config::LevelConfig;
pub use construct::constructive::{ConstructiveLevels, Solved};
pub use examples::{Examples, cover};
pub use measures::{LevelMeasure, LevelMeasures};
pub(crate) use puzzles::fuse::FuseSymbols;
pub use puzzles::locks::{LockConfig, LockLevel};
pub use puzzles::yards::{YardConfig, YardLevel};
pub use puzzles::{
    CarefulPlayer, PuzzleConfig, PuzzleTarget, PuzzleVariation, StrayConfig, StrayLevel, StrayLevels,
};
pub use symmetry::LevelSimilarity;
pub use vary::search::LevelSearch;
pub use vary::variation::LevelVariation;
