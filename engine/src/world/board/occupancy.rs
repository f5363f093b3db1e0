//! The spatial index. Each cell of the board, and of the ring around it, has a chain of the sprites whose
//! top-left corner is in the cell. Sprites of types without rules are omitted. The index is updated as
//! sprites move, so the cost of finding the sprites that overlap a rectangle depends only on the number of
//! nearby sprites.

use super::placement::Located;
use super::span::Span;
use crate::numbers::geometry::Rect;
use crate::rules::SpriteType;
use crate::world::{Models, NONE, Slot, Sprite, TypeBits, Watcher, World, flag};

/// The maximum number of cells to store individually for a sprite. A sprite that covers more cells counts as
/// being everywhere.
const MAX_COVERED: i32 = 100;

impl World {
    /// Records a sprite in its cells.
    pub(crate) fn enter_cell(&mut self, models: &Models, slot: Slot, watcher: &mut impl Watcher) {
        let to = self.locate(self.own(slot).rect);
        self.enter_located(models, slot, to, watcher);
    }

    /// Records all sprites again from scratch, and notifies the watcher of each. Cost: O(sprites + cells).
    pub(crate) fn reoccupy(&mut self, models: &Models, watcher: &mut impl Watcher) {
        self.cells.fill(NONE);
        self.masks.fill(0);
        self.crowds.clear();
        self.covered.fill(0);
        for group in &mut self.groups {
            (group.multi_cell, group.big, group.off) = (0, 0, 0);
        }
        (self.big, self.off, self.multi_cell_bits) = (0, 0, 0);
        (self.big_bits, self.vast, self.left_behind) = (0, 0, 0);
        self.reenter_fixtures(models, watcher);
        for stype in (0..self.groups.len() as u16).map(SpriteType) {
            let mut slot = self.group(stype).head;
            while usize::from(slot) < self.sprites.len() {
                match self.sprite(slot).flies() {
                    true => self.enter_cell_again(models, slot, watcher),
                    false => self.enter_cell(models, slot, watcher),
                }
                slot = self.sprite(slot).next;
            }
        }
    }

    /// Records a sprite in the cells given by its fields.
    fn enter_cell_again(&mut self, models: &Models, slot: Slot, watcher: &mut impl Watcher) {
        let to = self.located(slot);
        self.enter_located(models, slot, to, watcher);
    }

    fn enter_located(&mut self, models: &Models, slot: Slot, to: Located, watcher: &mut impl Watcher) {
        let cell = self.cell(i32::from(to.column), i32::from(to.row));
        let sprite = &mut self.sprites[usize::from(slot)];
        (sprite.column, sprite.row) = (to.column, to.row);
        sprite.flags = sprite.flags & !flag::PLACEMENT | to.flags;
        let stype = sprite.stype;
        if to.flags != 0 {
            self.lie(models, stype, 0, to.flags, watcher);
        }
        let bits = models.bits[stype.index()];
        if bits.own == 0 {
            return;
        }
        self.link(slot, cell);
        self.arrive(bits, cell, watcher);
        if to.flags & (flag::RIGHT | flag::BELOW) != 0 {
            for cell in self.span(cell, to.flags).cells().skip(1) {
                self.arrive(bits, cell, watcher);
            }
        }
        if to.flags & flag::BIG != 0 {
            self.cover(bits.own, slot);
        }
    }

    pub(crate) fn leave_cell(&mut self, models: &Models, slot: Slot, watcher: &mut impl Watcher) {
        let sprite = self.own(slot);
        let (cell, stype, flags) = (self.cell_of(sprite), sprite.stype, sprite.flags);
        if flags & flag::PLACEMENT != 0 {
            self.sprites[usize::from(slot)].flags &= !flag::PLACEMENT;
            self.lie(models, stype, flags, 0, watcher);
        }
        let bits = models.bits[stype.index()];
        if bits.own == 0 {
            return;
        }
        self.unlink(slot, cell);
        self.depart(models, bits, cell, watcher);
        if flags & (flag::RIGHT | flag::BELOW) != 0 {
            for cell in self.span(cell, flags).cells().skip(1) {
                self.depart(models, bits, cell, watcher);
            }
        }
        self.left_behind += u32::from(flags & flag::BIG != 0);
    }

