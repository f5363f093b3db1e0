//! Construction of levels. A layout provides the walls, the roles of the sprite types guide the furnishing, and the
//! result is inspected.

pub(crate) mod board;
pub(crate) mod builder;
pub(crate) mod constructive;
pub(crate) mod family;
mod furnish;
pub(crate) mod inspection;
pub(crate) mod jobs;
pub(crate) mod layout;
pub(crate) mod plan;
