//! The spatial index: each cell of the board, and of a ring around it, has a chain of the sprites whose top-left corner
//! lies in it, except those of types without rules. It is updated as sprites move, so the cost of a query for the sprites
//! that overlap a rectangle depends only on the sprites that are there.

use crate::contacts::{Contacts, TypeMask};
use crate::game::Rules;
use crate::geometry::Rect;
use crate::span::Span;
use crate::state::{NONE, Slot, Sprite, State, flag};

/// The maximum number of cells of a sprite that are stored one by one; a larger sprite counts as being everywhere.
const MAX_COVERED: i32 = 100;

/// The cell of a sprite's top-left corner, and how the sprite lies in it: the flags of [`flag::PLACEMENT`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Located {
    pub(crate) column: i16,
    pub(crate) row: i16,
    pub(crate) flags: u32,
}

impl State {
    /// The column of a pixel, counted with the ring: 0 is left of the board.
    pub(crate) fn column(&self, x: i32) -> i32 {
        x.div_euclid(self.block).clamp(-1, self.columns) + 1
    }

    /// The row of a pixel, counted with the ring.
    pub(crate) fn row(&self, y: i32) -> i32 {
        y.div_euclid(self.block).clamp(-1, self.rows) + 1
    }

    pub(crate) fn cell(&self, column: i32, row: i32) -> usize {
        (row * (self.columns + 2) + column) as usize
    }

    pub(crate) fn cell_of(&self, sprite: &Sprite) -> usize {
        self.cell(i32::from(sprite.column), i32::from(sprite.row))
    }

    /// The game's screen, in pixels.
    pub(crate) fn screen(&self) -> Rect {
        Rect { x: 0, y: 0, w: self.columns * self.block, h: self.rows * self.block }
    }

    /// The number of cells of the board with its ring.
    pub(crate) fn cell_count(columns: i32, rows: i32) -> usize {
        ((columns + 2) * (rows + 2)) as usize
    }

    /// Locates a rectangle; `column` and `row` are a guess. Most moves end in the same cell or next to it, which saves a
    /// division.
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

    /// The place at which a sprite is entered.
    #[inline(always)]
    pub(crate) fn located(&self, slot: Slot) -> Located {
        let &Sprite { column, row, flags, .. } = self.sprite(slot);
        Located { column, row, flags: flags & flag::PLACEMENT }
    }

    /// Locates a rectangle that was `old` before. For a sprite on the board that is no larger than a cell, only the axes
    /// along which it moved are computed.
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

    /// Locates any rectangle.
    #[inline(never)]
    fn locate_afar(&self, rect: Rect) -> Located {
        let (column, row) = (self.column(rect.x), self.row(rect.y));
        let wide = self.column(rect.x.saturating_add(rect.w.saturating_sub(1))) > column;
        let tall = self.row(rect.y.saturating_add(rect.h.saturating_sub(1))) > row;
        let small = rect.w <= self.block && rect.h <= self.block;
        let lies = if small { bit(wide, flag::RIGHT) | bit(tall, flag::BELOW) } else { flag::BIG };
        let flags = lies | bit(!self.screen().contains(rect), flag::OFF);
        Located { column: column as i16, row: row as i16, flags }
    }

    /// Enters a sprite into its cells.
    pub(crate) fn enter_cell(&mut self, rules: &Rules, slot: Slot) {
        let rect = self.sprite(slot).rect;
        let Rect { w, h, .. } = self.screen();
        let to = if (0..w).contains(&rect.x) && (0..h).contains(&rect.y) {
            let place = |at: i32| (at as u32 / self.block as u32 + 1) as i16;
            self.locate(rect, place(rect.x), place(rect.y))
        } else {
            self.locate_afar(rect)
        };
        self.enter_located(rules, slot, to);
    }

    /// Enters a sprite into the cells that its fields name.
    pub(crate) fn enter_cell_again(&mut self, rules: &Rules, slot: Slot) {
        let to = self.located(slot);
        self.enter_located(rules, slot, to);
    }

