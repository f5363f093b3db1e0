//! Memory tests, which show whether a player has seen a release's games or their published solutions.
//!
//! For each game or level, a secret random choice (a "coin") decided which of two renamings, or which of two wins, was
//! published and which was withheld ([`statistics::coin_test`]). This module reads players' results on both items and
//! compares them.

mod coins;
mod findings;
mod power;
mod read;

pub use coins::{Coins, GameCoin, LevelCoin};
pub use findings::{Contamination, Evidence, PlayerMemory, SideTest, contamination};
pub use power::{ALPHA, Power, SHARES, design};
pub use read::{PlayedEpisode, PlayerEpisodes, episodes_by_player};
