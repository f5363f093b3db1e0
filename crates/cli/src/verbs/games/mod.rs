//! The subcommands under "Make games" in the help.

pub(crate) mod describe;
pub(crate) mod design;
pub(crate) mod fmt;
pub(crate) mod generate;
pub(crate) mod lsp;
pub(crate) mod new;
pub(crate) mod play;
pub(crate) mod render;
pub(crate) mod stream;
pub(crate) mod studio;
pub(crate) mod validate;
