//! The board: the cells that sprites cover, and overlapping sprites.

pub(crate) mod occupancy;
pub(crate) mod overlap;
pub(crate) mod placement;
pub(crate) mod span;
