//! The files of kernels: what they hold, and how they are read.

pub(crate) mod content;
pub(crate) mod form;
pub(crate) mod kernel;
pub(crate) mod map;
pub(crate) mod template;
