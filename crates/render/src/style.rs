//! The style of a picture, and its limits.

/// The fewest pixels of a cell: in smaller cells, tiles are dots.
pub const MIN_CELL: u32 = 4;
/// The most pixels of a cell.
pub const MAX_CELL: u32 = 256;
/// The most pixels of a picture.
pub const MAX_PIXELS: u64 = 1 << 26;

/// The style of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Pixels of a cell, [`MIN_CELL`] to [`MAX_CELL`].
    pub cell: u32,
    /// Tick, score, resources of the avatar and the outcome, under the board.
    pub caption: bool,
    /// The sprite types of the game with their tiles, under the board.
    pub legend: bool,
}

impl Style {
    /// Only the board, in cells of this many pixels.
    pub fn bare(cell: u32) -> Style {
        Style { cell, caption: false, legend: false }
    }

    /// Returns a cell size such that the longer side of the board has about 900 pixels, 8 to 40 each.
    pub fn cell_for(columns: u32, rows: u32) -> u32 {
        (900 / columns.max(rows).max(1)).clamp(8, 40)
    }
}
