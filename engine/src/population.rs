//! The operations of the ontology that make, kill and release sprites.

use crate::game::{Limit, SpriteType, TypeInfo};
use crate::geometry::Rect;
use crate::limits::MAX_SPRITES;
use crate::ontology::class::SpriteClass;
use crate::ontology::sprites;
use crate::overrides::Overrides;
use crate::sleep::mark;
use crate::state::{NONE, Slot, Sprite, flag};
use crate::step::Step;

/// The prototype of a type's sprites; the rectangles, the creation number and the age are set on creation.
pub(crate) fn prototype(stype: SpriteType, info: &TypeInfo) -> Sprite {
    let (traits, is_avatar) = (&info.traits, info.class.is_some_and(SpriteClass::is_avatar));
    let flags = [
        (flag::AVATAR, traits.is_avatar),
        (flag::FROM_AVATAR, traits.is_from_avatar),
        (flag::ON_GROUND, traits.on_ground),
        (flag::FIRST_TICK, traits.is_first_tick),
        (flag::ORIENTED, traits.is_oriented),
        // Sprites of avatar classes are updated, and age, only while the player controls them.
        (flag::FROZEN, info.order.is_none() || is_avatar),
        (flag::NO_COOLDOWN, traits.cooldown <= 1 && traits.last_move == 0 && !is_avatar),
    ];
    let no_heading = sprites::NO_HEADING << flag::HEADING;
    Sprite {
        rect: Rect::default(),
        last_corner: (0, 0),
        id: 0,
        moved_at: traits.last_move,
        time_to_live: traits.time_to_live,
        count: traits.age,
        stype,
        overrides: stype.0,
        activity: mark::NOTHING,
        flags: flags.into_iter().fold(no_heading, |all, (bit, on)| if on { all | bit } else { all }),
        next: NONE,
        previous: NONE,
        cell_next: NONE,
        cell_previous: NONE,
        column: 0,
        row: 0,
    }
}

/// The values that the sprites of a type share.
pub(crate) fn base_overrides(info: &TypeInfo) -> Overrides {
    let traits = &info.traits;
    Overrides {
        orientation: traits.orientation,
        speed: traits.speed,
        health: traits.health,
        max_health: traits.max_health,
        start: -1,
        spawns: match info.class {
            Some(SpriteClass::OngoingTurningAvatar) => SpriteType(0),
            _ => traits.stypes.first().copied().unwrap_or(SpriteType::NONE),
        },
        extra: NONE,
        holder: NONE,
    }
}

