//! Placement of sprites on boards, with one file for each kind of game.

pub(crate) mod adventure;
pub(crate) mod cover;
pub(crate) mod crossing;
pub(crate) mod gallery;
pub(crate) mod pulls;
pub(crate) mod vault;
pub(crate) mod warehouse;
