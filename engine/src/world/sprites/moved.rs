//! Each sprite's rectangle at the start of its last update. The reference stores this rectangle in each
//! sprite.
//!
//! Each sprite stores its earlier corner. Its earlier size equals its current size, except for the few
//! sprites that have been resized since.

use crate::flat::bytes_of_fields;
use crate::numbers::geometry::Rect;
use crate::world::{Slot, Sprite, World, flag};

/// A sprite's size before it was resized in this tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Resized {
    pub(crate) slot: Slot,
    pub(crate) w: i32,
    pub(crate) h: i32,
}

bytes_of_fields! { Resized { slot w h } }

/// Returns a sprite's rectangle at the start of its own update in this tick.
#[inline]
pub(crate) fn last_of(sprite: &Sprite, slot: Slot, resized: &[Resized]) -> Rect {
    let last = sprite.rect.at(sprite.last_corner.0, sprite.last_corner.1);
    if sprite.is(flag::RESIZED) { of_size_then(last, slot, resized) } else { last }
}

#[cold]
fn of_size_then(last: Rect, slot: Slot, resized: &[Resized]) -> Rect {
    let found = resized.binary_search_by_key(&slot, |one| one.slot);
    found.map_or(last, |at| Rect { w: resized[at].w, h: resized[at].h, ..last })
}

impl Sprite {
    /// Returns `true` if the sprite has the same position and size as at the start of its own update in this tick.
    #[inline]
    pub(crate) fn is_back(&self) -> bool {
        self.last_corner == (self.rect.x, self.rect.y) && !self.is(flag::RESIZED)
    }
}

impl World {
    /// Returns a sprite's rectangle at the start of its own update in this tick.
    #[inline]
    pub(crate) fn last(&self, slot: Slot) -> Rect {
        last_of(self.sprite(slot), slot, &self.resized)
    }

    /// Sets a sprite's rectangle at the start of its own update in this tick. The sprite then counts as
    /// moved.
    pub(crate) fn set_last(&mut self, slot: Slot, last: Rect) {
        let sprite = &mut self.sprites[usize::from(slot)];
        let (before, resized) = (sprite.flags, (sprite.rect.w, sprite.rect.h) != (last.w, last.h));
        sprite.last_corner = (last.x, last.y);
        sprite.set(flag::MOVED, true);
        sprite.set(flag::RESIZED, resized);
        if before & flag::MOVED == 0 {
            self.moved.push(slot);
        }
        if resized || before & flag::RESIZED != 0 {
            self.note_size(slot, resized, last);
        }
    }

    /// Returns the sprites that have moved, or may have moved.
    #[inline(always)]
    pub(crate) fn moved(&self) -> &[Slot] {
        &self.moved
    }

    /// Returns the number of moved sprites whose size has changed.
    pub(crate) fn resized_count(&self) -> usize {
        self.resized.len()
    }

    /// Starts a sprite's own move, which resets its age. The caller relocates the sprite.
    #[inline(always)]
    pub(crate) fn start_move(&mut self, slot: Slot) {
        self.sprites[usize::from(slot)].moved_at = self.tick;
    }

    /// Removes from the list of moved sprites those whose flag is no longer set.
    pub(crate) fn shorten_moved(&mut self) {
        let World { moved, sprites, .. } = self;
        moved.retain(|&slot| sprites[usize::from(slot)].is(flag::MOVED));
    }

    /// Adds a sprite to the list of moved sprites. The sprite must not be in the list yet.
    pub(crate) fn note_moved(&mut self, slot: Slot) {
        self.sprites[usize::from(slot)].set(flag::MOVED, true);
        self.moved.push(slot);
    }

    #[inline(never)]
    fn note_size(&mut self, slot: Slot, resized: bool, Rect { w, h, .. }: Rect) {
        let one = Resized { slot, w, h };
        match self.resized.binary_search_by_key(&slot, |one| one.slot) {
            Ok(at) if resized => self.resized[at] = one,
            Ok(at) => drop(self.resized.remove(at)),
            Err(at) => self.resized.insert(at, one),
        }
    }

    /// Removes released sprites from the lists of moved and resized sprites.
    pub(crate) fn forget_moved(&mut self) {
        let World { moved, resized, sprites, .. } = self;
        let stays = |slot: Slot| !sprites[usize::from(slot)].is(flag::FREE);
        moved.retain(|&slot| stays(slot));
        resized.retain(|one| stays(one.slot));
    }

    /// Sets each sprite's last rectangle to its current rectangle. The reference does this for each sprite
    /// immediately before the sprite's update. The result differs only for sprites that have moved by then,
    /// and nothing reads another sprite's last rectangle before the event phase.
    #[inline]
    pub(crate) fn settle_moved(&mut self) {
        let World { sprites, moved, resized, .. } = self;
        let mut frozen = false;
        for &slot in &*moved {
            let sprite = &mut sprites[usize::from(slot)];
            if sprite.flags & flag::FROZEN == 0 {
                sprite.last_corner = (sprite.rect.x, sprite.rect.y);
                sprite.flags &= !(flag::MOVED | flag::RESIZED);
            } else if sprite.is_back() {
                sprite.flags &= !flag::MOVED;
            } else {
                // The sprite remains in the list of moved sprites.
                frozen = true;
            }
        }
        if frozen {
            moved.retain(|&slot| sprites[usize::from(slot)].is(flag::MOVED));
        } else {
            moved.clear();
        }
        if !resized.is_empty() {
            resized.retain(|one| sprites[usize::from(one.slot)].is(flag::RESIZED));
        }
    }
}
