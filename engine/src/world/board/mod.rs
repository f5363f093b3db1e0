//! The board: the cells that sprites cover, and the sprites that overlap.

pub(crate) mod occupancy;
pub(crate) mod overlap;
pub(crate) mod placement;
pub(crate) mod span;
