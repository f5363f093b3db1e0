//! The cost of requests: prices, estimates and caps.

pub(super) mod caps;
pub(super) mod estimate;
pub(super) mod prices;
