//! Construction of levels. A layout provides the walls, sprites are placed according to the roles of their types, and
//! the result is inspected.

pub(crate) mod board;
pub(crate) mod builder;
pub(crate) mod constructive;
pub(crate) mod family;
mod furnish;
pub(crate) mod inspection;
pub(crate) mod jobs;
pub(crate) mod layout;
pub(crate) mod plan;
