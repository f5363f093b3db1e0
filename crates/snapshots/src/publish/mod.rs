//! Operations on whole releases: minting into a folder, papers (documents such as the licence), the reveal of withheld
//! files, and regeneration.

pub(crate) mod order;
pub(crate) mod papers;
pub(crate) mod regenerate;
pub(crate) mod reveal;
