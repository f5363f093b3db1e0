//! Reference players, which depend only on their names. Their wins show how hard a level is
//! ([docs/explanation/difficulty.md](../../../../docs/explanation/difficulty.md)).
//!
//! Releases keep the results of some reference players as marks (`plays.rs`). The scale compares months by
//! the results of the versioned players in `table.rs`.

mod player;
mod plays;
mod table;

pub use player::ReferencePlayer;
pub use plays::{ReferencePlays, SEED};
pub use table::{SCALE_PLAYERS, ScalePlayer, scale_player_named};
