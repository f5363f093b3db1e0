//! Image output formats: text, PNG, SVG and GIF.

pub(crate) mod gif;
pub(crate) mod pixels;
pub(crate) mod png;
pub(crate) mod svg;
pub(crate) mod symbols;
pub(crate) mod text;
