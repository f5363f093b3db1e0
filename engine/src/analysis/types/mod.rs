//! Sprite types: their own properties, and their roles in levels.

pub(crate) mod facts;
pub(crate) mod marks;
pub(crate) mod role;
pub(crate) mod scenery;
