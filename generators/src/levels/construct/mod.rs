//! Construction of levels: walls by a layout, furnished by the roles of the sprite types, and inspected.

pub(crate) mod board;
pub(crate) mod builder;
pub(crate) mod constructive;
pub(crate) mod family;
mod furnish;
pub(crate) mod inspection;
pub(crate) mod jobs;
pub(crate) mod layout;
pub(crate) mod plan;
