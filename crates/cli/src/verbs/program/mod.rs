//! The subcommands under "This program" in the help.

pub(crate) mod clean;
pub(crate) mod completions;
pub(crate) mod docs;
pub(crate) mod man;