    fn enter_located(&mut self, rules: &Rules, slot: Slot, to: Located) {
        let cell = self.cell(i32::from(to.column), i32::from(to.row));
        let sprite = &mut self.sprites[usize::from(slot)];
        (sprite.column, sprite.row) = (to.column, to.row);
        sprite.flags = sprite.flags & !flag::PLACEMENT | to.flags;
        let stype = sprite.stype.index();
        if to.flags != 0 {
            self.lie(&rules.contacts, stype, 0, to.flags);
        }
        let kind = &rules.contacts.kinds[stype];
        if kind.own == 0 {
            return;
        }
        self.link(slot, cell);
        self.arrive(&rules.contacts, kind, cell);
        if to.flags & (flag::RIGHT | flag::BELOW) != 0 {
            for cell in self.span(cell, to.flags).cells().skip(1) {
                self.arrive(&rules.contacts, kind, cell);
            }
        }
        if to.flags & flag::BIG != 0 {
            self.cover(kind, slot);
        }
    }

    pub(crate) fn leave_cell(&mut self, rules: &Rules, slot: Slot) {
        let sprite = self.sprite(slot);
        let (cell, stype, flags) = (self.cell_of(sprite), sprite.stype.index(), sprite.flags);
        if flags & flag::PLACEMENT != 0 {
            self.sprites[usize::from(slot)].flags &= !flag::PLACEMENT;
            self.lie(&rules.contacts, stype, flags, 0);
        }
        let kind = &rules.contacts.kinds[stype];
        if kind.own == 0 {
            return;
        }
        self.unlink(slot, cell);
        self.depart(&rules.contacts, kind, cell);
        if flags & (flag::RIGHT | flag::BELOW) != 0 {
            for cell in self.span(cell, flags).cells().skip(1) {
                self.depart(&rules.contacts, kind, cell);
            }
        }
        self.left_behind += u32::from(flags & flag::BIG != 0);
    }

    /// Changes the rectangle of a sprite, which counts as moved in this tick. If sprites may sleep, use
    /// [`State::relocate_noisily`].
    #[inline(always)]
    pub(crate) fn relocate(&mut self, rules: &Rules, slot: Slot, rect: Rect) {
        let (from, to) = self.locate_move(slot, rect);
        self.relocate_as(rules, slot, rect, from, to);
    }

    /// The place at which a sprite is entered, and its place after a move to `rect`.
    #[inline(always)]
    pub(crate) fn locate_move(&self, slot: Slot, rect: Rect) -> (Located, Located) {
        let from = self.located(slot);
        (from, self.locate_moved(from, self.sprite(slot).rect, rect))
    }

    /// [`State::relocate`] for a sprite that has been located already and keeps its size.
    #[inline(always)]
    pub(crate) fn relocate_to(&mut self, rules: &Rules, slot: Slot, rect: Rect, from: Located, to: Located) {
        let sprite = &mut self.sprites[usize::from(slot)];
        let before = sprite.flags;
        sprite.flags |= flag::DIRTY | flag::MOVED;
        sprite.rect = rect;
        if before & flag::MOVED == 0 {
            self.moved.push(slot);
        }
        if before & flag::DIRTY == 0 {
            self.dirty.push(slot);
        }
        self.enter_other(rules, slot, from, to);
    }

    /// [`State::relocate`] for a sprite that has been located already and may change its size.
    fn relocate_as(&mut self, rules: &Rules, slot: Slot, rect: Rect, from: Located, to: Located) {
        let before = self.sprite(slot).rect;
        if (before.w, before.h) == (rect.w, rect.h) {
            return self.relocate_to(rules, slot, rect, from, to);
        }
        let last = self.last(slot);
        self.edit(slot).rect = rect;
        self.set_last(slot, last);
        self.enter_other(rules, slot, from, to);
    }

    /// [`State::relocate`], and marks the watched cells that the sprite leaves or enters, to wake sleeping sprites.
    pub(crate) fn relocate_noisily(
        &mut self,
        rules: &Rules,
        slot: Slot,
        rect: Rect,
        from: Located,
        to: Located,
    ) {
        if self.sleepers.is_empty() {
            return self.relocate_as(rules, slot, rect, from, to);
        }
        self.touch(slot);
        self.relocate_as(rules, slot, rect, from, to);
        self.touch(slot);
    }

