//! Overlap queries, based on the cells that two sprites share (`occupancy.rs`).

use super::span::Span;
use crate::numbers::geometry::Rect;
use crate::rules::{NOT_IN_TREE, TypeInfo};
use crate::world::{NONE, Slot, Sprite, World, flag};
use smallvec::SmallVec;

/// One side of a pass: the types in a tree, and their bits.
#[derive(Clone, Copy)]
pub(crate) struct Side<'a> {
    pub(crate) family: &'a TypeInfo,
    pub(crate) bits: u64,
}

/// A sprite that overlaps another sprite. Hits are ordered like the sprites of a tree: by type, in tree
/// order, and then by creation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Hit(u64);

impl Hit {
    fn new(rank: u16, id: u32, slot: Slot) -> Hit {
        Hit(u64::from(rank) << 48 | u64::from(id) << 16 | u64::from(slot))
    }

    pub(crate) fn slot(self) -> Slot {
        self.0 as Slot
    }
}

/// The sprites that overlap a sprite. There are usually only a few.
pub(crate) type Hits = SmallVec<[Hit; 8]>;
/// The slots of the sprites that overlap a sprite.
pub(crate) type Partners = SmallVec<[Slot; 8]>;

impl World {
    /// Calls `visit` with every sprite that may overlap a rectangle. `reach` is the size of the largest sprite, in
    /// cells.
    pub(crate) fn near_rect(&self, reach: i32, rect: Rect, mut visit: impl FnMut(Slot)) {
        let reach = reach.saturating_mul(self.block) - 1;
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

    /// Returns `true` if a type with any of these bits has sprites larger than a cell.
    #[inline(always)]
    pub(crate) fn is_big(&self, bits: u64) -> bool {
        self.big_bits & bits != 0
    }

    /// Returns `true` if a sprite of a type with any of these bits, no larger than a cell, covers a cell.
    pub(crate) fn is_covered(&self, column: u32, row: u32, bits: u64) -> bool {
        self.masks[self.cell(column as i32, row as i32)] & bits != 0
    }

    /// Returns the hit for a sprite on a side.
    pub(crate) fn hit(&self, side: Side<'_>, slot: Slot) -> Hit {
        let sprite = self.sprite(slot);
        Hit::new(side.family.rank[sprite.stype.index()], sprite.id, slot)
    }

    /// Returns `true` if another sprite on a side may overlap `sprite`, because the two share a cell. `own`
    /// is the type bit of `sprite`.
    #[inline(always)]
    pub(crate) fn may_overlap(&self, own: u64, side: Side<'_>, sprite: &Sprite) -> bool {
        let cell = self.cell_of(sprite);
        if (self.masks[cell] & !own | self.crowds_in(cell)) & side.bits != 0 {
            return true;
        }
        let lies = sprite.flags & flag::MULTI_CELL;
        if lies == 0 && self.big_bits & side.bits == 0 {
            return false;
        }
        self.may_overlap_loosely(own, side, cell, lies)
    }

    /// Returns `true` if a sprite on a side may overlap `sprite`, or lie up to `below` pixels under it.
    #[inline]
    pub(crate) fn may_stand_on(&self, side: Side<'_>, sprite: &Sprite, below: i32) -> bool {
        if self.big_bits & side.bits != 0 || sprite.is(flag::BIG | flag::OFF) || below > self.block {
            return true;
        }
        let stride = (self.columns + 2) as usize;
        let width = usize::from(sprite.is(flag::RIGHT));
        let top = self.cell_of(sprite);
        let rows = [top, top + stride, top + stride * (1 + usize::from(sprite.is(flag::BELOW)))];
        rows.iter().any(|&cell| (self.masks[cell] | self.masks[cell + width]) & side.bits != 0)
    }

    /// Completes [`World::may_overlap`] for sprites in several cells and for sides with large sprites.
    fn may_overlap_loosely(&self, own: u64, side: Side<'_>, cell: usize, lies: u32) -> bool {
        if lies & flag::BIG != 0 {
            return true;
        }
        let others = |cell: usize| self.masks[cell] & !own | self.crowds_in(cell);
        let stride = (self.columns + 2) as usize;
        let mut bits = 0;
        if lies & flag::RIGHT != 0 {
            bits |= others(cell + 1);
        }
        if lies & flag::BELOW != 0 {
            bits |= others(cell + stride);
            if lies & flag::RIGHT != 0 {
                bits |= others(cell + stride + 1);
            }
        }
        bits & side.bits != 0 || self.span_is_covered(self.span(cell, lies), side)
    }

    /// Returns `true` if a large sprite on a side may reach into the cells of `span`.
    #[inline(always)]
    fn span_is_covered(&self, span: Span, side: Side<'_>) -> bool {
        self.big_bits & side.bits != 0
            && span.cells().fold(self.vast, |bits, cell| bits | self.covered[cell]) & side.bits != 0
    }

    /// Collects the sprites on a side that overlap a sprite, excluding the sprite itself, in no particular
    /// order. Sprites whose ID is `above` or higher are excluded. Returns the number of examined cells and
    /// sprites.
    #[inline(always)]
    pub(crate) fn overlapping(
        &self,
        reach: i32,
        side: Side<'_>,
        slot: Slot,
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let sprite = self.sprite(slot);
        // The sprite is in one cell, and so is each sprite on the side. On a grid, this is the most frequent
        // case.
        if sprite.flags & flag::MULTI_CELL == 0 && self.multi_cell_bits & side.bits == 0 {
            return self.overlapping_among(
                self.cell_of(sprite),
                side,
                (slot, self.rect(sprite)),
                above,
                hits,
            );
        }
        self.overlapping_around(reach, side, slot, above, hits)
    }

    /// Collects overlapping sprites like [`World::overlapping`], for sprites in several cells.
    fn overlapping_around(
        &self,
        reach: i32,
        side: Side<'_>,
        slot: Slot,
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let sprite = self.sprite(slot);
        let rect = self.rect(sprite);
        let span = self.span(self.cell_of(sprite), sprite.flags);
        if sprite.is(flag::BIG) || self.span_is_covered(span, side) {
            return self.overlapping_rect(reach, side, (slot, rect), above, hits);
        }
        // Sprites in several cells may extend from the cells to the left and above.
        let reached = i32::from(self.multi_cell_bits & side.bits != 0);
        let (column, row) = (i32::from(sprite.column), i32::from(sprite.row));
        let mut looked = 0;
        for row in (row - reached).max(0)..row + span.below() + 1 {
            for column in (column - reached).max(0)..column + span.right() + 1 {
                looked += self.overlapping_in(self.cell(column, row), side, (slot, rect), above, hits);
            }
        }
        looked
    }

    /// Collects the sprites on a side that overlap a rectangle around a sprite, excluding the sprite itself.
    /// Returns the number of examined cells and sprites.
    pub(crate) fn overlapping_rect(
        &self,
        reach: i32,
        side: Side<'_>,
        (slot, rect): (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let reach = reach.saturating_mul(self.block) - 1;
        let first_column = self.column(rect.x.saturating_sub(reach));
        let last_column = self.column(rect.x.saturating_add(rect.w.saturating_sub(1)));
        let first_row = self.row(rect.y.saturating_sub(reach));
        let last_row = self.row(rect.y.saturating_add(rect.h.saturating_sub(1)));
        let cells = (last_column - first_column + 1) * (last_row - first_row + 1);
        let family = side.family;
        let sprites = family.tree.iter().map(|&stype| i32::from(self.group(stype).count)).sum::<i32>();
        if cells > sprites {
            // Visit the sprites rather than the cells, because there are fewer sprites than cells from which
            // a sprite can reach into the rectangle.
            let types = family.tree.iter().enumerate();
            let types = types.filter(|(at, stype)| usize::from(family.rank[stype.index()]) == *at);
            let all = types.flat_map(|(_, &stype)| self.slots(stype));
            let overlaps = |at: &Slot| {
                let sprite = self.sprite(*at);
                *at != slot && sprite.id < above && self.rect(sprite).intersects(rect)
            };
            hits.extend(all.filter(overlaps).map(|at| self.hit(side, at)));
            return family.tree.len() + sprites as usize;
        }
        let mut looked = 0;
        for row in first_row..last_row + 1 {
            for column in first_column..last_column + 1 {
                looked += self.overlapping_in(self.cell(column, row), side, (slot, rect), above, hits);
            }
        }
        looked
    }

    #[inline(always)]
    fn overlapping_in(
        &self,
        cell: usize,
        side: Side<'_>,
        one: (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        if self.masks[cell] & side.bits == 0 {
            return 1;
        }
        self.overlapping_among(cell, side, one, above, hits)
    }

    /// Collects overlapping sprites like [`World::overlapping`], within one cell that contains a sprite on
    /// the side.
    #[inline(never)]
    fn overlapping_among(
        &self,
        cell: usize,
        side: Side<'_>,
        (slot, rect): (Slot, Rect),
        above: u32,
        hits: &mut Hits,
    ) -> usize {
        let mut at = self.cells[cell];
        let mut looked = 1;
        while at != NONE {
            looked += 1;
            let sprite = self.sprite(at);
            let rank = side.family.rank[sprite.stype.index()];
            if rank != NOT_IN_TREE && at != slot && sprite.id < above && self.rect(sprite).intersects(rect) {
                hits.push(Hit::new(rank, sprite.id, at));
            }
            at = sprite.cell_next;
        }
        looked
    }
}
