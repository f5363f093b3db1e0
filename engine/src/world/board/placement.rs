//! Placement of rectangles in the board's cells. The ring around the board has column 0 and row 0.

use crate::numbers::geometry::Rect;
use crate::world::{Slot, Sprite, World, flag};

/// The cell of a sprite's top-left corner, with the flags in [`flag::PLACEMENT`], which describe how the
/// sprite lies in the cell.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Located {
    pub(crate) column: i16,
    pub(crate) row: i16,
    pub(crate) flags: u32,
}

/// The number of fractional bits of [`reciprocal`].
const RECIPROCAL: u32 = 40;

/// Returns a factor that divides by the cell size. A pixel times this factor, without its fractional bits, is
/// the pixel's cell. The quotient is exact because no pixel on a board times its cell size reaches 2⁴⁰.
pub(crate) fn reciprocal(block: i32) -> u64 {
    (1 << RECIPROCAL) / u64::from(block.unsigned_abs()) + 1
}

impl World {
    /// Returns the column of a pixel. Column 0 is the ring to the left of the board.
    pub(crate) fn column(&self, x: i32) -> i32 {
        x.div_euclid(self.block).clamp(-1, self.columns) + 1
    }

    /// Returns the row of a pixel. Row 0 is the ring above the board.
    pub(crate) fn row(&self, y: i32) -> i32 {
        y.div_euclid(self.block).clamp(-1, self.rows) + 1
    }

    pub(crate) fn cell(&self, column: i32, row: i32) -> usize {
        (row * (self.columns + 2) + column) as usize
    }

    pub(crate) fn cell_of(&self, sprite: &Sprite) -> usize {
        self.cell(i32::from(sprite.column), i32::from(sprite.row))
    }

    /// Returns the game's screen in pixels.
    pub(crate) fn screen(&self) -> Rect {
        Rect { x: 0, y: 0, w: self.columns * self.block, h: self.rows * self.block }
    }

    /// Returns the number of cells on the board, including the ring around it.
    pub(crate) fn cell_count(columns: i32, rows: i32) -> usize {
        ((columns + 2) * (rows + 2)) as usize
    }

    /// Locates a rectangle.
    #[inline(always)]
    pub(crate) fn locate(&self, rect: Rect) -> Located {
        let block = self.block;
        let (right, bottom) = (self.columns * block, self.rows * block);
        let fits = |at: i32, size: i32, end: i32| {
            (at as u32) < end as u32 && (size.wrapping_sub(1) as u32) < block as u32
        };
        if !fits(rect.x, rect.w, right) || !fits(rect.y, rect.h, bottom) {
            return self.locate_afar(rect);
        }
        let cell = |at: i32| ((at as u64 * self.reciprocal) >> RECIPROCAL) as i32 + 1;
        let (column, row, end) = (cell(rect.x), cell(rect.y), (rect.x + rect.w, rect.y + rect.h));
        let flags = bit(end.0 > column * block, flag::RIGHT)
            | bit(end.1 > row * block, flag::BELOW)
            | bit(end.0 > right || end.1 > bottom, flag::OFF);
        Located { column: column as i16, row: row as i16, flags }
    }

    /// Locates a sprite recorded at `from` that moves from `old` to `rect`. Moves by a whole cell, the most frequent
    /// case on a grid, are computed faster than by [`World::locate`].
    #[inline(always)]
    pub(crate) fn locate_moved(&self, from: Located, old: Rect, rect: Rect) -> Located {
        let (dx, dy) = (rect.x.wrapping_sub(old.x), rect.y.wrapping_sub(old.y));
        // The sprite lies in the next cell in the same way.
        let is_next = |by: i32, at: i16, cells: i32| {
            let next = i32::from(at) + by.signum();
            by.unsigned_abs() == self.block as u32 && 0 < next && next < cells
        };
        if from.flags & (flag::BIG | flag::OFF) == 0 {
            if dy == 0 && is_next(dx, from.column, self.columns) {
                return Located { column: from.column + dx.signum() as i16, ..from };
            }
            if dx == 0 && is_next(dy, from.row, self.rows) {
                return Located { row: from.row + dy.signum() as i16, ..from };
            }
        }
        self.locate(rect)
    }

    /// Returns the cell in which a sprite is recorded.
    #[inline(always)]
    pub(crate) fn located(&self, slot: Slot) -> Located {
        let &Sprite { column, row, flags, .. } = self.own(slot);
        Located { column, row, flags: flags & flag::PLACEMENT }
    }

    /// Locates a rectangle anywhere, by division.
    #[inline(never)]
    pub(crate) fn locate_afar(&self, rect: Rect) -> Located {
        let (column, row) = (self.column(rect.x), self.row(rect.y));
        let wide = self.column(rect.x.saturating_add(rect.w.saturating_sub(1))) > column;
        let tall = self.row(rect.y.saturating_add(rect.h.saturating_sub(1))) > row;
        let small = rect.w <= self.block && rect.h <= self.block;
        let lies = if small { bit(wide, flag::RIGHT) | bit(tall, flag::BELOW) } else { flag::BIG };
        let flags = lies | bit(!self.screen().contains(rect), flag::OFF);
        Located { column: column as i16, row: row as i16, flags }
    }

    /// Returns the column and row of a rectangle's top-left corner. The ring around the board has column 0
    /// and row 0.
    pub(crate) fn place_of(&self, rect: Rect) -> (i16, i16) {
        (self.column(rect.x) as i16, self.row(rect.y) as i16)
    }
}

fn bit(on: bool, bit: u32) -> u32 {
    if on { bit } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::{RECIPROCAL, reciprocal};
    use crate::limits::{MAX_SIDE, MAX_SQUARE};

    #[test]
    fn products_equal_quotients_at_every_border() {
        for block in 1..MAX_SQUARE + 1 {
            for border in (0..MAX_SIDE as i32 + 1).map(|cell| cell * block) {
                for pixel in [border, border + block - 1] {
                    let quotient = ((pixel as u64 * reciprocal(block)) >> RECIPROCAL) as i32;
                    assert_eq!(quotient, pixel / block, "pixel {pixel}, cells of {block} pixels");
                }
            }
        }
    }
}
