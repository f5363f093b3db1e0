//! Sprites in flight: those that go straight on as long as nothing happens to them.
//!
//! A car on its lane moves two pixels in every tick, and each tick does to it what the last one did. So it is not updated:
//! where it is follows from where it was and how long ago, and so does its share of the hash (`hash.rs`). Only when it comes
//! to cover other cells is it entered there, and in those ahead. Which rules are about sprites that share its cells is known
//! all the while (`contacts.rs`), and whether it overlaps them is asked of where it is now. As soon as an effect is executed
//! on it, or can reach it, it lands: it is an ordinary sprite again.
//!
//! Which types may fly is decided so that no one can tell the difference (`spec/01` §4): their movement draws nothing, counts
//! nothing and does not wait, and no other sprite looks for them.

use crate::game::Rules;
use crate::geometry::Rect;
use crate::ontology::physics;
use crate::rest::mark;
use crate::state::{Slot, Sprite, State, flag};
use crate::step::Step;

/// A sprite in flight, and the tick in which it comes to cover other cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Flight {
    pub(crate) slot: Slot,
    pub(crate) due: i32,
}

/// Pixels that a sprite in flight moves in a tick at most, and that it is away from the board when it takes off: far from
/// where numbers overflow.
const FARTHEST: i32 = 1 << 16;

/// Where a sprite in flight is in a tick.
fn flown(sprite: &Sprite, tick: i32) -> Rect {
    let Sprite { rect, last, .. } = *sprite;
    let ticks = tick.wrapping_sub(sprite.moved_at);
    let along = |at: i32, last: i32| at.wrapping_add(at.wrapping_sub(last).wrapping_mul(ticks));
    rect.at(along(rect.x, last.x), along(rect.y, last.y))
}

/// Makes a sprite in flight as it is in a tick. Returns how far it moves in one.
fn fly_to(sprite: &mut Sprite, tick: i32) -> (i32, i32) {
    let (dx, dy) = (sprite.rect.x.wrapping_sub(sprite.last.x), sprite.rect.y.wrapping_sub(sprite.last.y));
    sprite.rect = flown(sprite, tick);
    (sprite.last.x, sprite.last.y) = (sprite.rect.x.wrapping_sub(dx), sprite.rect.y.wrapping_sub(dy));
    sprite.moved_at = tick;
    (dx, dy)
}

impl State {
    /// Where a sprite is, in flight or not; in the event phase and between steps.
    pub(crate) fn rect(&self, sprite: &Sprite) -> Rect {
        if sprite.rest == mark::FLYING { flown(sprite, self.tick) } else { sprite.rect }
    }

    /// A sprite as it is now, in flight or not; in the event phase and between steps.
    pub(crate) fn present(&self, slot: Slot) -> Sprite {
        let mut sprite = *self.sprite(slot);
        if sprite.rest == mark::FLYING {
            fly_to(&mut sprite, self.tick);
        }
        sprite
    }

    /// Ends a flight: the sprite is as it would be after its update in `tick`.
    fn land(&mut self, rules: &Rules, slot: Slot, tick: i32) {
        let sprite = self.edit_motion(slot);
        fly_to(sprite, tick);
        sprite.rest = mark::TRIED;
        sprite.set(flag::MOVED, true);
        let (stype, rect) = (sprite.stype, sprite.rect);
        self.groups[stype.index()].asleep -= 1;
        self.moved.push(slot);
        self.enter_anew(rules, slot, rect);
    }

    /// Before the updates of a tick: those that are due come to their new cells. That is a little early for sprites whose
    /// update comes later, but no one looks before the event phase.
    #[inline]
    pub(crate) fn fly(&mut self, rules: &Rules) {
        if self.tick >= self.next_due {
            self.fly_on(rules);
        }
    }

