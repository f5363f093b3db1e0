//! Pushing puzzles, constructed backwards. The generator searches all positions from which a floor plan can be solved,
//! and uses the farthest one as the level.

pub(crate) mod backward;
pub(crate) mod careful;
pub(crate) mod floor;
pub(crate) mod floor_plan;
pub(crate) mod lookout;
pub(crate) mod rules;
pub(crate) mod strays;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod trail;
pub(crate) mod variation;
