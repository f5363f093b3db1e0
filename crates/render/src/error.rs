//! The errors of drawing and writing pictures.

use crate::style::{MAX_CELL, MAX_PIXELS, MIN_CELL};

/// A picture that could not be drawn or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A cell is too small or too large.
    #[error("a cell of {cell} pixels is out of range: use {MIN_CELL} to {MAX_CELL}")]
    Cell {
        /// The pixels requested.
        cell: u32,
    },
    /// The picture has too many pixels.
    #[error("the image would have {pixels} pixels, more than {MAX_PIXELS}; use smaller cells")]
    TooLarge {
        /// The number of pixels it would have.
        pixels: u64,
    },
    /// The picture has no pixels.
    #[error("an image without pixels cannot be written")]
    Empty,
    /// A frame of an animation has another size than the first one.
    #[error("a frame of {width} × {height} pixels does not fit an animation of a different size")]
    Frame {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// A GIF's sides are limited to 65,535 pixels.
    #[error("a GIF cannot be {width} × {height} pixels; use smaller cells")]
    TooLargeForGif {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// PNG data could not be written.
    #[error("the PNG could not be written")]
    Png(#[from] ::png::EncodingError),
    /// GIF data could not be written.
    #[error("the GIF could not be written")]
    Gif(#[from] ::gif::EncodingError),
}
