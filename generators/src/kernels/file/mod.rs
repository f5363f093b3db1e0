//! The format and the parsing of kernel files.

pub(crate) mod content;
pub(crate) mod form;
pub(crate) mod kernel;
pub(crate) mod map;
pub(crate) mod template;
