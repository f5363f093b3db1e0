//! Who is where: each cell of the board, and of a ring around it, has a chain of the sprites whose top-left corner lies
//! in it. Kept as sprites move, so asking who overlaps a rectangle costs what stands there.

use crate::game::{Rules, TypeInfo};
use crate::geometry::Rect;
use crate::state::{NONE, Slot, Sprite, State, flag};
use smallvec::SmallVec;

/// The slots that overlap a sprite; seldom more than a few.
pub(crate) type Hits = SmallVec<[Slot; 8]>;

impl State {
    /// Column of a pixel, counted with the ring: 0 is left of the board.
    fn column(&self, x: i32) -> i32 {
        x.div_euclid(self.block).clamp(-1, self.columns) + 1
    }

    fn row(&self, y: i32) -> i32 {
        y.div_euclid(self.block).clamp(-1, self.rows) + 1
    }

    fn cell(&self, column: i32, row: i32) -> usize {
        (row * (self.columns + 2) + column) as usize
    }

    /// How many cells the board has with its ring.
    pub(crate) fn cell_count(columns: i32, rows: i32) -> usize {
        ((columns + 2) * (rows + 2)) as usize
    }

    /// Puts a sprite into the chain of its cell. `column` and `row` of the sprite are where it was last: most moves end
    /// there or next to it, which saves a division.
    pub(crate) fn enter_cell(&mut self, slot: Slot) {
        let Sprite { rect, column, row, .. } = *self.sprite(slot);
        let (column, right) = near(rect.x, i32::from(column), self.block, self.columns);
        let (row, below) = near(rect.y, i32::from(row), self.block, self.rows);
        let cell = self.cell(column, row);
        let head = std::mem::replace(&mut self.cells[cell], slot);
        if head != NONE {
            self.sprites[usize::from(head)].cell_previous = slot;
        }
        let loose = right != 0 || below != 0 || rect.w > self.block || rect.h > self.block;
        let sprite = &mut self.sprites[usize::from(slot)];
        (sprite.column, sprite.row) = (column as i16, row as i16);
        (sprite.cell_next, sprite.cell_previous) = (head, NONE);
        sprite.set(flag::LOOSE, loose);
        self.groups[sprite.stype.index()].loose += u16::from(loose);
    }

    pub(crate) fn leave_cell(&mut self, slot: Slot) {
        let Sprite { stype, column, row, cell_next, cell_previous, flags, .. } = *self.sprite(slot);
        match cell_previous {
            NONE => {
                let cell = self.cell(i32::from(column), i32::from(row));
                self.cells[cell] = cell_next;
            }
            previous => self.sprites[usize::from(previous)].cell_next = cell_next,
        }
        if cell_next != NONE {
            self.sprites[usize::from(cell_next)].cell_previous = cell_previous;
        }
        self.groups[stype.index()].loose -= u16::from(flags & flag::LOOSE != 0);
    }

    /// Collects the sprites of `family`'s tree that overlap a sprite, itself left out, in no particular order. `above`
    /// excludes sprites created since that id was next. Returns how many cells and sprites it looked at.
    pub(crate) fn overlapping(
        &self,
        rules: &Rules,
        family: &TypeInfo,
        slot: Slot,
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let Sprite { rect, column, row, flags, .. } = *self.sprite(slot);
        let (column, row) = (i32::from(column), i32::from(row));
        // Sprites that are not aligned to one cell may reach over from the cells left and above.
        let reached = family.tree.iter().any(|&stype| self.group(stype).loose > 0);
        if flags & flag::LOOSE == 0 && !reached {
            return self.overlapping_in(self.cell(column, row), family, (slot, rect), above, hits);
        }
        let reach = if reached { rules.reach.saturating_mul(self.block) - 1 } else { 0 };
        self.overlapping_around(family, (slot, rect), reach, above, hits)
    }

