//! Changes to sprites. Every change, regardless of its cause, is made by a method in this file or in this
//! list:
//!
//! - [`World::admit`] adds a new sprite, and [`World::release`] removes a sprite. In between, a sprite may be
//!   on the kill list ([`World::doom`]), or an avatar may be disabled ([`World::disable`]).
//! - [`World::add_fixture`] creates a sprite that never changes (`fixtures.rs`), and [`World::add_scenery`]
//!   one that no rule involves (`scenery.rs`).
//! - [`World::relocate`] moves a sprite to a different position, and may change its size (`occupancy.rs`).
//!   [`World::set_last`] changes its previous rectangle (`moved.rs`).
//! - [`World::edit`] and [`World::edit_motion`] give access to a sprite's other fields, and mark its part of
//!   the hash as stale.
//! - [`World::edit_overrides`] also marks this part as stale, and gives access to values that a sprite shares
//!   with its type (`overrides.rs`): orientation, speed, health. [`World::add_amount`] and
//!   [`World::replace_missile`] change tables that few sprites need (`side_tables.rs`).
//!
//! The VGDL operations in `tick/population.rs` and `tick/motion.rs` call these methods, and effects and
//! updates call those operations. `numbers.rs` changes the numbers that are stored alongside the sprites.

use super::{Models, NONE, Slot, Sprite, Target, Watcher, World, flag};
use crate::limits::MAX_SLOTS;
use crate::world::hash::contribution::Contribution;

impl World {
    /// Stores `sprite` in a slot, and appends the slot to the type's chain. Returns `None` if all slots are
    /// in use.
    pub(crate) fn admit(
        &mut self,
        models: &Models,
        sprite: &Sprite,
        watcher: &mut impl Watcher,
    ) -> Option<Slot> {
        let slot = match self.free {
            NONE => {
                let slot = self.sprites.len();
                if slot + self.fixture_count() >= MAX_SLOTS {
                    return None;
                }
                let slot = slot as Slot;
                self.sprites.push(*sprite);
                self.contributions.push(Contribution::default());
                slot
            }
            slot => slot,
        };
        let group = &mut self.groups[sprite.stype.index()];
        let tail = std::mem::replace(&mut group.tail, slot);
        group.count += 1;
        if tail == NONE {
            group.head = slot;
        } else {
            self.sprites[usize::from(tail)].next = slot;
        }
        self.census_changed |= models.of_type[sprite.stype.index()].counted;
        let place = &mut self.sprites[usize::from(slot)];
        if self.free == slot {
            self.free = place.next;
        }
        // A slot that was freed in this tick may already be in the list of dirty sprites.
        let dirty = place.is(flag::DIRTY);
        *place = *sprite;
        place.previous = tail;
        place.flags |= flag::DIRTY | flag::CHANGED;
        if !dirty {
            self.dirty.push(slot);
        }
        self.enter_cell(models, slot, watcher);
        self.next_id += 1;
        self.population += 1;
        Some(slot)
    }

    /// Returns a sprite for modification, and marks its whole hash contribution as dirty.
    pub(crate) fn edit(&mut self, slot: Slot) -> &mut Sprite {
        let sprite = self.edit_motion(slot);
        sprite.flags |= flag::CHANGED;
        sprite
    }

    /// Returns a sprite for modification. The caller may change only its flags, position, age, time to live,
    /// count and heading.
    #[inline(always)]
    pub(crate) fn edit_motion(&mut self, slot: Slot) -> &mut Sprite {
        let sprite = &mut self.sprites[usize::from(slot)];
        if sprite.flags & flag::DIRTY == 0 {
            sprite.flags |= flag::DIRTY;
            self.dirty.push(slot);
        }
        sprite
    }

    /// Returns the schedule's record of a sprite's activity in this tick.
    #[inline(always)]
    pub(crate) fn activity(&mut self, slot: Slot) -> &mut u16 {
        &mut self.sprites[usize::from(slot)].activity
    }

    /// Disables an avatar. The avatar stays on the board, but terminations do not count it.
    pub(crate) fn disable(&mut self, slot: Slot) {
        let sprite = self.edit(slot);
        sprite.set(flag::DISABLED, true);
        let stype = sprite.stype;
        self.groups[stype.index()].disabled += 1;
        self.census_changed = true;
    }

    /// Adds a sprite to the kill list.
    pub(crate) fn doom(&mut self, slot: Slot) {
        self.edit_motion(slot).set(flag::KILLED, true);
        self.killed.push(slot);
    }

    /// Empties the kill list. For a sprite that is listed twice, decrements the reference's counter twice.
    pub(crate) fn forget_killed(&mut self) {
        self.population -= self.killed.len() as i32;
        self.killed.clear();
    }

    /// Removes a slot from its chains, and frees the slot. After the last such call, the caller must call
    /// [`World::forget_gone`].
    pub(crate) fn release(&mut self, models: &Models, slot: Slot, watcher: &mut impl Watcher) {
        let Sprite { stype, next, previous, flags, .. } = *self.sprite(slot);
        self.leave_cell(models, slot, watcher);
        self.census_changed |= models.of_type[stype.index()].counted;
        let group = &mut self.groups[stype.index()];
        group.count -= 1;
        if flags & flag::DISABLED != 0 {
            group.disabled -= 1;
        }
        match previous {
            NONE => group.head = next,
            previous => self.sprites[usize::from(previous)].next = next,
        }
        match next {
            NONE => self.groups[stype.index()].tail = previous,
            next => self.sprites[usize::from(next)].previous = previous,
        }
        self.release_side_tables(slot);
        self.release_overrides(slot);
        let next = std::mem::replace(&mut self.free, slot);
        let sprite = self.edit(slot);
        // The slot stays in the list of dirty sprites, once.
        (sprite.next, sprite.flags) = (next, flag::FREE | flag::DIRTY);
    }

    /// Clears references to freed slots. Chasing sprites keep their target's last rectangle.
    pub(crate) fn forget_gone(&mut self) {
        self.forget_moved();
        let World { extras, sprites, .. } = self;
        for extra in extras {
            if let Target::Sprite(slot) = extra.target
                && let Some(sprite) = sprites.get(usize::from(slot)).filter(|sprite| sprite.is(flag::FREE))
            {
                extra.target = Target::Gone(sprite.rect);
            }
        }
    }
}
