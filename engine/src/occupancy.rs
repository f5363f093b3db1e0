//! Who is where: each cell of the board, and of a ring around it, has a chain of the sprites whose top-left corner lies
//! in it. Kept as sprites move, so asking who overlaps a rectangle costs what stands there.

use crate::game::{Rules, TypeInfo};
use crate::geometry::Rect;
use crate::state::{NONE, Slot, Sprite, State, flag};
use smallvec::SmallVec;

/// One side of a pass: the types of a tree, and their bits.
#[derive(Clone, Copy)]
pub(crate) struct Side<'a> {
    pub(crate) family: &'a TypeInfo,
    pub(crate) bits: u64,
}

/// Cells of a sprite that are looked at one by one; what is larger counts as everywhere.
const MAX_COVERED: i32 = 100;

/// The cell of a sprite's top-left corner, and how the sprite lies in it: the flags of [`flag::LYING`].
struct Located {
    column: i16,
    row: i16,
    flags: u32,
}

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

    pub(crate) fn cell(&self, column: i32, row: i32) -> usize {
        (row * (self.columns + 2) + column) as usize
    }

    fn cell_of(&self, sprite: &Sprite) -> usize {
        self.cell(i32::from(sprite.column), i32::from(sprite.row))
    }

    /// The game's screen, in pixels.
    pub(crate) fn screen(&self) -> Rect {
        Rect { x: 0, y: 0, w: self.columns * self.block, h: self.rows * self.block }
    }

    /// How many cells the board has with its ring.
    pub(crate) fn cell_count(columns: i32, rows: i32) -> usize {
        ((columns + 2) * (rows + 2)) as usize
    }

    /// Where a rectangle is; `column` and `row` are a guess. Most moves end in the same cell or next to it, which saves a
    /// division.
    fn locate(&self, rect: Rect, column: i16, row: i16) -> Located {
        let block = self.block;
        let (column, right) = near(rect.x, i32::from(column), block, self.columns);
        let (row, below) = near(rect.y, i32::from(row), block, self.rows);
        let small = rect.w <= block && rect.h <= block;
        let loose = right != 0 || below != 0 || !small;
        let inside = column >= 1 && column <= self.columns && row >= 1 && row <= self.rows;
        let flags = if inside && !loose {
            if rect.w > 0 && rect.h > 0 { 0 } else { flag::OFF }
        } else if inside && small && rect.w > 0 && rect.h > 0 {
            let (wide, tall) = (right + rect.w > block, below + rect.h > block);
            let off = wide && column == self.columns || tall && row == self.rows;
            flag::LOOSE
                | if wide { flag::RIGHT } else { 0 }
                | if tall { flag::BELOW } else { 0 }
                | if off { flag::OFF } else { 0 }
        } else {
            // Beyond the ring nothing is exact.
            let off = if self.screen().contains(rect) { 0 } else { flag::OFF };
            off | if loose { flag::LOOSE | flag::BIG } else { 0 }
        };
        Located { column: column as i16, row: row as i16, flags }
    }

    /// Puts a sprite into the chain of its cell.
    pub(crate) fn enter_cell(&mut self, rules: &Rules, slot: Slot) {
        let Sprite { rect, column, row, .. } = *self.sprite(slot);
        let located = self.locate(rect, column, row);
        self.enter(rules, slot, located);
    }

    fn enter(&mut self, rules: &Rules, slot: Slot, to: Located) {
        let cell = self.cell(i32::from(to.column), i32::from(to.row));
        let head = std::mem::replace(&mut self.cells[cell], slot);
        if head != NONE {
            self.sprites[usize::from(head)].cell_previous = slot;
        }
        let sprite = &mut self.sprites[usize::from(slot)];
        (sprite.column, sprite.row) = (to.column, to.row);
        (sprite.cell_next, sprite.cell_previous) = (head, NONE);
        let stype = sprite.stype.index();
        self.lie(rules, slot, to.flags);
        self.join(&rules.contacts, stype, cell);
    }

    /// Sets how a sprite lies in its cell.
    fn lie(&mut self, rules: &Rules, slot: Slot, flags: u32) {
        let sprite = &mut self.sprites[usize::from(slot)];
        let old = sprite.flags;
        sprite.flags = old & !flag::LYING | flags;
        let stype = sprite.stype.index();
        if (old ^ flags) & (flag::OFF | flag::LOOSE) != 0 {
            let group = &mut self.groups[stype];
            group.off = group.off + u16::from(flags & flag::OFF != 0) - u16::from(old & flag::OFF != 0);
            match (old & flag::LOOSE != 0, flags & flag::LOOSE != 0) {
                (false, true) => {
                    group.loose += 1;
                    self.loose += 1;
                    if group.loose == 1 {
                        self.loosened(&rules.contacts, stype);
                    }
                }
                (true, false) => {
                    group.loose -= 1;
                    self.loose -= 1;
                    if group.loose == 0 {
                        self.aligned(&rules.contacts, stype);
                    }
                }
                _ => {}
            }
        }
        if self.meeting && flags & flag::LOOSE != 0 {
            self.cover_cells(&rules.contacts, slot);
        }
    }

    pub(crate) fn leave_cell(&mut self, rules: &Rules, slot: Slot) {
        self.lie(rules, slot, 0);
        self.leave(rules, slot);
    }

    fn leave(&mut self, rules: &Rules, slot: Slot) {
        let sprite = *self.sprite(slot);
        let Sprite { stype, cell_next, cell_previous, .. } = sprite;
        let cell = self.cell_of(&sprite);
        match cell_previous {
            NONE => self.cells[cell] = cell_next,
            previous => self.sprites[usize::from(previous)].cell_next = cell_next,
        }
        if cell_next != NONE {
            self.sprites[usize::from(cell_next)].cell_previous = cell_previous;
        }
        self.part(&rules.contacts, stype.index(), cell);
    }

    /// Changes the rectangle of a sprite.
    pub(crate) fn relocate(&mut self, rules: &Rules, slot: Slot, rect: Rect) {
        if !self.rests.is_empty() {
            self.touch(slot);
        }
        let sprite = self.edit(slot);
        sprite.rect = rect;
        let (column, row) = (sprite.column, sprite.row);
        let to = self.locate(rect, column, row);
        if (to.column, to.row) == (column, row) {
            self.lie(rules, slot, to.flags);
        } else {
            self.leave(rules, slot);
            self.enter(rules, slot, to);
        }
        if !self.rests.is_empty() {
            self.touch(slot);
        }
    }

    /// Calls `visit` with the cells that a sprite covers; false, and no call, if these are more than [`MAX_COVERED`].
    pub(crate) fn covered_by(&self, sprite: &Sprite, mut visit: impl FnMut(usize)) -> bool {
        let stride = (self.columns + 2) as usize;
        let cell = self.cell_of(sprite);
        if !sprite.is(flag::BIG) {
            visit(cell);
            if sprite.is(flag::RIGHT) {
                visit(cell + 1);
            }
            if sprite.is(flag::BELOW) {
                visit(cell + stride);
                if sprite.is(flag::RIGHT) {
                    visit(cell + stride + 1);
                }
            }
            return true;
        }
        let (rect, column, row) = (sprite.rect, i32::from(sprite.column), i32::from(sprite.row));
        let right = self.column(rect.x.saturating_add(rect.w.saturating_sub(1))).max(column);
        let below = self.row(rect.y.saturating_add(rect.h.saturating_sub(1))).max(row);
        if (right - column + 1) * (below - row + 1) > MAX_COVERED {
            return false;
        }
        for row in row..below + 1 {
            for column in column..right + 1 {
                visit(self.cell(column, row));
            }
        }
        true
    }

    /// Column and row of a rectangle's top-left corner, counted with the ring.
    pub(crate) fn place_of(&self, rect: Rect) -> (i16, i16) {
        (self.column(rect.x) as i16, self.row(rect.y) as i16)
    }

    /// Calls `visit` with every sprite that may overlap a rectangle.
    pub(crate) fn near_rect(&self, rules: &Rules, rect: Rect, mut visit: impl FnMut(Slot)) {
        let reach = rules.reach.saturating_mul(self.block) - 1;
        let left = self.column(rect.x.saturating_sub(reach));
        let right = self.column(rect.x.saturating_add(rect.w - 1));
        let top = self.row(rect.y.saturating_sub(reach));
        let bottom = self.row(rect.y.saturating_add(rect.h - 1));
        for row in top..bottom + 1 {
            for column in left..right + 1 {
                let mut at = self.cells[self.cell(column, row)];
                while at != NONE {
                    visit(at);
                    at = self.sprite(at).cell_next;
                }
            }
        }
    }

    /// Collects the sprites of a side that overlap a sprite, itself left out, in no particular order. `above`
    /// excludes sprites created since that id was next.
    pub(crate) fn overlapping(&self, rules: &Rules, side: Side<'_>, slot: Slot, above: u32, hits: &mut Hits) {
        let sprite = self.sprite(slot);
        if !sprite.is(flag::LOOSE) {
            let cell = self.cell_of(sprite);
            // Sprites that are not aligned to one cell may reach over from the cells left and above.
            if (self.covered[cell] | self.vast) & side.bits == 0 {
                return self.overlapping_in(cell, side, (slot, sprite.rect), above, hits);
            }
        } else {
            let (mut masks, mut covered) = (0, self.vast);
            let few = self.covered_by(sprite, |cell| {
                masks |= self.masks[cell];
                covered |= self.covered[cell];
            });
            if few && (masks | covered) & side.bits == 0 {
                return;
            }
            if few && covered & side.bits == 0 {
                let target = (slot, sprite.rect);
                self.covered_by(sprite, |cell| self.overlapping_in(cell, side, target, above, hits));
                return;
            }
        }
        self.overlapping_rect(rules, side, (slot, sprite.rect), above, hits);
    }

    /// The sprites of a side that overlap a rectangle around a sprite, itself left out.
    pub(crate) fn overlapping_rect(
        &self,
        rules: &Rules,
        side: Side<'_>,
        (slot, rect): (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) {
        let reach = rules.reach.saturating_mul(self.block) - 1;
        let first_column = self.column(rect.x.saturating_sub(reach));
        let last_column = self.column(rect.x.saturating_add(rect.w.saturating_sub(1)));
        let first_row = self.row(rect.y.saturating_sub(reach));
        let last_row = self.row(rect.y.saturating_add(rect.h.saturating_sub(1)));
        let cells = (last_column - first_column + 1) * (last_row - first_row + 1);
        let family = side.family;
        let sprites = family.tree.iter().map(|&stype| i32::from(self.group(stype).count)).sum::<i32>();
        if cells > sprites {
            // All sprites are fewer than all cells from which they can reach into the rectangle.
            let types = family.tree.iter().enumerate();
            let types = types.filter(|(at, stype)| usize::from(family.rank[stype.index()]) == *at);
            let all = types.flat_map(|(_, &stype)| self.slots(stype));
            let overlaps = |at: &Slot| {
                let sprite = self.sprite(*at);
                *at != slot && sprite.id < above && sprite.rect.intersects(rect)
            };
            hits.extend(all.filter(overlaps));
            return;
        }
        for row in first_row..last_row + 1 {
            for column in first_column..last_column + 1 {
                self.overlapping_in(self.cell(column, row), side, (slot, rect), above, hits);
            }
        }
    }

    fn overlapping_in(
        &self,
        cell: usize,
        side: Side<'_>,
        (slot, rect): (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) {
        if self.masks[cell] & side.bits == 0 {
            return;
        }
        let mut at = self.cells[cell];
        while at != NONE {
            let sprite = self.sprite(at);
            if side.family.in_tree(sprite.stype)
                && at != slot
                && sprite.id < above
                && sprite.rect.intersects(rect)
            {
                hits.push(at);
            }
            at = sprite.cell_next;
        }
    }
}

/// The cell of a pixel along one axis, counted with the ring, and the pixel's distance from the cell's start (0 only if
/// it is aligned and on the board); `guess` is a cell close by.
fn near(pixel: i32, guess: i32, block: i32, cells: i32) -> (i32, i32) {
    // Counted without the ring.
    let start = (guess - 1).wrapping_mul(block);
    let rest = pixel.wrapping_sub(start);
    let within = |rest: i32| (rest as u32) < block as u32;
    let (cell, rest) = if within(rest) {
        (guess - 1, rest)
    } else if within(rest.wrapping_sub(block)) {
        (guess, rest.wrapping_sub(block))
    } else if within(rest.wrapping_add(block)) {
        (guess - 2, rest.wrapping_add(block))
    } else {
        (pixel.div_euclid(block), pixel.rem_euclid(block))
    };
    if cell >= -1 && cell <= cells { (cell + 1, rest) } else { (cell.clamp(-1, cells) + 1, 1) }
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
