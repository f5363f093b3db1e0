//! The subcommands under "Publish benchmarks" in the help.

pub(crate) mod diff;
pub(crate) mod export;
pub(crate) mod gallery;
pub(crate) mod merge;
pub(crate) mod questions;
pub(crate) mod recipes;
pub(crate) mod regenerate;
pub(crate) mod release;
pub(crate) mod trust;
pub(crate) mod verify;
