//! The vocabulary of VGDL: sprite classes, avatars, effects, terminations, physics. Each set is closed: an enum, matched
//! in one place; a file holds one family of related items.

pub(crate) mod avatars;
pub(crate) mod class;
pub(crate) mod constants;
pub(crate) mod effects;
pub(crate) mod physics;
pub(crate) mod sprites;
pub(crate) mod terminations;
pub(crate) mod traits;
