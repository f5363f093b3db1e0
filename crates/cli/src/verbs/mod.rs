//! The subcommands, each in its own file or folder: flags, behaviour and output. The folders correspond to
//! the help groups.

pub(crate) mod games;
pub(crate) mod players;
pub(crate) mod program;
pub(crate) mod releases;
