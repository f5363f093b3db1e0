//! Operations on whole releases: minting into a folder, papers, the reveal, and regeneration.

pub(crate) mod order;
pub(crate) mod papers;
pub(crate) mod regenerate;
pub(crate) mod reveal;