    /// Enters a sprite that has moved into its new cells.
    #[inline(always)]
    pub(crate) fn enter_anew(&mut self, rules: &Rules, slot: Slot, rect: Rect) {
        let from = self.located(slot);
        let to = self.locate(rect, from.column, from.row);
        self.enter_other(rules, slot, from, to);
    }

    #[inline(always)]
    fn enter_other(&mut self, rules: &Rules, slot: Slot, from: Located, to: Located) {
        if from != to {
            self.shift(rules, slot, from, to);
        }
        if (from.flags | to.flags) & flag::BIG != 0 {
            self.shift_big(rules, slot, from, to);
        }
    }

    #[inline(always)]
    pub(crate) fn shift(&mut self, rules: &Rules, slot: Slot, from: Located, to: Located) {
        let before = self.cell(i32::from(from.column), i32::from(from.row));
        let after = self.cell(i32::from(to.column), i32::from(to.row));
        let sprite = &mut self.sprites[usize::from(slot)];
        let stype = sprite.stype.index();
        sprite.flags = sprite.flags & !flag::PLACEMENT | to.flags;
        (sprite.column, sprite.row) = (to.column, to.row);
        if from.flags != to.flags {
            self.lie(&rules.contacts, stype, from.flags, to.flags);
        }
        let kind = &rules.contacts.kinds[stype];
        if kind.own == 0 {
            return;
        }
        if before != after {
            self.unlink(slot, before);
            self.link(slot, after);
        }
        let contacts = &rules.contacts;
        if (from.flags | to.flags) & (flag::RIGHT | flag::BELOW) == 0 {
            // From one cell to another, the most frequent case on a grid.
            if before != after {
                self.depart(contacts, kind, before);
                self.arrive(contacts, kind, after);
            }
            return;
        }
        let stride = (self.columns + 2) as usize;
        let changed = from.flags ^ to.flags;
        let (unit, across, reach) = if from.row == to.row && changed & flag::BELOW == 0 {
            (1, if to.flags & flag::BELOW != 0 { stride } else { 0 }, flag::RIGHT)
        } else if from.column == to.column && changed & flag::RIGHT == 0 {
            (stride, usize::from(to.flags & flag::RIGHT != 0), flag::BELOW)
        } else {
            return self.shift_across(contacts, kind, (before, from), (after, to));
        };
        // Along one axis: one or two cells before and after, and as many beside them if the sprite is in two rows or
        // columns.
        let ends = |cell: usize, flags: u32| (cell, if flags & reach != 0 { cell + unit } else { cell });
        let (old, new) = (ends(before, from.flags), ends(after, to.flags));
        if old.0 != new.0 && old.0 != new.1 {
            self.depart_beside(contacts, kind, old.0, across);
        }
        if old.1 != old.0 && old.1 != new.0 && old.1 != new.1 {
            self.depart_beside(contacts, kind, old.1, across);
        }
        if new.0 != old.0 && new.0 != old.1 {
            self.arrive_beside(contacts, kind, new.0, across);
        }
        if new.1 != new.0 && new.1 != old.0 && new.1 != old.1 {
            self.arrive_beside(contacts, kind, new.1, across);
        }
    }

    /// Departs from a cell, and from the cell `across` further on if `across` is not 0.
    #[inline(always)]
    pub(crate) fn depart_beside(&mut self, contacts: &Contacts, kind: &TypeMask, cell: usize, across: usize) {
        self.depart(contacts, kind, cell);
        if across != 0 {
            self.depart(contacts, kind, cell + across);
        }
    }

    #[inline(always)]
    pub(crate) fn arrive_beside(&mut self, contacts: &Contacts, kind: &TypeMask, cell: usize, across: usize) {
        self.arrive(contacts, kind, cell);
        if across != 0 {
            self.arrive(contacts, kind, cell + across);
        }
    }

    /// The rest of [`State::shift`], for moves along both axes.
    #[inline(never)]
    fn shift_across(
        &mut self,
        contacts: &Contacts,
        kind: &TypeMask,
        (before, from): (usize, Located),
        (after, to): (usize, Located),
    ) {
        let (gone, new) = self.span(before, from.flags).apart(
            self.span(after, to.flags),
            i32::from(to.column) - i32::from(from.column),
            i32::from(to.row) - i32::from(from.row),
        );
        for cell in gone.cells() {
            self.depart(contacts, kind, cell);
        }
        for cell in new.cells() {
            self.arrive(contacts, kind, cell);
        }
    }

