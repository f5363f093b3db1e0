//! The errors that can occur while drawing or writing images.

use crate::style::{MAX_CELL, MAX_PIXELS, MIN_CELL};

/// An error while drawing or writing an image.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The cell size is too small or too large.
    #[error("a cell of {cell} pixels is out of range: use {MIN_CELL} to {MAX_CELL}")]
    Cell {
        /// The requested size in pixels.
        cell: u32,
    },
    /// The image has too many pixels.
    #[error("the image would have {pixels} pixels, more than {MAX_PIXELS}; use smaller cells")]
    TooLarge {
        /// The number of pixels in the image.
        pixels: u64,
    },
    /// The image has no pixels.
    #[error("an image without pixels cannot be written")]
    Empty,
    /// An animation frame differs in size from the first frame.
    #[error("a frame has {width} × {height} pixels, but the animation has a different size")]
    Frame {
        /// The width of the frame in pixels.
        width: u32,
        /// The height of the frame in pixels.
        height: u32,
    },
    /// The image exceeds the GIF limit of 65,535 pixels per side.
    #[error("a GIF cannot be {width} × {height} pixels; use smaller cells")]
    TooLargeForGif {
        /// The width of the image in pixels.
        width: u32,
        /// The height of the image in pixels.
        height: u32,
    },
    /// The PNG data could not be written.
    #[error("the PNG could not be written")]
    Png(#[from] ::png::EncodingError),
    /// The GIF data could not be written.
    #[error("the GIF could not be written")]
    Gif(#[from] ::gif::EncodingError),
}
