//! Sleeping sprites: sprites that try to move in every tick, but are moved back by the same rule every time.
//!
//! A boulder on the ground falls a little, collides with the dirt below and is moved back in every tick. As
//! long as nothing enters or leaves the cells of the boulder and the cells below, each tick repeats the last
//! tick and changes nothing. Such a sprite is skipped.
//!
//! As soon as anything changes in these cells, the sprite wakes. If its turn to move in this tick has already
//! passed, but the rule that moves it back has not run yet, the movement is performed late.
//!
//! Sprites may sleep only if that does not change the result (`spec/01` §4, `spec/03` §4). The conditions
//! are:
//!
//! - The sprite tries to move in every tick, and its movement draws no random numbers and counts nothing.
//! - The rule that moves the sprite back has no score.
//! - Nothing else happens to the sprite in the tick.
//! - No rule pairs the sprite with anything that it stands on.
//! - Nothing searches for the sprite's type.
//!
//! An effect that reaches distant sprites wakes all sleeping sprites.

use super::flight::LONGEST_PERIOD;
use super::{Foresight, Schedule};
use crate::flat::bytes_of_fields;
use crate::numbers::geometry::Rect;
use crate::rules::class::SpriteClass;
use crate::rules::effects::PutBack;
use crate::rules::{EffectInfo, Pass, SpriteType, TypeInfo};
use crate::tick::Step;
use crate::tick::physics;
use crate::world::{Slot, Sprite, World, flag};

/// Values of [`Sprite::activity`], which record the sprite's activity in this tick.
pub(crate) mod mark {
    /// The sprite has not moved on its own, or has not moved in the way that sleeping sprites do.
    pub(crate) const NOTHING: u16 = 0;
    /// The sprite has moved on its own, and nothing else has happened to it.
    pub(crate) const MOVED: u16 = 0x7FFF;
    /// Something other than its own movement has happened to the sprite.
    pub(crate) const DISTURBED: u16 = 0x7FFE;
    /// The bit that marks sprites that are not updated. Without this bit, any other value is one more than
    /// the index of the pass that moved the sprite back.
    pub(crate) const SKIPPED: u16 = 0x8000;
}

/// The maximum side length in cells of any sprite in a game with sleeping sprites.
const LARGEST: f64 = 4.0;

/// The cells around a sleeping sprite, and the pass that would move it back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sleeper {
    pub(crate) slot: Slot,
    pub(crate) pass: u16,
    pub(crate) left: i16,
    pub(crate) top: i16,
    pub(crate) right: i16,
    pub(crate) bottom: i16,
}

bytes_of_fields! { Sleeper { slot pass left top right bottom } }

impl Sleeper {
    fn holds(&self, column: i16, row: i16) -> bool {
        self.left <= column && column <= self.right && self.top <= row && row <= self.bottom
    }
}

/// The shortcuts available to sprites of a type.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shortcuts {
    /// `true` if sprites of the type may fly.
    pub(crate) flies: bool,
    /// `true` if sprites of the type may sleep, which means that their updates are skipped.
    pub(crate) sleeps: bool,
}

