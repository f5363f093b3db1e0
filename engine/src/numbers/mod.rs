//! Arithmetic with the bits of the reference: chance, rectangles, sine and cosine.

pub(crate) mod chance;
pub(crate) mod geometry;
pub(crate) mod trigonometry;
