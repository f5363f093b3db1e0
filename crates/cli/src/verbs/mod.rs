//! The subcommands. Each has its own file or folder, with its flags, behaviour and output. The folders
//! correspond to the help groups.

pub(crate) mod games;
pub(crate) mod players;
pub(crate) mod program;
pub(crate) mod releases;