/// Returns each type's shortcuts.
pub(crate) fn shortcuts(types: &[TypeInfo], passes: &[Pass], effects: &[EffectInfo]) -> Vec<Shortcuts> {
    use SpriteClass as C;
    let large = |factor: f64| factor.is_nan() || factor > LARGEST;
    let large = |info: &TypeInfo| large(info.traits.width_factor) || large(info.traits.height_factor);
    if types.iter().any(|info| info.ground_aware) {
        return vec![Shortcuts::default(); types.len()];
    }
    let any_large = types.iter().any(large);
    let is_put_back = |stype: SpriteType| {
        passes.iter().any(|pass| {
            let puts_back = effects[usize::from(pass.effect)].in_tick.puts_back;
            puts_back == Some(PutBack::ToLastPlace) && types[pass.first.index()].in_tree(stype)
        })
    };
    let sought = |stype: SpriteType| {
        types.iter().any(|info| {
            let seeks = info.class.is_some_and(|class| class.is_a(C::RandomNPC));
            seeks
                && info
                    .traits
                    .stypes
                    .iter()
                    .filter_map(|target| types.get(target.index()))
                    .any(|family| family.in_tree(stype))
        })
    };
    let draws = |info: &TypeInfo| matches!(info.class, Some(C::SpawnPoint | C::Bomber));
    let may = |(number, info): (u16, &TypeInfo)| {
        let traits = &info.traits;
        let plain = matches!(
            info.class,
            Some(
                C::Immovable
                    | C::Door
                    | C::Passive
                    | C::Conveyor
                    | C::Resource
                    | C::ResourcePack
                    | C::Missile
                    | C::ErraticMissile
                    | C::RandomMissile
            )
        );
        let is_idle = info.class.is_some() && info.is_idle();
        (plain || draws(info) && !traits.oriented_image)
            // Types that never move on their own need no shortcut.
            && !is_idle
            && !traits.continuous
            // Sprites that have a cooldown and enter a new cell with every move are cheaper to update than to
            // fly.
            && (traits.cooldown <= 1 || traits.cooldown <= LONGEST_PERIOD && traits.speed.abs() < 1.0)
            && traits.last_move == 0
            && traits.time_to_live < 0
            && info.order.is_some()
            && !sought(SpriteType(number))
    };
    let of_type = |(number, info)| {
        let flies = may((number, info));
        let tries_always = info.traits.cooldown <= 1 && !draws(info);
        Shortcuts { flies, sleeps: flies && tries_always && !any_large && is_put_back(SpriteType(number)) }
    };
    (0u16..).zip(types).map(of_type).collect()
}

impl Schedule {
    /// Records that a sprite's cells have changed, so that the sleeping sprites that watch these cells wake.
    #[inline(never)]
    fn touch(&mut self, world: &World, slot: Slot) {
        let Schedule { watched, touched, .. } = self;
        world.covered_by(world.sprite(slot), |cell| {
            if watched[cell] > 0 {
                touched.push(cell as u32);
            }
        });
    }

    /// Records a permanent change in the cells that a sprite covers.
    pub(crate) fn stamp(&mut self, world: &World, sprite: &Sprite, tick: i32) {
        let stamp = stamp_of(tick);
        let stamps = &mut self.stamps;
        world.covered_by(sprite, |cell| stamps[cell] = stamps[cell].max(stamp));
    }
}

impl Foresight<'_> {
    /// Wakes all sleeping sprites. Call only between steps.
    pub(super) fn wake_all(&mut self, world: &mut World) {
        let Schedule { sleepers, skipped, watched, .. } = &mut *self.schedule;
        for sleeper in sleepers.drain(..) {
            *world.activity(sleeper.slot) = mark::NOTHING;
            skipped[world.sprite(sleeper.slot).stype.index()] -= 1;
        }
        watched.fill(0);
    }
}

impl Step<'_, Foresight<'_>> {
    /// Records that a sprite's cells have changed.
    #[inline(always)]
    pub(crate) fn touch(&mut self, slot: Slot) {
        if !self.scheduler.schedule.sleepers.is_empty() {
            self.scheduler.schedule.touch(self.world, slot);
        }
    }

    /// Records a permanent change in a sprite's cells.
    pub(super) fn stamp(&mut self, slot: Slot) {
        let sprite = *self.world.sprite(slot);
        self.scheduler.schedule.stamp(self.world, &sprite, self.world.tick());
    }

    /// Relocates a sprite like [`Step::relocate`], and wakes the sleeping sprites that watch the affected
    /// cells.
    pub(super) fn relocate_noisily(&mut self, slot: Slot, rect: Rect) {
        let before = *self.world.sprite(slot);
        self.touch(slot);
        self.relocate(slot, rect);
        self.touch(slot);
        // The sprite's own move may still be undone, so its result is known only at the end of the tick.
        if !self.is_try(&before) {
            self.scheduler.schedule.stamp(self.world, &before, self.world.tick());
            self.stamp(slot);
        }
        self.wake();
    }

    /// Returns `true` if a move is either the sprite's own move or the move that undoes it. Both moves are
    /// evaluated at the end of the tick.
    fn is_try(&self, sprite: &Sprite) -> bool {
        self.scheduler.plan.shortcuts[sprite.stype.index()].sleeps
            && (self.updating >= 0 || !matches!(sprite.activity, mark::NOTHING | mark::DISTURBED))
    }

