//! The errors that can occur when pictures are drawn or written.

use crate::style::{MAX_CELL, MAX_PIXELS, MIN_CELL};

/// An error while drawing or writing a picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The cell size is too small or too large.
    #[error("a cell of {cell} pixels is out of range: use {MIN_CELL} to {MAX_CELL}")]
    Cell {
        /// The requested size in pixels.
        cell: u32,
    },
    /// The picture has too many pixels.
    #[error("the image would have {pixels} pixels, more than {MAX_PIXELS}; use smaller cells")]
    TooLarge {
        /// The number of pixels that the picture would have.
        pixels: u64,
    },
    /// The picture has no pixels.
    #[error("an image without pixels cannot be written")]
    Empty,
    /// The size of an animation's frame differs from the size of the first frame.
    #[error("a frame of {width} × {height} pixels does not fit an animation of a different size")]
    Frame {
        /// The width of the frame in pixels.
        width: u32,
        /// The height of the frame in pixels.
        height: u32,
    },
    /// The picture exceeds a GIF's limit of 65,535 pixels per side.
    #[error("a GIF cannot be {width} × {height} pixels; use smaller cells")]
    TooLargeForGif {
        /// The width of the picture in pixels.
        width: u32,
        /// The height of the picture in pixels.
        height: u32,
    },
    /// The PNG data could not be written.
    #[error("the PNG could not be written")]
    Png(#[from] ::png::EncodingError),
    /// The GIF data could not be written.
    #[error("the GIF could not be written")]
    Gif(#[from] ::gif::EncodingError),
}
