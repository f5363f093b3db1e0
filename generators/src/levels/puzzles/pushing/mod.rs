//! Pushing puzzles, constructed backwards. All positions from which a floor plan can be solved are searched, and the
//! farthest position becomes the level.

pub(crate) mod backward;
pub(crate) mod floor;
pub(crate) mod floor_plan;
pub(crate) mod rules;
pub(crate) mod strays;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod trail;
pub(crate) mod variation;