    /// Changes a sprite's rectangle, and records the sprite in its new cells. The sprite then counts as moved
    /// in this tick.
    #[inline(always)]
    pub(crate) fn relocate(&mut self, models: &Models, slot: Slot, rect: Rect, watcher: &mut impl Watcher) {
        let (from, old) = (self.located(slot), self.own(slot).rect);
        if (old.w, old.h) != (rect.w, rect.h) {
            self.resize(slot, rect);
            return self.enter_anew(models, slot, rect, watcher);
        }
        let to = self.locate_moved(from, old, rect);
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
        self.enter_other(models, slot, from, to, watcher);
    }

    #[inline(never)]
    fn resize(&mut self, slot: Slot, rect: Rect) {
        let last = self.last(slot);
        self.edit(slot).rect = rect;
        self.set_last(slot, last);
    }

    /// Records a moved sprite in its new cells.
    #[inline(always)]
    pub(crate) fn enter_anew(&mut self, models: &Models, slot: Slot, rect: Rect, watcher: &mut impl Watcher) {
        let (from, to) = (self.located(slot), self.locate(rect));
        self.enter_other(models, slot, from, to, watcher);
    }

    #[inline(always)]
    fn enter_other(
        &mut self,
        models: &Models,
        slot: Slot,
        from: Located,
        to: Located,
        watcher: &mut impl Watcher,
    ) {
        if from != to {
            self.shift(models, slot, from, to, watcher);
        }
        if (from.flags | to.flags) & flag::BIG != 0 {
            self.shift_big(models, slot, from, to);
        }
    }