    #[inline(never)]
    fn fly_on(&mut self, rules: &Rules) {
        let tick = self.tick;
        let mut flights = std::mem::take(&mut self.flights);
        let mut next = i32::MAX;
        for flight in &mut flights {
            if flight.due <= tick {
                flight.due = self.hop(rules, flight.slot);
            }
            next = next.min(flight.due);
        }
        (self.flights, self.next_due) = (flights, next);
    }

    /// Enters a sprite in flight where it will be after this tick's update. Returns when to do so again.
    fn hop(&mut self, rules: &Rules, slot: Slot) -> i32 {
        if !self.rests.is_empty() {
            self.touch(slot);
        }
        let by = fly_to(&mut self.sprites[usize::from(slot)], self.tick);
        let moves = self.enter_next_lane(rules, slot, by).unwrap_or_else(|| self.enter_lane(rules, slot, by));
        if !self.rests.is_empty() {
            self.touch(slot);
        }
        let due = self.tick.saturating_add(moves).saturating_add(1);
        if rules.any_rests {
            let sprite = *self.sprite(slot);
            self.stamp(&sprite, due);
        }
        due
    }

    /// Nothing flies any more. Between steps only.
    pub(crate) fn land_all(&mut self, rules: &Rules) {
        while let Some(flight) = self.flights.pop() {
            self.land(rules, flight.slot, self.tick);
        }
        self.next_due = i32::MAX;
    }
}

impl Step<'_> {
    /// An effect is about to be executed on a sprite. Cost: O(sprites in flight), if it flies.
    #[inline]
    pub(crate) fn land_one(&mut self, slot: Slot) {
        if self.state.sprite(slot).rest == mark::FLYING {
            self.land_now(slot);
        }
    }

    #[inline(never)]
    fn land_now(&mut self, slot: Slot) {
        self.work(self.state.flights.len() / 64);
        let at = self.state.flights.iter().position(|flight| flight.slot == slot);
        self.state.flights.swap_remove(at.expect("what flies is in the list"));
        self.state.land(self.rules, slot, self.state.tick);
    }

    /// Nothing flies any more. In the middle of the updates, those are a tick behind that are yet to be updated.
    pub(crate) fn land_midway(&mut self) {
        let mut flights = std::mem::take(&mut self.state.flights);
        for flight in flights.drain(..) {
            let late = !self.has_moved(flight.slot);
            self.state.land(self.rules, flight.slot, self.state.tick - i32::from(late));
            if late {
                let sprite = self.state.edit(flight.slot);
                sprite.last = sprite.rect;
            }
        }
        self.state.flights = flights;
        self.state.next_due = i32::MAX;
    }

    /// After a tick in which a sprite has moved by itself and nothing else happened to it: whether it flies from now on.
    pub(crate) fn take_off(&mut self, slot: Slot) -> bool {
        let sprite = *self.state.sprite(slot);
        let (dx, dy) = (sprite.rect.x.wrapping_sub(sprite.last.x), sprite.rect.y.wrapping_sub(sprite.last.y));
        let near =
            [sprite.rect.x, sprite.rect.y, dx, dy].iter().all(|at| at.unsigned_abs() < FARTHEST as u32);
        let tick = self.state.tick;
        if !near || sprite.is(flag::BIG | flag::KILLED) || sprite.moved_at != tick {
            return false;
        }
        let moves = self.state.moves_within(&sprite, dx, dy);
        let next = sprite.rect.at(sprite.rect.x + dx, sprite.rect.y + dy);
        if physics::aim(self, slot) != Some(next) {
            return false;
        }
        let due = tick.saturating_add(moves).saturating_add(1);
        if self.rules.any_rests {
            self.state.stamp(&sprite, due);
        }
        let sprite = self.state.edit_motion(slot);
        sprite.rest = mark::FLYING;
        sprite.set(flag::MOVED, false);
        let stype = sprite.stype;
        self.state.groups[stype.index()].asleep += 1;
        self.state.flights.push(Flight { slot, due });
        self.state.next_due = self.state.next_due.min(due);
        true
    }
}
