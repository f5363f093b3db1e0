//! Operations on a whole release: minting into a folder, the papers beside it, the reveal, and minting again.

pub(crate) mod order;
pub(crate) mod papers;
pub(crate) mod regenerate;
pub(crate) mod reveal;
