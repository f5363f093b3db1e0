//! Goals of a game: what wins and loses it, whether that can happen, and what it needs.

pub(crate) mod attain;
pub(crate) mod goal;
pub(crate) mod requirement;
pub(crate) mod win_methods;
