//! Sprites, and the values in which they differ from their types.

pub(crate) mod flight;
pub(crate) mod models;
pub(crate) mod moved;
pub(crate) mod overrides;
pub(crate) mod side_tables;
pub(crate) mod sprite;
