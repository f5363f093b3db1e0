//! A study's games and levels.

pub(super) mod ceilings;
pub(super) mod difficulty;
pub(super) mod marks;
pub(super) mod mirror;
pub(super) mod taxonomy;
