//! The format of kernel files, and its parser.

pub(crate) mod content;
pub(crate) mod form;
pub(crate) mod kernel;
pub(crate) mod map;
pub(crate) mod template;
