//! Sections of a recipe that add something to its games.

pub mod marks;
pub mod memory;