    /// Wakes and lands sprites before an effect runs on a sprite, and records the execution.
    pub(super) fn foresee(&mut self, info: &EffectInfo, one: Slot, partners: &[Slot]) {
        let effect = info.in_tick;
        self.land_one(one);
        if effect.affects_distant_sprites {
            self.wake_and_land_all();
        } else if effect.shields {
            self.wake_sleepers();
        }
        let free = !info.in_batch && info.score_change == 0 && info.counting.is_none();
        let back = effect.puts_back == Some(PutBack::ToLastPlace);
        self.note(one, free && back);
        for &partner in partners {
            self.land_one(partner);
            // Blocking another sprite changes nothing, unless it changes the score.
            let harmless = free && effect.puts_back.is_some();
            if self.world.sprite(partner).activity != mark::NOTHING && !harmless {
                *self.world.activity(partner) = mark::DISTURBED;
            }
        }
    }

    /// Records the execution of an effect on a sprite. `is_put_back` is `true` if the effect only moves the sprite
    /// back.
    fn note(&mut self, one: Slot, is_put_back: bool) {
        let pass = self.pass;
        let activity = self.world.activity(one);
        if *activity != mark::NOTHING {
            *activity = if is_put_back && *activity == mark::MOVED && pass >= 0 {
                pass as u16 + 1
            } else {
                mark::DISTURBED
            };
        }
    }

    /// Puts sprites to sleep or into flight after a tick. Sprites that were moved back to a position where
    /// nothing else changed start to sleep. Sprites that will continue to move in the same way start to fly.
    #[inline]
    pub(crate) fn sleep_or_fly(&mut self) {
        if self.scheduler.any_moved && self.stopped.is_none() {
            self.sleep_or_fly_each();
        }
    }

    #[inline(never)]
    fn sleep_or_fly_each(&mut self) {
        if self.scheduler.sleeps {
            self.stamp_moved();
        }
        for at in 0..self.world.moved().len() {
            let slot = self.world.moved()[at];
            let sprite = self.world.own(slot);
            let (activity, back) = (sprite.activity, sprite.is_back());
            if activity == mark::MOVED && !back && self.take_off(slot) {
                continue;
            }
            let sprite = self.world.own(slot);
            let may_sleep =
                || self.scheduler.sleeps && self.scheduler.plan.shortcuts[sprite.stype.index()].sleeps;
            if activity < mark::DISTURBED && activity != mark::NOTHING && back && may_sleep() {
                self.try_sleep(slot, activity - 1);
            }
        }
        self.world.shorten_moved();
    }

    /// Records the moves that have not been undone. All other changes are recorded immediately when they
    /// happen.
    fn stamp_moved(&mut self) {
        for at in 0..self.world.moved().len() {
            let slot = self.world.moved()[at];
            let (sprite, last) = (*self.world.sprite(slot), self.world.last(slot));
            if sprite.activity != mark::NOTHING && !sprite.is_back() {
                self.scheduler.schedule.stamp(self.world, &sprite, self.world.tick());
                let (column, row) = self.world.place_of(last);
                let before = Sprite { rect: last, flags: sprite.flags | flag::BIG, column, row, ..sprite };
                self.scheduler.schedule.stamp(self.world, &before, self.world.tick());
            }
        }
    }

    fn try_sleep(&mut self, slot: Slot, pass: u16) {
        let sprite = *self.world.sprite(slot);
        let Some(aim) = physics::aim(self, slot) else { return };
        let around = |a: i32, b: i32, size: i32| (a.min(b), a.max(b).saturating_add(size - 1));
        let (left, right) = around(sprite.rect.x, aim.x, sprite.rect.w);
        let (top, bottom) = around(sprite.rect.y, aim.y, sprite.rect.h);
        let (left, top) = self.world.place_of(sprite.rect.at(left, top));
        let (right, bottom) = self.world.place_of(sprite.rect.at(right, bottom));
        if (right - left) > 2 || (bottom - top) > 2 {
            return;
        }
        let sleeper = Sleeper { slot, pass, left, top, right, bottom };
        let now = stamp_of(self.world.tick());
        let quiet = sleeper.cells(self.world).all(|cell| {
            self.scheduler.schedule.stamps[cell] < now && self.scheduler.schedule.watched[cell] < u8::MAX
        });
        // An effect, such as one at the edge, might run on the sprite at its current position. While the
        // sprite is awake, its own movement avoids that effect.
        if !quiet || sprite.is(flag::OFF) || self.overlaps_rule_partner(slot) {
            return;
        }
        for cell in sleeper.cells(self.world) {
            self.scheduler.schedule.watched[cell] += 1;
        }
        *self.world.activity(slot) = mark::SKIPPED;
        self.scheduler.schedule.skipped[sprite.stype.index()] += 1;
        self.scheduler.schedule.sleepers.push(sleeper);
    }

