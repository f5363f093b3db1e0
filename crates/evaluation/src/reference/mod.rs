//! Reference players: players that depend on nothing but their name, so that what they win says how hard a level is.
//!
//! Releases keep the results of some as marks (`plays.rs`), and the scale compares months by the versioned ones of `table.rs`
//! ([docs/explanation/difficulty.md](../../../../docs/explanation/difficulty.md)).

mod player;
mod plays;
mod table;

pub use player::ReferencePlayer;
pub use plays::{ReferencePlays, SEED};
pub use table::{SCALE_PLAYERS, ScalePlayer, scale_player_named};
