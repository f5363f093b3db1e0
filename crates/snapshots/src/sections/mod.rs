//! Sections of a recipe that add something to its games.

pub(crate) mod frozen;
pub mod marks;
pub mod memory;
