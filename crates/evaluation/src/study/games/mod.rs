//! The games and levels of a study.

pub(super) mod difficulty;
pub(super) mod marks;
pub(super) mod mirror;
pub(super) mod taxonomy;
