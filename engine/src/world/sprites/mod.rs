//! Sprites, and the values that differ between a sprite and its type.

pub(crate) mod flight;
pub(crate) mod models;
pub(crate) mod moved;
pub(crate) mod overrides;
pub(crate) mod side_tables;
pub(crate) mod sprite;