    /// Returns `true` if a rule pairs the sprite with anything that it overlaps at its current position.
    fn overlaps_rule_partner(&self, slot: Slot) -> bool {
        let Sprite { rect, stype, .. } = *self.world.sprite(slot);
        let partners = self.models.bits[stype.index()].partners;
        let mut found = false;
        self.world.near_rect(self.rules.reach, rect, |other| {
            let sprite = self.world.sprite(other);
            let is_partner = partners & self.models.bit(sprite.stype) != 0;
            found |= other != slot && is_partner && sprite.rect.intersects(rect);
        });
        found
    }

    /// Wakes the sleeping sprites near the touched cells.
    #[inline]
    pub(crate) fn wake(&mut self) {
        if !self.scheduler.schedule.touched.is_empty() {
            self.wake_touched();
        }
    }

    fn wake_touched(&mut self) {
        while let Some(cell) = self.scheduler.schedule.touched.pop() {
            if self.scheduler.schedule.watched[cell as usize] == 0 {
                continue;
            }
            self.work(self.scheduler.schedule.sleepers.len() / 64);
            let stride = (self.world.columns() + 2) as u32;
            let (column, row) = ((cell % stride) as i16, (cell / stride) as i16);
            let mut at = 0;
            while at < self.scheduler.schedule.sleepers.len() {
                if self.scheduler.schedule.sleepers[at].holds(column, row) {
                    let sleeper = self.scheduler.schedule.sleepers.swap_remove(at);
                    self.wake_one(sleeper);
                } else {
                    at += 1;
                }
            }
        }
    }

    /// Wakes one sprite. If the sprite's turn to move in this tick has passed, but the rule that moves it
    /// back has not run yet, performs the movement late.
    fn wake_one(&mut self, sleeper: Sleeper) {
        let slot = sleeper.slot;
        for cell in sleeper.cells(self.world) {
            self.scheduler.schedule.watched[cell] -= 1;
        }
        *self.world.activity(slot) = mark::NOTHING;
        let sprite = *self.world.sprite(slot);
        self.scheduler.schedule.skipped[sprite.stype.index()] -= 1;
        if sprite.is(flag::FREE) {
            return;
        }
        if self.has_moved(slot)
            && self.pass < i32::from(sleeper.pass)
            && let Some(aim) = physics::aim(self, slot)
        {
            *self.world.activity(slot) = mark::MOVED;
            self.scheduler.any_moved = true;
            self.place(slot, aim);
            self.set_age(slot, 0);
        }
    }

    /// Returns `true` if a sprite's own update in this tick has already run.
    pub(crate) fn has_moved(&self, slot: Slot) -> bool {
        let Sprite { id, stype, .. } = *self.world.sprite(slot);
        let order = self.rules.types[stype.index()].order.map_or(-1, i32::from);
        self.updating < order || self.updating == order && id < self.updating_id
    }

    /// Wakes and lands all sprites, because anything may be about to change.
    pub(crate) fn wake_and_land_all(&mut self) {
        self.wake_sleepers();
        self.land_midway();
    }

    pub(crate) fn wake_sleepers(&mut self) {
        while let Some(sleeper) = self.scheduler.schedule.sleepers.pop() {
            self.wake_one(sleeper);
        }
        self.wake();
    }
}

impl Sleeper {
    fn cells(&self, world: &World) -> impl Iterator<Item = usize> + use<> {
        let stride = world.columns() + 2;
        let Sleeper { left, top, right, bottom, .. } = *self;
        (i32::from(top)..i32::from(bottom) + 1).flat_map(move |row| {
            (i32::from(left)..i32::from(right) + 1).map(move |column| (row * stride + column) as usize)
        })
    }
}

/// Converts a tick into a stamp. Games end long before a stamp overflows.
fn stamp_of(tick: i32) -> i16 {
    tick.clamp(-1, i32::from(i16::MAX)) as i16
}
