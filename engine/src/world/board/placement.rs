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

    /// Locates a rectangle. `column` and `row` are a guess that usually saves a division, because most moves
    /// end in the same cell or a neighbouring cell.
    #[inline(always)]
    pub(crate) fn locate(&self, rect: Rect, column: i16, row: i16) -> Located {
        let block = self.block;
        let sized = rect.w > 0 && rect.h > 0 && rect.w <= block && rect.h <= block;
        if sized
            && let Some((column, wide)) = near(rect.x, rect.w, column, block, self.columns)
            && let Some((row, tall)) = near(rect.y, rect.h, row, block, self.rows)
        {
            let off = wide && i32::from(column) == self.columns || tall && i32::from(row) == self.rows;
            let flags = bit(wide, flag::RIGHT) | bit(tall, flag::BELOW) | bit(off, flag::OFF);
            return Located { column, row, flags };
        }
        self.locate_afar(rect)
    }

    /// Returns the cell in which a sprite is recorded.
    #[inline(always)]
    pub(crate) fn located(&self, slot: Slot) -> Located {
        let &Sprite { column, row, flags, .. } = self.own(slot);
        Located { column, row, flags: flags & flag::PLACEMENT }
    }

    /// Locates a rectangle that was previously `old`. For a sprite on the board that is no larger than a
    /// cell, only the axes along which it moved are computed.
    #[inline(always)]
    fn locate_moved(&self, from: Located, old: Rect, rect: Rect) -> Located {
        if from.flags & (flag::BIG | flag::OFF) != 0 || (old.w, old.h) != (rect.w, rect.h) {
            return self.locate(rect, from.column, from.row);
        }
        let mut to = from;
        let (dx, dy) = (rect.x.wrapping_sub(old.x), rect.y.wrapping_sub(old.y));
        // After a move by a whole cell, the most frequent case on a grid, the sprite lies in its cell as before.
        let is_next = |by: i32, at: i16, cells: i32| {
            let next = i32::from(at) + by.signum();
            by.unsigned_abs() == self.block as u32 && 0 < next && next < cells
        };
        if dy == 0 && is_next(dx, from.column, self.columns) {
            return Located { column: from.column + dx.signum() as i16, ..from };
        }
        if dx == 0 && is_next(dy, from.row, self.rows) {
            return Located { row: from.row + dy.signum() as i16, ..from };
        }
        if dx != 0 {
            let Some((column, wide)) = near(rect.x, rect.w, from.column, self.block, self.columns) else {
                return self.locate_afar(rect);
            };
            to.column = column;
            to.flags = to.flags & !flag::RIGHT
                | bit(wide, flag::RIGHT)
                | bit(wide && i32::from(column) == self.columns, flag::OFF);
        }
        if dy != 0 {
            let Some((row, tall)) = near(rect.y, rect.h, from.row, self.block, self.rows) else {
                return self.locate_afar(rect);
            };
            to.row = row;
            to.flags = to.flags & !flag::BELOW
                | bit(tall, flag::BELOW)
                | bit(tall && i32::from(row) == self.rows, flag::OFF);
        }
        to
    }

    /// Locates any rectangle, without a guess.
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

    /// Returns the cell in which a sprite is recorded, and its cell after a move to `rect`.
    #[inline(always)]
    pub(crate) fn locate_move(&self, slot: Slot, rect: Rect) -> (Located, Located) {
        let from = self.located(slot);
        (from, self.locate_moved(from, self.own(slot).rect, rect))
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

/// Returns the column or row of a pixel, where the ring around the board is 0. The flag is `true` if a sprite
/// that starts at the pixel, and is no larger than a cell, reaches into the next cell. Returns `None` if the
/// pixel is off the board, or if its cell is neither `guess` nor next to `guess`.
#[inline(always)]
fn near(pixel: i32, size: i32, guess: i16, block: i32, cells: i32) -> Option<(i16, bool)> {
    let mut cell = i32::from(guess) - 1;
    let mut offset = pixel.wrapping_sub(cell.wrapping_mul(block));
    if offset as u32 >= block as u32 {
        if offset >= block {
            (cell, offset) = (cell + 1, offset - block);
        } else {
            (cell, offset) = (cell - 1, offset + block);
        }
        if offset as u32 >= block as u32 {
            return None;
        }
    }
    (0..cells).contains(&cell).then_some(((cell + 1) as i16, offset + size > block))
}

#[cfg(test)]
mod tests {
    use super::near;

    #[test]
    fn a_guess_never_changes_the_answer() {
        for pixel in
            [i32::MIN, -1000, -21, -20, -11, -10, -1, 0, 1, 4, 9, 10, 19, 49, 50, 59, 60, 1000, i32::MAX]
        {
            for guess in 0..=6 {
                let (cell, offset) = (pixel.div_euclid(10), pixel.rem_euclid(10));
                let close = (0..5).contains(&cell) && (cell + 1).abs_diff(i32::from(guess)) <= 1;
                let expected = close.then_some(((cell + 1) as i16, offset + 6 > 10));
                assert_eq!(near(pixel, 6, guess, 10, 5), expected, "pixel {pixel}, guess {guess}");
            }
        }
    }
}
