//! Releases as a whole: the papers beside them, and minting them again.

pub(crate) mod papers;
pub(crate) mod regenerate;
pub(crate) mod reveal;
