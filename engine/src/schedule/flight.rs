//! Sprites in flight: sprites that keep moving straight ahead as long as nothing happens to them.
//!
//! A car on a road moves two pixels in every tick, and each tick repeats the last tick. An invader moves in
//! every third tick, and in the other ticks merely draws a random number to decide whether to drop something.
//! Such sprites are not updated. Their position and their hash contribution (`contribution.rs`) are
//! extrapolated from an earlier position and the time since then.
//!
//! A sprite is recorded in a new cell only when it is about to cover that cell. The rules that pair the
//! sprite with other sprites in its cells are always known (`contacts.rs`), and overlap is tested with the
//! extrapolated position. As soon as an effect runs on the sprite, or can reach it, the sprite lands and
//! becomes an ordinary sprite again.
//!
//! Sprites of a type may fly only if that does not change the result (`spec/01` §4): their movement draws no
//! random numbers and counts nothing, and no other sprite searches for them. Producers that draw random
//! numbers continue to do so, and land when they create a sprite.

use super::{Foresight, mark};
use crate::flat::bytes_of_fields;
use crate::numbers::geometry::Rect;
use crate::tick::Step;
use crate::tick::physics;
use crate::world::sprites::flight::settle_in;
use crate::world::{Slot, Sprite, flag};

/// A sprite in flight, and the tick in which it is next recorded in different cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Flight {
    pub(crate) slot: Slot,
    pub(crate) due: i32,
}

bytes_of_fields! { Flight { slot due } }

/// The maximum distance from the board at takeoff, and the maximum length of a single move, in pixels. With
/// these limits, coordinates cannot overflow.
const FARTHEST: i32 = 1 << 16;
const FASTEST: i32 = 1 << 15;
/// The maximum number of ticks between the moves of a sprite in flight.
pub(crate) const LONGEST_PERIOD: i32 = 1000;

/// Returns the tick in which a sprite moves again after `moves` further moves.
fn due(sprite: &Sprite, moves: i32) -> i32 {
    let ticks = i32::from(sprite.period).saturating_mul(moves.saturating_add(1));
    sprite.moved_at.saturating_add(ticks)
}

impl Step<'_, Foresight<'_>> {
    /// Ends a flight. The sprite gets the values that it would have had after its update in `tick`.
    fn land(&mut self, slot: Slot, tick: i32) {
        let sprite = self.world.edit_motion(slot);
        settle_in(sprite, tick);
        let (stype, rect) = (sprite.stype, sprite.rect);
        let moved = !sprite.is_back();
        (sprite.activity, sprite.period) = (if moved { mark::MOVED } else { mark::NOTHING }, 0);
        if moved {
            self.world.note_moved(slot);
        }
        self.scheduler.schedule.skipped[stype.index()] -= 1;
        self.enter_anew(slot, rect);
    }

    fn enter_anew(&mut self, slot: Slot, rect: Rect) {
        self.world.enter_anew(self.models, slot, rect, &mut self.scheduler);
    }

    /// Records each due sprite in flight in its new cells, before the updates of a tick. For some sprites,
    /// this is slightly earlier than their own update, but nothing reads the cells before the event phase.
    #[inline]
    pub(crate) fn fly(&mut self) {
        if self.world.tick() >= self.scheduler.schedule.next_due {
            self.fly_on();
        }
    }

    #[inline(never)]
    fn fly_on(&mut self) {
        let tick = self.world.tick();
        let mut flights = std::mem::take(&mut self.scheduler.schedule.flights);
        let mut next = i32::MAX;
        for flight in &mut flights {
            if flight.due <= tick {
                flight.due = self.hop(flight.slot);
            }
            next = next.min(flight.due);
        }
        (self.scheduler.schedule.flights, self.scheduler.schedule.next_due) = (flights, next);
    }

    /// Records a sprite in flight in the cells that it will cover after this tick's update. Returns the tick
    /// in which the sprite's cells change next.
    fn hop(&mut self, slot: Slot) -> i32 {
        self.touch(slot);
        let (rect, by) = self.world.fly_on(slot);
        self.enter_anew(slot, rect);
        self.touch(slot);
        let sprite = *self.world.sprite(slot);
        let due = due(&sprite, self.world.moves_within(&sprite, by));
        if self.scheduler.plan.any_sleep {
            self.scheduler.schedule.stamp(self.world, &sprite, due);
        }
        due
    }

