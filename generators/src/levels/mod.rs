//! Level generators for any game: the roles of sprite types (such as wall, danger, collectable, key or spawner) are
//! derived from the rules.

mod adventure;
mod board;
mod builder;
mod config;
mod constructive;
mod cover;
mod crossing;
mod draft;
mod edits;
mod examples;
mod family;
mod fuse;
mod gallery;
mod grid;
mod inspection;
mod jobs;
mod layout;
mod locks;
mod lookout;
mod measures;
mod palette;
mod placement;
mod plan;
mod pulls;
mod puzzles;
mod search;
mod symmetry;
mod variation;
mod vault;
mod warehouse;
mod yards;

pub use config::LevelConfig;
pub use constructive::{ConstructiveLevels, Solved};
pub use examples::{Examples, cover};
pub(crate) use fuse::FuseSymbols;
pub use locks::{LockConfig, LockLevel};
pub use measures::{LevelMeasure, LevelMeasures};
pub use puzzles::{PuzzleConfig, PuzzleTarget, PuzzleVariation, StrayConfig, StrayLevel, StrayLevels};
pub use search::LevelSearch;
pub use symmetry::LevelSimilarity;
pub use variation::LevelVariation;
pub use yards::{YardConfig, YardLevel};
