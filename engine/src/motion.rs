//! The operations of the ontology that move sprites.

use crate::game::Limit;
use crate::geometry::{Direction, Rect};
use crate::occupancy::Located;
use crate::sleep::mark;
use crate::state::{Slot, Sprite, flag};
use crate::step::Step;

impl Step<'_> {
    /// The reference's `lastmove`: ticks since the last move, at this tick's update or events.
    pub(crate) fn age(&self, slot: Slot) -> i32 {
        let sprite = self.state.sprite(slot);
        // The reference's counter overflows too.
        if sprite.is(flag::FROZEN) { sprite.moved_at } else { self.state.tick.wrapping_sub(sprite.moved_at) }
    }

    pub(crate) fn set_age(&mut self, slot: Slot, age: i32) {
        let tick = self.state.tick;
        let sprite = self.state.edit_motion(slot);
        sprite.moved_at = if sprite.is(flag::FROZEN) { age } else { tick.wrapping_sub(age) };
    }

    /// Sets the rectangle of a sprite, size included.
    pub(crate) fn place(&mut self, slot: Slot, rect: Rect) {
        if rect.h == 0 {
            self.stop(Limit::FlatSprite);
        }
        if self.state.sprite(slot).rect == rect {
            return;
        }
        if self.sleeps {
            let (from, to) = self.state.locate_move(slot, rect);
            self.place_noisily(slot, rect, from, to);
        } else {
            self.state.relocate(self.rules, slot, rect);
        }
    }

    /// The same in a game in which sprites sleep.
    fn place_noisily(&mut self, slot: Slot, rect: Rect, from: Located, to: Located) {
        let before = *self.state.sprite(slot);
        self.state.relocate_noisily(self.rules, slot, rect, from, to);
        // The sprite's own move may yet be undone: its effect is known only at the end of the tick.
        if !self.is_try(&before) {
            self.note_change(&before);
            let after = *self.state.sprite(slot);
            self.note_change(&after);
        }
        self.wake();
    }

    /// Tests whether a move is the sprite's own move, or the step back from it, which are judged at the end of the tick.
    fn is_try(&self, sprite: &Sprite) -> bool {
        self.sleeps
            && self.rules.shortcuts[sprite.stype.index()].sleeps
            && (self.updating >= 0 || !matches!(sprite.activity, mark::NOTHING | mark::DISTURBED))
    }

    pub(crate) fn note_change(&mut self, sprite: &Sprite) {
        if self.sleeps {
            self.state.stamp(sprite, self.state.tick);
        }
    }

    pub(crate) fn set_last(&mut self, slot: Slot, last: Rect) {
        let sprite = *self.state.sprite(slot);
        self.note_change(&sprite);
        self.work(self.state.resized.len() / 64);
        self.state.edit(slot);
        self.state.set_last(slot, last);
    }

    /// The basic step of `spec/01` §3.3: moves by `amount` pixels along `direction` unless the cooldown forbids it.
    pub(crate) fn displace(&mut self, slot: Slot, direction: Direction, amount: i32) -> bool {
        if self.is_held_up(slot) {
            return false;
        }
        let Some(aim) = self.shifted(slot, direction, amount) else { return false };
        self.go(slot, aim);
        true
    }

    /// [`Step::displace`] along one of [`Direction::BASE`], by `amount` pixels.
    #[inline(always)]
    pub(crate) fn displace_along(&mut self, slot: Slot, base: usize, amount: i32) -> bool {
        if self.is_held_up(slot) {
            return false;
        }
        let Rect { x, y, .. } = self.state.sprite(slot).rect;
        let by = if base < 2 { amount.saturating_neg() } else { amount };
        let (dx, dy) = if base.is_multiple_of(2) { (0, by) } else { (by, 0) };
        let aim = self.state.sprite(slot).rect.at(x.wrapping_add(dx), y.wrapping_add(dy));
        self.go(slot, aim);
        true
    }

    /// Tests whether a sprite's cooldown prevents it from moving.
    #[inline(always)]
    fn is_held_up(&self, slot: Slot) -> bool {
        self.rules.types[self.state.sprite(slot).stype.index()].traits.cooldown > self.age(slot)
    }

    /// Moves a sprite to any place, as part of its own movement.
    #[inline(never)]
    fn go(&mut self, slot: Slot, aim: Rect) {
        let sprite = self.state.sprite(slot);
        let special = sprite.is(flag::FROZEN) || aim == sprite.rect || aim.h == 0;
        if special {
            self.place(slot, aim);
            self.set_age(slot, 0);
            return;
        }
        // The common case, without separate calls.
        self.state.sprites[usize::from(slot)].moved_at = self.state.tick;
        let (from, to) = self.state.locate_move(slot, aim);
        if self.sleeps {
            self.place_noisily(slot, aim, from, to);
        } else {
            self.state.relocate_to(self.rules, slot, aim, from, to);
        }
    }

    /// The rectangle after a displacement; `None` if it does not move.
    #[inline(always)]
    pub(crate) fn shifted(&self, slot: Slot, direction: Direction, amount: i32) -> Option<Rect> {
        let sprite = self.state.sprite(slot);
        let amount = if amount == 0 { self.state.overrides_of(sprite).speed as i32 } else { amount };
        if amount == 0 || direction.x.abs() + direction.y.abs() == 0.0 {
            return None;
        }
        let rect = sprite.rect;
        // Most directions are grid directions.
        let shift = |component: f64| match component {
            0.0 => 0,
            1.0 => amount,
            -1.0 => amount.saturating_neg(),
            _ => (component * f64::from(amount)) as i32,
        };
        Some(rect.at(rect.x.wrapping_add(shift(direction.x)), rect.y.wrapping_add(shift(direction.y))))
    }

    /// The displacement of a sprite in this tick.
    pub(crate) fn last_direction(&self, slot: Slot) -> Direction {
        let Sprite { rect, last_corner, .. } = *self.state.sprite(slot);
        Direction {
            x: f64::from(rect.x.wrapping_sub(last_corner.0)),
            y: f64::from(rect.y.wrapping_sub(last_corner.1)),
        }
    }
}
