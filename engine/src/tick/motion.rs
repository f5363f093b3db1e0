//! Operations that move sprites.

use crate::numbers::geometry::{Direction, Rect};
use crate::rules::Limit;
use crate::tick::{Scheduler, Step};
use crate::world::{Slot, Sprite, flag};

impl<S: Scheduler> Step<'_, S> {
    /// Returns the value of `lastmove` in the reference: the ticks since the last move, as of this tick's
    /// update or events.
    pub(crate) fn age(&self, slot: Slot) -> i32 {
        let sprite = self.world.own(slot);
        // The reference's counter overflows in the same way.
        if sprite.is(flag::FROZEN) {
            sprite.moved_at
        } else {
            self.world.tick().wrapping_sub(sprite.moved_at)
        }
    }

    pub(crate) fn set_age(&mut self, slot: Slot, age: i32) {
        let tick = self.world.tick();
        let sprite = self.world.edit_motion(slot);
        sprite.moved_at = if sprite.is(flag::FROZEN) { age } else { tick.wrapping_sub(age) };
    }

    /// Sets a sprite's rectangle, including its size.
    pub(crate) fn place(&mut self, slot: Slot, rect: Rect) {
        if rect.h == 0 {
            self.stop(Limit::FlatSprite);
        }
        if self.world.sprite(slot).rect == rect {
            return;
        }
        S::relocates(self, slot, rect);
    }

    /// Moves a sprite to a rectangle of any size.
    #[inline(always)]
    pub(crate) fn relocate(&mut self, slot: Slot, rect: Rect) {
        self.world.relocate(self.models, slot, rect, &mut self.scheduler);
    }

    pub(crate) fn set_last(&mut self, slot: Slot, last: Rect) {
        S::changes(self, slot);
        self.work(self.world.resized_count() / 64);
        self.world.edit(slot);
        self.world.set_last(slot, last);
    }

    /// Makes the basic step of `spec/01` §3.3: moves a sprite by `amount` pixels along `direction`, unless
    /// its cooldown prevents the move. Returns `true` if the sprite moved.
    pub(crate) fn displace(&mut self, slot: Slot, direction: Direction, amount: i32) -> bool {
        if self.is_held_up(slot) {
            return false;
        }
        let Some(aim) = self.shifted(slot, direction, amount) else { return false };
        self.go(slot, aim);
        true
    }

    /// Makes the basic step like [`Step::displace`], along one of [`Direction::BASE`].
    #[inline(always)]
    pub(crate) fn displace_along(&mut self, slot: Slot, base: usize, amount: i32) -> bool {
        if self.is_held_up(slot) {
            return false;
        }
        let Rect { x, y, .. } = self.world.own(slot).rect;
        let by = if base < 2 { amount.saturating_neg() } else { amount };
        let (dx, dy) = if base.is_multiple_of(2) { (0, by) } else { (by, 0) };
        let aim = self.world.own(slot).rect.at(x.wrapping_add(dx), y.wrapping_add(dy));
        self.go(slot, aim);
        true
    }

    /// Returns `true` if a sprite's cooldown prevents it from moving.
    #[inline(always)]
    fn is_held_up(&self, slot: Slot) -> bool {
        self.rules.types[self.world.own(slot).stype.index()].traits.cooldown > self.age(slot)
    }

    /// Moves a sprite to a position as part of its own movement.
    #[inline(never)]
    fn go(&mut self, slot: Slot, aim: Rect) {
        let sprite = self.world.own(slot);
        let special = sprite.is(flag::FROZEN) || aim == sprite.rect || aim.h == 0;
        if special {
            self.place(slot, aim);
            self.set_age(slot, 0);
            return;
        }
        // The common case, with the calls inlined.
        self.world.start_move(slot);
        S::relocates(self, slot, aim);
    }

    /// Returns the rectangle after a displacement, or `None` if the sprite does not move.
    #[inline(always)]
    pub(crate) fn shifted(&self, slot: Slot, direction: Direction, amount: i32) -> Option<Rect> {
        let sprite = self.world.own(slot);
        let amount = if amount == 0 { self.world.overrides_of(sprite).speed as i32 } else { amount };
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

    /// Returns a sprite's displacement in this tick.
    pub(crate) fn last_direction(&self, slot: Slot) -> Direction {
        let Sprite { rect, last_corner, .. } = *self.world.sprite(slot);
        Direction {
            x: f64::from(rect.x.wrapping_sub(last_corner.0)),
            y: f64::from(rect.y.wrapping_sub(last_corner.1)),
        }
    }
}
