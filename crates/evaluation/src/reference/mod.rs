//! Reference players, each completely determined by its name. Their wins show how hard a level is
//! ([docs/explanation/difficulty.md](../../../../docs/explanation/difficulty.md)).
//!
//! Releases store the results of some reference players (`plays.rs`). The scale uses the results of the versioned
//! players in `table.rs` to compare monthly releases.

mod player;
mod plays;
mod table;

pub use player::ReferencePlayer;
pub use plays::{ReferencePlays, SEED};
pub use table::{SCALE_PLAYERS, ScalePlayer, scale_player_named};
