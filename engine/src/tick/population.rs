//! Operations that create, kill and remove sprites.

use crate::limits::MAX_SPRITES;
use crate::numbers::geometry::Rect;
use crate::rules::class::SpriteClass;
use crate::rules::{Limit, SpriteType};
use crate::tick::{Scheduler, Step};
use crate::world::{NONE, Slot, flag};

impl<S: Scheduler> Step<'_, S> {
    /// Returns `true` if the sprite's class is an avatar class. [`flag::AVATAR`] marks the actual avatars.
    pub(crate) fn can_be_played(&self, slot: Slot) -> bool {
        self.rules.types[self.world.sprite(slot).stype.index()].class.is_some_and(SpriteClass::is_avatar)
    }

    /// Creates a sprite. Returns `None` if the type or an ancestor is a singleton that already has a sprite, or if the
    /// number of sprites is at its limit (`spec/01` §3.5). A type that is undeclared or has no class stops the episode.
    pub(crate) fn add(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let rules = self.rules;
        if self.is_full() {
            return None;
        }
        let path = rules.types.get(stype.index()).map_or(&[][..], |info| &info.path);
        for &ancestor in path {
            if rules.types[ancestor.index()].singleton && self.world.count(rules, ancestor) > 0 {
                return None;
            }
        }
        self.make(stype, x, y)
    }

    /// Creates a sprite like [`Step::add`], but even if the type or an ancestor is a singleton that already has a
    /// sprite.
    pub(crate) fn add_forced(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        if self.is_full() { None } else { self.make(stype, x, y) }
    }

    /// Returns `true`, and logs a message, if there are too many sprites to create another one.
    fn is_full(&mut self) -> bool {
        let full = self.world.population() > MAX_SPRITES as i32;
        if full {
            self.message();
        }
        full
    }

    fn make(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let rules = self.rules;
        let info = rules.types.get(stype.index());
        let Some((info, class)) = info.and_then(|info| Some((info, info.class?))) else {
            self.stop(Limit::NoType);
            return None;
        };
        if info.incomplete {
            self.stop(Limit::UnfitSprite);
        }
        let block = self.world.block();
        let mut sprite = self.models.of_type[stype.index()].prototype;
        let size = |factor: f64| if factor == 1.0 { block } else { (f64::from(block) * factor) as i32 };
        let (w, h) = (size(info.traits.width_factor), size(info.traits.height_factor));
        sprite.rect = Rect { x, y, w, h };
        sprite.last_corner = (x, y);
        let mut last = sprite.rect;
        sprite.id = self.world.next_id();
        let first = self.world.is_first_of(stype);
        if first {
            self.world.add_messages(info.unknown_parameters);
        } else if h == 0 {
            self.stop(Limit::FlatSprite);
        }
        // Becomes `true` if the sprite is still to be updated in this tick. Its age is then 1 at that update.
        let mut due = false;
        if !sprite.is(flag::FROZEN) {
            let order = info.order.map_or(-1, i32::from);
            if order == self.updating {
                self.stop(Limit::SpawnIntoUpdatedType);
                return None;
            }
            due = order < self.updating;
            sprite.moved_at = (self.world.tick() - i32::from(due)).wrapping_sub(sprite.moved_at);
        }
        if first && !due {
            // The first sprite of a type keeps the unscaled size until its first update.
            (last.w, last.h) = (block, block);
        }
        if rules.scenery[stype.index()] {
            // Only levels create scenery, and scenery needs no slot.
            self.world.add_scenery(sprite);
            return None;
        }
        if rules.fixtures[stype.index()] {
            // Only levels create fixtures, and no code needs their slots.
            self.world.add_fixture(self.models, sprite, &mut self.scheduler);
            return None;
        }
        let Some(slot) = self.world.admit(self.models, &sprite, &mut self.scheduler) else {
            self.stop(Limit::Sprites);
            return None;
        };
        // Copies of the first sprite lack the type to leave behind, and leave type 0 (`wall`) behind instead.
        if first && class == SpriteClass::OngoingTurningAvatar {
            self.world.edit_overrides(slot).spawns = info.traits.spawn_behind.unwrap_or(SpriteType(0));
        }
        S::made(self, slot);
        if last != sprite.rect {
            self.world.set_last(slot, last);
        }
        Some(slot)
    }

    /// Kills a sprite. Avatars are disabled and stay on the board. Other sprites are removed at the end of
    /// the tick (`spec/03` §5.1).
    pub(crate) fn kill(&mut self, slot: Slot) {
        if !self.can_be_played(slot) {
            return self.remove(slot);
        }
        let sprite = self.world.sprite(slot);
        if sprite.is(flag::DISABLED) {
            return;
        }
        self.freeze(slot);
        self.world.disable(slot);
    }

    /// Stops a sprite from being updated and from ageing.
    fn freeze(&mut self, slot: Slot) {
        let age = self.age(slot);
        let sprite = self.world.edit(slot);
        sprite.set(flag::FROZEN, true);
        sprite.moved_at = age;
    }

    /// Kills a sprite permanently, even if it is an avatar.
    pub(crate) fn remove(&mut self, slot: Slot) {
        self.world.doom(slot);
    }

    /// Makes a sprite the player's avatar. From then on, this sprite is updated and ages, and the previous
    /// avatar does not.
    pub(crate) fn control(&mut self, slot: Slot) {
        let before = self.world.set_avatar(slot);
        if before != NONE && before != slot && !self.world.sprite(before).is(flag::FROZEN) {
            self.freeze(before);
        }
        let tick = self.world.tick();
        let sprite = self.world.edit(slot);
        if sprite.is(flag::FROZEN) && !sprite.is(flag::DISABLED) {
            sprite.set(flag::FROZEN, false);
            sprite.moved_at = tick.wrapping_sub(sprite.moved_at);
        }
    }

    /// Removes the sprites in the kill list.
    pub(crate) fn clear_killed(&mut self) {
        let mut at = 0;
        while let Some(slot) = self.world.killed().get(at).copied() {
            at += 1;
            if self.world.sprite(slot).is(flag::FREE) {
                continue;
            }
            if slot == self.world.avatar() {
                self.world.set_avatar(NONE);
            }
            S::removes(self, slot);
            self.world.release(self.models, slot, &mut self.scheduler);
        }
        self.world.forget_gone();
        self.world.forget_killed();
    }
}
