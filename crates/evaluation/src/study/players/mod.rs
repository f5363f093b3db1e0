//! A study's players and their results.

pub(super) mod horizon;
pub(super) mod leaderboard;
pub(crate) mod person;
pub(super) mod player;
pub(super) mod sweep;
pub(super) mod times;
