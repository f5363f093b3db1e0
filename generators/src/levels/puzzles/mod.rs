//! Puzzles generated to meet a target: pushing puzzles, lock puzzles, and yards (carrying parcels among carts).

pub(crate) mod fuse;
pub(crate) mod locks;
mod pushing;
pub(crate) mod yards;

pub use pushing::careful::CarefulPlayer;
pub use pushing::strays::{StrayConfig, StrayLevel, StrayLevels};
pub use pushing::variation::{PuzzleConfig, PuzzleTarget, PuzzleVariation};