    /// Lands all sprites in flight. Call only between the updates of two ticks.
    pub(super) fn land_all(&mut self, tick: i32) {
        while let Some(flight) = self.scheduler.schedule.flights.pop() {
            self.land(flight.slot, tick);
        }
        self.scheduler.schedule.next_due = i32::MAX;
    }

    /// Lands a sprite on which an effect is about to run. Cost: O(sprites in flight) if the sprite flies.
    #[inline]
    pub(crate) fn land_one(&mut self, slot: Slot) {
        if self.world.sprite(slot).flies() {
            self.land_now(slot);
        }
    }

    #[inline(never)]
    fn land_now(&mut self, slot: Slot) {
        self.strike_flight(slot);
        self.land(slot, self.world.tick());
    }

    /// Lands a sprite immediately before its update in this tick.
    #[inline(never)]
    pub(crate) fn land_before_update(&mut self, slot: Slot) {
        self.strike_flight(slot);
        self.land_late(slot);
    }

    fn strike_flight(&mut self, slot: Slot) {
        self.work(self.scheduler.schedule.flights.len() / 64);
        let at = self.scheduler.schedule.flights.iter().position(|flight| flight.slot == slot);
        self.scheduler.schedule.flights.swap_remove(at.expect("a sprite in flight is in the list"));
    }

    /// Ends a flight with the values that the sprite has before its update in this tick.
    fn land_late(&mut self, slot: Slot) {
        self.land(slot, self.world.tick() - 1);
        let sprite = self.world.edit_motion(slot);
        sprite.last_corner = (sprite.rect.x, sprite.rect.y);
    }

    /// Lands all sprites in flight during the updates, when sprites not yet updated are one tick behind.
    pub(super) fn land_midway(&mut self) {
        let mut flights = std::mem::take(&mut self.scheduler.schedule.flights);
        for flight in flights.drain(..) {
            if self.has_moved(flight.slot) {
                self.land(flight.slot, self.world.tick());
            } else {
                self.land_late(flight.slot);
            }
        }
        self.scheduler.schedule.flights = flights;
        self.scheduler.schedule.next_due = i32::MAX;
    }

    /// Starts a sprite's flight after a tick in which the sprite has merely moved by itself. Returns `false`
    /// if the sprite cannot fly.
    pub(super) fn take_off(&mut self, slot: Slot) -> bool {
        let sprite = *self.world.sprite(slot);
        let (dx, dy) = (
            sprite.rect.x.wrapping_sub(sprite.last_corner.0),
            sprite.rect.y.wrapping_sub(sprite.last_corner.1),
        );
        let within = |most: i32| move |at: &i32| at.unsigned_abs() < most as u32;
        let near = [sprite.rect.x, sprite.rect.y].iter().all(within(FARTHEST));
        let near = near && [dx, dy].iter().all(within(FASTEST));
        let tick = self.world.tick();
        if !near || sprite.is(flag::BIG | flag::KILLED | flag::RESIZED) || sprite.moved_at != tick {
            return false;
        }
        let moves = self.world.moves_within(&sprite, (dx, dy));
        let next = sprite.rect.at(sprite.rect.x + dx, sprite.rect.y + dy);
        if physics::aim(self, slot) != Some(next) {
            return false;
        }
        let period = self.rules.types[sprite.stype.index()].traits.cooldown.clamp(1, LONGEST_PERIOD) as u16;
        let sprite = Sprite { activity: mark::SKIPPED, period, ..sprite };
        let due = due(&sprite, moves);
        if self.scheduler.plan.any_sleep {
            self.scheduler.schedule.stamp(self.world, &sprite, due);
        }
        let stype = sprite.stype;
        let sprite = self.world.edit_motion(slot);
        (sprite.activity, sprite.period) = (mark::SKIPPED, period);
        sprite.set(flag::MOVED, false);
        self.scheduler.schedule.skipped[stype.index()] += 1;
        self.scheduler.schedule.flights.push(Flight { slot, due });
        self.scheduler.schedule.next_due = self.scheduler.schedule.next_due.min(due);
        true
    }
}
