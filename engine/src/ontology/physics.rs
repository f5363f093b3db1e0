//! Grid physics (`spec/02` §3.1).

use crate::geometry::{Direction, Rect};
use crate::state::{Slot, flag};
use crate::step::Step;

/// What an active movement did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Movement {
    Still,
    Rotate,
    Move,
}

/// Moves a sprite along its own orientation. The first call only marks the sprite as having had it.
pub(crate) fn passive(step: &mut Step<'_>, slot: Slot) {
    let block = f64::from(step.state.block);
    let sprite = step.state.sprite(slot);
    if sprite.is(flag::FIRST_TICK) {
        step.state.edit(slot).set(flag::FIRST_TICK, false);
        return;
    }
    let speed = if sprite.speed == -1.0 { 1.0 } else { sprite.speed };
    if speed != 0.0 && sprite.is(flag::ORIENTED) {
        step.displace(slot, sprite.orientation, (speed * block) as i32);
    }
}

/// Moves a sprite where it, or its player, wants to go. A speed of 0 stands for the sprite's own, at least 1.
pub(crate) fn active(step: &mut Step<'_>, slot: Slot, direction: Direction, speed: f64) -> Movement {
    let block = f64::from(step.state.block);
    let sprite = step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if traits.stationary || direction == Direction::NONE {
        return Movement::Still;
    }
    let speed = match speed {
        0.0 if sprite.speed <= 0.0 => 1.0,
        0.0 => sprite.speed,
        speed => speed,
    };
    if traits.rotate_in_place && turn(step, slot, direction) {
        return Movement::Rotate;
    }
    if step.displace(slot, direction, (speed * block) as i32) { Movement::Move } else { Movement::Still }
}

/// Changes the orientation if the sprite has one and it is another.
pub(crate) fn turn(step: &mut Step<'_>, slot: Slot, direction: Direction) -> bool {
    let sprite = step.state.sprite(slot);
    if !sprite.is(flag::ORIENTED) || sprite.orientation == direction {
        return false;
    }
    step.state.edit(slot).orientation = direction;
    true
}

/// Distance of top-left corners: Manhattan.
pub(crate) fn distance(a: Rect, b: Rect) -> f64 {
    (f64::from(a.y) - f64::from(b.y)).abs() + (f64::from(a.x) - f64::from(b.x)).abs()
}
