//! Sprite types: what they are by themselves, and the role that they play.

pub(crate) mod facts;
pub(crate) mod marks;
pub(crate) mod role;
pub(crate) mod scenery;
