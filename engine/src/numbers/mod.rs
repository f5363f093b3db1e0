//! Arithmetic that matches the reference bit for bit: random numbers, rectangles, sine and cosine.

pub(crate) mod chance;
pub(crate) mod geometry;
pub(crate) mod trigonometry;