impl Step<'_> {
    /// Tests whether the sprite's class is an avatar's; the role of the sprite itself is [`flag::AVATAR`].
    pub(crate) fn can_be_played(&self, slot: Slot) -> bool {
        self.rules.types[self.state.sprite(slot).stype.index()].class.is_some_and(SpriteClass::is_avatar)
    }

    /// Makes a sprite unless a singleton of its line exists or there are too many (`spec/01` §3.5).
    pub(crate) fn add(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let rules = self.rules;
        if self.is_full() {
            return None;
        }
        let path = rules.types.get(stype.index()).map_or(&[][..], |info| &info.path);
        for &ancestor in path {
            if rules.types[ancestor.index()].singleton && self.state.count(rules, ancestor) > 0 {
                return None;
            }
        }
        self.make(stype, x, y)
    }

    /// Makes a sprite even if a singleton of its line exists.
    pub(crate) fn add_forced(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        if self.is_full() { None } else { self.make(stype, x, y) }
    }

    /// Tests whether there are too many sprites to make another one, and logs a message if so.
    fn is_full(&mut self) -> bool {
        let full = self.state.population > MAX_SPRITES as i32;
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
        let block = self.state.block;
        let mut sprite = rules.prototypes[stype.index()];
        let size = |factor: f64| if factor == 1.0 { block } else { (f64::from(block) * factor) as i32 };
        let (w, h) = (size(info.traits.width_factor), size(info.traits.height_factor));
        sprite.rect = Rect { x, y, w, h };
        sprite.last_corner = (x, y);
        let mut last = sprite.rect;
        sprite.id = self.state.next_id;
        let first = std::mem::replace(&mut self.state.templates[stype.index()], 1) == 0;
        if first {
            self.state.memory_is_dirty = true;
            self.state.messages = self.state.messages.saturating_add(info.unknown_parameters);
        } else if h == 0 {
            self.stop(Limit::FlatSprite);
        }
        // The flag is `true` if the sprite is still to be updated in this tick: its age will be 1 at that update.
        let mut due = false;
        if !sprite.is(flag::FROZEN) {
            let order = info.order.map_or(-1, i32::from);
            if order == self.updating {
                self.stop(Limit::SpawnIntoUpdatedType);
                return None;
            }
            due = order < self.updating;
            sprite.moved_at = (self.state.tick - i32::from(due)).wrapping_sub(sprite.moved_at);
        }
        if first && !due {
            // The first sprite of a type keeps the unscaled size until its first update.
            (last.w, last.h) = (block, block);
        }
        if rules.scenery[stype.index()] {
            // Only a level makes scenery, and it needs no slot.
            self.state.add_scenery(sprite);
            return None;
        }
        let Some(slot) = self.state.admit(rules, &sprite) else {
            self.stop(Limit::Sprites);
            return None;
        };
        self.state.next_id += 1;
        self.state.population += 1;
        // Copies of the first one have lost the type that they leave behind; they leave type 0, which is `wall`.
        if first && class == SpriteClass::OngoingTurningAvatar {
            self.state.edit_overrides(slot).spawns = info.traits.spawn_behind.unwrap_or(SpriteType(0));
        }
        if self.sleeps {
            let sprite = *self.state.sprite(slot);
            self.state.touch(slot);
            self.note_change(&sprite);
            self.wake();
        }
        if last != sprite.rect {
            self.state.set_last(slot, last);
        }
        Some(slot)
    }

    /// Kills a sprite: avatars are disabled and stay, others are removed at the end of the tick (`spec/03` §5.1).
    pub(crate) fn kill(&mut self, slot: Slot) {
        if !self.can_be_played(slot) {
            return self.remove(slot);
        }
        let sprite = self.state.sprite(slot);
        if sprite.is(flag::DISABLED) {
            return;
        }
        let stype = sprite.stype;
        self.freeze(slot);
        self.state.edit(slot).set(flag::DISABLED, true);
        self.state.groups[stype.index()].disabled += 1;
        self.state.census_changed = true;
    }

    /// Stops the updates and the ageing of a sprite.
    fn freeze(&mut self, slot: Slot) {
        let age = self.age(slot);
        let sprite = self.state.edit(slot);
        sprite.set(flag::FROZEN, true);
        sprite.moved_at = age;
    }

    /// Kills a sprite for good, avatar or not.
    pub(crate) fn remove(&mut self, slot: Slot) {
        self.state.edit_motion(slot).set(flag::KILLED, true);
        self.state.killed.push(slot);
    }

    /// Gives a sprite to the player: from now on it is updated and ages, and the previous avatar does not.
    pub(crate) fn control(&mut self, slot: Slot) {
        let before = std::mem::replace(&mut self.state.avatar, slot);
        if before != NONE && before != slot && !self.state.sprite(before).is(flag::FROZEN) {
            self.freeze(before);
        }
        let tick = self.state.tick;
        let sprite = self.state.edit(slot);
        if sprite.is(flag::FROZEN) && !sprite.is(flag::DISABLED) {
            sprite.set(flag::FROZEN, false);
            sprite.moved_at = tick.wrapping_sub(sprite.moved_at);
        }
    }

    /// Removes the sprites in the kill list.
    pub(crate) fn clear_killed(&mut self) {
        let mut killed = std::mem::take(&mut self.state.killed);
        for &slot in &killed {
            // The kill list may name a sprite twice; the counter goes down twice, as in the reference.
            self.state.population -= 1;
            if self.state.sprite(slot).is(flag::FREE) {
                continue;
            }
            if slot == self.state.avatar {
                self.state.avatar = NONE;
            }
            if self.sleeps {
                let sprite = *self.state.sprite(slot);
                self.state.touch(slot);
                self.note_change(&sprite);
            }
            self.state.release(self.rules, slot);
        }
        self.state.forget_gone();
        killed.clear();
        self.state.killed = killed;
    }
}