    #[inline(always)]
    fn shift(&mut self, models: &Models, slot: Slot, from: Located, to: Located, watcher: &mut impl Watcher) {
        let before = self.cell(i32::from(from.column), i32::from(from.row));
        let after = self.cell(i32::from(to.column), i32::from(to.row));
        let sprite = &mut self.sprites[usize::from(slot)];
        let stype = sprite.stype;
        sprite.flags = sprite.flags & !flag::PLACEMENT | to.flags;
        (sprite.column, sprite.row) = (to.column, to.row);
        if from.flags != to.flags {
            self.lie(models, stype, from.flags, to.flags, watcher);
        }
        let bits = models.bits[stype.index()];
        if bits.own == 0 {
            return;
        }
        if before != after {
            self.unlink(slot, before);
            self.link(slot, after);
        }
        if (from.flags | to.flags) & (flag::RIGHT | flag::BELOW) == 0 {
            // On a grid, moves from one cell to another are the most frequent case.
            if before != after {
                self.depart(models, bits, before, watcher);
                self.arrive(bits, after, watcher);
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
            return self.shift_across(models, bits, (before, from), (after, to), watcher);
        };
        // The move is along one axis. Before and after the move, the sprite covers one or two cells along
        // that axis. If the sprite lies in two rows or columns, it also covers the same number of cells
        // beside them.
        let ends = |cell: usize, flags: u32| (cell, if flags & reach != 0 { cell + unit } else { cell });
        let (old, new) = (ends(before, from.flags), ends(after, to.flags));
        for cell in [old.0, old.1].into_iter().take(1 + usize::from(old.1 != old.0)) {
            if cell != new.0 && cell != new.1 {
                self.depart(models, bits, cell, watcher);
                if across != 0 {
                    self.depart(models, bits, cell + across, watcher);
                }
            }
        }
        for cell in [new.0, new.1].into_iter().take(1 + usize::from(new.1 != new.0)) {
            if cell != old.0 && cell != old.1 {
                self.arrive(bits, cell, watcher);
                if across != 0 {
                    self.arrive(bits, cell + across, watcher);
                }
            }
        }
    }

    /// Completes [`World::shift`] for moves along both axes.
    #[inline(never)]
    fn shift_across(
        &mut self,
        models: &Models,
        bits: TypeBits,
        (before, from): (usize, Located),
        (after, to): (usize, Located),
        watcher: &mut impl Watcher,
    ) {
        let (gone, new) = self.span(before, from.flags).apart(
            self.span(after, to.flags),
            i32::from(to.column) - i32::from(from.column),
            i32::from(to.row) - i32::from(from.row),
        );
        for cell in gone.cells() {
            self.depart(models, bits, cell, watcher);
        }
        for cell in new.cells() {
            self.arrive(bits, cell, watcher);
        }
    }

    /// Records a large sprite's new cells.
    #[inline(never)]
    fn shift_big(&mut self, models: &Models, slot: Slot, from: Located, to: Located) {
        self.left_behind += u32::from(from.flags & flag::BIG != 0);
        let own = models.bit(self.sprite(slot).stype);
        if to.flags & flag::BIG != 0 && own != 0 {
            self.cover(own, slot);
        }
    }

    /// Records that a sprite has started to cover a cell.
    #[inline(always)]
    pub(crate) fn arrive(
        &mut self,
        TypeBits { own, partners }: TypeBits,
        cell: usize,
        watcher: &mut impl Watcher,
    ) {
        let mask = &mut self.masks[cell];
        let others =
            if *mask & own == 0 { std::mem::replace(mask, *mask | own) } else { self.crowd(own, cell) };
        if others & partners != 0 {
            watcher.arrives(own, others & partners);
        }
    }

    /// Records that a sprite has stopped covering a cell. The chains must already be up to date.
    #[inline(always)]
    fn depart(&mut self, models: &Models, bits: TypeBits, cell: usize, watcher: &mut impl Watcher) {
        let TypeBits { own, partners } = bits;
        let others = if self.crowds_in(cell) & own == 0 {
            self.masks[cell] &= !own;
            self.masks[cell]
        } else {
            self.thin_out(models, own, cell)
        };
        if others & partners != 0 {
            watcher.departs(own, others & partners);
        }
    }

    /// Returns the bits of the types that have several sprites in a cell.
    #[inline(always)]
    pub(crate) fn crowds_in(&self, cell: usize) -> u64 {
        self.crowds.get(cell).copied().unwrap_or(0)
    }

    /// Records that several sprites with the same bit cover a cell. Returns the bit, because the sprite now
    /// shares the cell with other sprites of the same kind.
    #[inline(never)]
    fn crowd(&mut self, own: u64, cell: usize) -> u64 {
        if self.crowds.is_empty() {
            self.crowds.resize(self.masks.len(), 0);
        }
        self.crowds[cell] |= own;
        own
    }

    /// Records that one of several sprites with a bit has left a cell. Returns the bit.
    #[inline(never)]
    fn thin_out(&mut self, models: &Models, own: u64, cell: usize) -> u64 {
        if self.count_in(models, cell, own) < 2 {
            self.crowds[cell] &= !own;
        }
        own
    }

    /// Returns the number of sprites with the given bit that cover a cell, up to a maximum of 2.
    #[inline(never)]
    fn count_in(&self, models: &Models, cell: usize, own: u64) -> u32 {
        let stride = (self.columns + 2) as usize;
        let mut count = 0;
        let reaches =
            [(0, 0), (1, flag::RIGHT), (stride, flag::BELOW), (stride + 1, flag::RIGHT | flag::BELOW)];
        for (back, reach) in reaches {
            let mut at = cell.checked_sub(back).map_or(NONE, |cell| self.cells[cell]);
            while at != NONE {
                let sprite = self.sprite(at);
                if sprite.flags & reach == reach && models.bit(sprite.stype) == own {
                    count += 1;
                    if count == 2 {
                        return count;
                    }
                }
                at = sprite.cell_next;
            }
        }
        count
    }

    /// Records the cells that a large sprite covers.
    pub(crate) fn cover(&mut self, own: u64, slot: Slot) {
        let mut covered = std::mem::take(&mut self.covered);
        covered.resize(self.cells.len(), 0);
        if !self.covered_by(self.sprite(slot), |cell| covered[cell] |= own) {
            self.vast |= own;
        }
        self.covered = covered;
    }

    /// Recomputes the cells that large sprites cover, if those sprites have left enough cells to justify the
    /// cost.
    #[inline]
    pub(crate) fn tidy_covered(&mut self, models: &Models) {
        if self.left_behind as usize > 4 * self.big as usize + self.cells.len() / 16 {
            self.cover_anew(models);
        }
    }

    #[inline(never)]
    fn cover_anew(&mut self, models: &Models) {
        self.covered.fill(0);
        (self.vast, self.left_behind) = (0, 0);
        for stype in (0..models.bits.len() as u16).map(SpriteType) {
            let own = models.bit(stype);
            if self.group(stype).big == 0 || own == 0 {
                continue;
            }
            let mut slot = self.group(stype).head;
            while slot != NONE {
                let sprite = self.sprite(slot);
                let next = sprite.next;
                if sprite.is(flag::BIG) {
                    self.cover(own, slot);
                }
                slot = next;
            }
        }
    }

    #[inline(always)]
    fn link(&mut self, slot: Slot, cell: usize) {
        let sprites = &mut self.sprites[..];
        let head = std::mem::replace(&mut self.cells[cell], slot);
        // Fixtures have no backward link.
        if let Some(head) = sprites.get_mut(usize::from(head)) {
            head.cell_previous = slot;
        }
        let sprite = &mut sprites[usize::from(slot)];
        (sprite.cell_next, sprite.cell_previous) = (head, NONE);
    }

    #[inline(always)]
    fn unlink(&mut self, slot: Slot, cell: usize) {
        let sprites = &mut self.sprites[..];
        let Sprite { cell_next, cell_previous, .. } = sprites[usize::from(slot)];
        match cell_previous {
            NONE => self.cells[cell] = cell_next,
            previous => sprites[usize::from(previous)].cell_next = cell_next,
        }
        if let Some(next) = sprites.get_mut(usize::from(cell_next)) {
            next.cell_previous = cell_previous;
        }
    }

    /// Updates a type's counts of sprites that are large, cover several cells or are not completely on the
    /// screen.
    #[inline]
    fn lie(&mut self, models: &Models, stype: SpriteType, from: u32, to: u32, watcher: &mut impl Watcher) {
        if (from ^ to) & flag::OFF != 0 {
            let group = &mut self.groups[stype.index()];
            if to & flag::OFF != 0 {
                (group.off, self.off) = (group.off + 1, self.off + 1);
            } else {
                (group.off, self.off) = (group.off - 1, self.off - 1);
            }
        }
        let group = &mut self.groups[stype.index()];
        match (from & flag::MULTI_CELL != 0, to & flag::MULTI_CELL != 0) {
            (false, true) => {
                group.multi_cell += 1;
                if group.multi_cell == 1 {
                    self.multi_cell_bits |= models.bit(stype);
                }
            }
            (true, false) => {
                group.multi_cell -= 1;
                if group.multi_cell == 0 {
                    self.multi_cell_bits &= !models.sole_bit(stype);
                }
            }
            _ => {}
        }
        let group = &mut self.groups[stype.index()];
        match (from & flag::BIG != 0, to & flag::BIG != 0) {
            (false, true) => {
                group.big += 1;
                self.big += 1;
                if group.big == 1 {
                    self.big_bits |= models.bit(stype);
                    watcher.enlarged(stype.index());
                }
            }
            (true, false) => {
                group.big -= 1;
                self.big -= 1;
                if group.big == 0 {
                    self.big_bits &= !models.sole_bit(stype);
                    watcher.reduced(stype.index());
                }
            }
            _ => {}
        }
    }

    /// Returns the cells that a sprite with these flags covers. For a large sprite, returns only the cell of
    /// its corner.
    #[inline(always)]
    pub(crate) fn span(&self, cell: usize, flags: u32) -> Span {
        let stride = (self.columns + 2) as usize;
        Span::new(cell, stride, flags & flag::RIGHT != 0, flags & flag::BELOW != 0)
    }

    /// Calls `visit` with each cell that a sprite covers. If the sprite covers more than [`MAX_COVERED`]
    /// cells, makes no calls and returns `false`.
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
}
