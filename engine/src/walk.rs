//! Walks: moves of a sprite that lies in one cell of the board to the next cell along an axis. This is the fast path for
//! most moves on a grid; it has the same result as the general one (`motion.rs`, `occupancy.rs`).

use crate::geometry::Rect;
use crate::occupancy::Located;
use crate::state::{Slot, flag};
use crate::step::Step;

/// The flags of sprites that cannot take this path.
const NOT_ON_FOOT: u32 = flag::FROZEN | flag::DEFERRED | flag::PLACEMENT;

impl Step<'_> {
    /// Moves a sprite as part of its own movement, in a game without sleeping sprites. Returns `false`, and does nothing,
    /// if the move is not a walk.
    #[inline(always)]
    pub(crate) fn walk(&mut self, slot: Slot, aim: Rect) -> bool {
        let (rules, state) = (self.rules, &mut *self.state);
        let sprite = &mut state.sprites[usize::from(slot)];
        let (dx, dy) = (aim.x.wrapping_sub(sprite.rect.x), aim.y.wrapping_sub(sprite.rect.y));
        let is_next = dx.unsigned_abs().wrapping_add(dy.unsigned_abs()) == state.block as u32;
        if sprite.flags & NOT_ON_FOOT != 0 || !is_next || dx != 0 && dy != 0 || aim.h == 0 {
            return false;
        }
        let from = Located { column: sprite.column, row: sprite.row, flags: 0 };
        let (column, row) = (from.column + dx.signum() as i16, from.row + dy.signum() as i16);
        let inside = |at: i16, cells: i32| (0..cells).contains(&(i32::from(at) - 1));
        if !inside(column, state.columns) || !inside(row, state.rows) {
            return false;
        }
        sprite.moved_at = state.tick;
        let kind = &rules.contacts.kinds[sprite.stype.index()];
        let stride = state.columns as usize + 2;
        let cell = |column: i16, row: i16| row as usize * stride + column as usize;
        let (before, after) = (cell(from.column, from.row), cell(column, row));
        let deferred = state.masks[after] & kind.barriers != 0 && self.defers;
        if deferred && self.defer_move_into(slot, aim, from, (after, 0)) {
            return true;
        }
        let state = &mut *self.state;
        let sprite = &mut state.sprites[usize::from(slot)];
        let flags = sprite.flags;
        sprite.flags |= flag::DIRTY | flag::MOVED;
        (sprite.rect.x, sprite.rect.y, sprite.column, sprite.row) = (aim.x, aim.y, column, row);
        if flags & flag::MOVED == 0 {
            state.moved.push(slot);
        }
        if flags & flag::DIRTY == 0 {
            state.dirty.push(slot);
        }
        if kind.own != 0 {
            state.unlink(slot, before);
            state.link(slot, after);
            state.depart(&rules.contacts, kind, before);
            state.arrive(&rules.contacts, kind, after);
        }
        true
    }
}
