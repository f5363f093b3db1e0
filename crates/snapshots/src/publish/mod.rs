//! Operations on a whole release: minting into a folder, its papers, the reveal, and minting again.

pub(crate) mod order;
pub(crate) mod papers;
pub(crate) mod regenerate;
pub(crate) mod reveal;
