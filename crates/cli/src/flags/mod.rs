//! Flag values shared by several subcommands.

pub(crate) mod client;
pub(crate) mod memory;
pub(crate) mod numbers;
pub(crate) mod threads;