    /// The sprites of `family`'s tree that overlap a rectangle around a sprite, itself left out.
    pub(crate) fn overlapping_rect(
        &self,
        rules: &Rules,
        family: &TypeInfo,
        (slot, rect): (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let reach = rules.reach.saturating_mul(self.block) - 1;
        self.overlapping_around(family, (slot, rect), reach, above, hits)
    }

    /// Looks into all cells from which sprites can reach into the rectangle, or, if these are more than there are
    /// sprites, at all sprites. Returns at how many.
    fn overlapping_around(
        &self,
        family: &TypeInfo,
        (slot, rect): (Slot, Rect),
        reach: i32,
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let first_column = self.column(rect.x.saturating_sub(reach));
        let last_column = self.column(rect.x.saturating_add(rect.w.saturating_sub(1)));
        let first_row = self.row(rect.y.saturating_sub(reach));
        let last_row = self.row(rect.y.saturating_add(rect.h.saturating_sub(1)));
        let cells = (last_column - first_column + 1) * (last_row - first_row + 1);
        let sprites = family.tree.iter().map(|&stype| i32::from(self.group(stype).count)).sum::<i32>();
        if cells > sprites {
            let types = family.tree.iter().enumerate();
            let types = types.filter(|(at, stype)| usize::from(family.rank[stype.index()]) == *at);
            let all = types.flat_map(|(_, &stype)| self.slots(stype));
            let overlaps = |at: &Slot| {
                let sprite = self.sprite(*at);
                *at != slot && sprite.id < above && sprite.rect.intersects(rect)
            };
            hits.extend(all.filter(overlaps));
            return family.tree.len() + sprites as usize;
        }
        let mut looked = 0;
        for row in first_row..=last_row {
            for column in first_column..=last_column {
                looked += self.overlapping_in(self.cell(column, row), family, (slot, rect), above, hits);
            }
        }
        looked
    }

    fn overlapping_in(
        &self,
        cell: usize,
        family: &TypeInfo,
        (slot, rect): (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let mut at = self.cells[cell];
        let mut looked = 1;
        while at != NONE {
            looked += 1;
            let sprite = self.sprite(at);
            if family.in_tree(sprite.stype) && at != slot && sprite.id < above && sprite.rect.intersects(rect)
            {
                hits.push(at);
            }
            at = sprite.cell_next;
        }
        looked
    }
}

/// The cell of a pixel along one axis, counted with the ring, and the pixel's distance from the cell's start (0 only if
/// it is aligned and on the board); `guess` is a cell close by.
fn near(pixel: i32, guess: i32, block: i32, cells: i32) -> (i32, i32) {
    let mut cell = guess - 1;
    let mut rest = pixel.wrapping_sub(cell.wrapping_mul(block));
    if rest < 0 {
        cell -= 1;
        rest += block;
    } else if rest >= block {
        cell += 1;
        rest -= block;
    }
    if !(0..block).contains(&rest) {
        cell = pixel.div_euclid(block);
        rest = pixel.rem_euclid(block);
    }
    if (-1..=cells).contains(&cell) { (cell + 1, rest) } else { (cell.clamp(-1, cells) + 1, 1) }
}

#[cfg(test)]
mod tests {
    use super::near;

    #[test]
    fn a_guess_never_changes_the_answer() {
        for pixel in
            [i32::MIN, -1000, -21, -20, -11, -10, -1, 0, 1, 9, 10, 19, 49, 50, 59, 60, 1000, i32::MAX]
        {
            for guess in 0..=6 {
                let (cell, rest) = near(pixel, guess, 10, 5);
                let expected = pixel.div_euclid(10);
                assert_eq!(cell, expected.clamp(-1, 5) + 1, "pixel {pixel}, guess {guess}");
                if (-1..=5).contains(&expected) {
                    assert_eq!(rest, pixel.rem_euclid(10), "pixel {pixel}, guess {guess}");
                }
            }
        }
    }
}
