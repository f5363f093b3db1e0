//! The style of an image, and the limits of styles.

/// The minimum cell size in pixels. In smaller cells, tiles would be mere dots.
pub const MIN_CELL: u32 = 4;
/// The maximum cell size in pixels.
pub const MAX_CELL: u32 = 256;
/// The maximum number of pixels in an image.
pub const MAX_PIXELS: u64 = 1 << 26;

/// The style of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// The cell size in pixels, from [`MIN_CELL`] to [`MAX_CELL`].
    pub cell: u32,
    /// `true` to draw the tick, the score, the avatar's resources and the outcome under the board.
    pub caption: bool,
    /// `true` to draw the game's sprite types with their tiles under the board.
    pub legend: bool,
}

impl Style {
    /// Returns a style that shows only the board, with the given cell size in pixels.
    pub fn bare(cell: u32) -> Style {
        Style { cell, caption: false, legend: false }
    }

    /// Returns a cell size from 8 to 40 pixels, chosen so that the longer side of the board has about 900
    /// pixels.
    pub fn cell_for(columns: u32, rows: u32) -> u32 {
        (900 / columns.max(rows).max(1)).clamp(8, 40)
    }
}