    /// Notes the new cells of a large sprite.
    #[inline(never)]
    fn shift_big(&mut self, rules: &Rules, slot: Slot, from: Located, to: Located) {
        self.left_behind += u32::from(from.flags & flag::BIG != 0);
        let kind = &rules.contacts.kinds[self.sprite(slot).stype.index()];
        if to.flags & flag::BIG != 0 && kind.own != 0 {
            self.cover(kind, slot);
        }
    }

    #[inline(always)]
    pub(crate) fn link(&mut self, slot: Slot, cell: usize) {
        let sprites = &mut self.sprites[..];
        let head = std::mem::replace(&mut self.cells[cell], slot);
        if head != NONE {
            sprites[usize::from(head)].cell_previous = slot;
        }
        let sprite = &mut sprites[usize::from(slot)];
        (sprite.cell_next, sprite.cell_previous) = (head, NONE);
    }

    #[inline(always)]
    pub(crate) fn unlink(&mut self, slot: Slot, cell: usize) {
        let sprites = &mut self.sprites[..];
        let Sprite { cell_next, cell_previous, .. } = sprites[usize::from(slot)];
        match cell_previous {
            NONE => self.cells[cell] = cell_next,
            previous => sprites[usize::from(previous)].cell_next = cell_next,
        }
        if cell_next != NONE {
            sprites[usize::from(cell_next)].cell_previous = cell_previous;
        }
    }

    /// Updates the counts of how the sprites of a type lie.
    #[inline]
    fn lie(&mut self, contacts: &Contacts, stype: usize, from: u32, to: u32) {
        if (from ^ to) & flag::OFF != 0 {
            let group = &mut self.groups[stype];
            if to & flag::OFF != 0 {
                (group.off, self.off) = (group.off + 1, self.off + 1);
            } else {
                (group.off, self.off) = (group.off - 1, self.off - 1);
            }
        }
        let group = &mut self.groups[stype];
        match (from & flag::MULTI_CELL != 0, to & flag::MULTI_CELL != 0) {
            (false, true) => {
                group.multi_cell += 1;
                if group.multi_cell == 1 {
                    self.multi_cell_bits |= contacts.kinds[stype].own;
                }
            }
            (true, false) => {
                group.multi_cell -= 1;
                if group.multi_cell == 0 {
                    self.multi_cell_bits &= !contacts.sole_bit(stype);
                }
            }
            _ => {}
        }
        let group = &mut self.groups[stype];
        match (from & flag::BIG != 0, to & flag::BIG != 0) {
            (false, true) => {
                group.big += 1;
                self.big += 1;
                if group.big == 1 {
                    self.big_bits |= contacts.kinds[stype].own;
                    self.enlarged(contacts, stype);
                }
            }
            (true, false) => {
                group.big -= 1;
                self.big -= 1;
                if group.big == 0 {
                    self.big_bits &= !contacts.sole_bit(stype);
                    self.reduced(contacts, stype);
                }
            }
            _ => {}
        }
    }

    /// The cells that a sprite with these flags covers; for a large sprite only the cell of its corner.
    #[inline(always)]
    pub(crate) fn span(&self, cell: usize, flags: u32) -> Span {
        let stride = (self.columns + 2) as usize;
        Span::new(cell, stride, flags & flag::RIGHT != 0, flags & flag::BELOW != 0)
    }

    /// Calls `visit` with the cells that a sprite covers. Returns `false`, without calls, if these are more than
    /// [`MAX_COVERED`].
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

    /// The column and row of a rectangle's top-left corner, counted with the ring.
    pub(crate) fn place_of(&self, rect: Rect) -> (i16, i16) {
        (self.column(rect.x) as i16, self.row(rect.y) as i16)
    }
}

fn bit(on: bool, bit: u32) -> u32 {
    if on { bit } else { 0 }
}

/// Along one axis, the cell of a pixel on the board, counted with the ring, if it is `guess` or next to it; and `true` if
/// a sprite that starts there, and is no larger than a cell, reaches into the next cell.
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
