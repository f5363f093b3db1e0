//! Tests of memory, which show whether a player has seen the games of a release or their published solutions.
//!
//! A release contains coins. Each coin decided which of two renamings of a game, or which of two wins of a
//! level, was published and which was withheld ([`statistics::coin_test`]). This module reads and compares
//! the results of players on both sides.

mod coins;
mod findings;
mod power;
mod read;

pub use coins::{Coins, GameCoin, LevelCoin};
pub use findings::{Contamination, Evidence, PlayerMemory, SideTest, contamination};
pub use power::{ALPHA, Power, SHARES, design};
pub use read::{PlayedEpisode, PlayerEpisodes, episodes_by_player};
