//! Values of flags that several subcommands share.

pub(crate) mod memory;
pub(crate) mod numbers;
pub(crate) mod threads;
