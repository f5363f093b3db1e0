//! Grid and continuous physics (`spec/02` §3).

use crate::game::Rules;
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

/// Pixels of a grid cell as physics sees it: continuous physics has a constant of its own.
pub(crate) fn grid_size(step: &Step<'_>, slot: Slot) -> f64 {
    if is_continuous(step.rules, step, slot) { 10.0 } else { f64::from(step.state.block) }
}

fn is_continuous(rules: &Rules, step: &Step<'_>, slot: Slot) -> bool {
    rules.types[step.state.sprite(slot).stype.index()].traits.continuous
}

/// Moves a sprite along its own orientation, unless it is static. The first call only marks the sprite as having had it.
#[inline]
pub(crate) fn passive(step: &mut Step<'_>, slot: Slot) {
    let sprite = step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if traits.is_static || traits.only_active {
        return;
    }
    if sprite.is(flag::FIRST_TICK) {
        step.state.edit_motion(slot).set(flag::FIRST_TICK, false);
        return;
    }
    if traits.continuous {
        if sprite.speed == 0.0 {
            return;
        }
        let (orientation, amount) = (sprite.orientation, sprite.speed as i32);
        step.displace(slot, orientation, amount);
        let gravity = step.state.gravity(step.rules, slot);
        if gravity > 0.0 && traits.mass > 0.0 && !step.state.sprite(slot).is(flag::ON_GROUND) {
            active(step, slot, Direction { x: 0.0, y: gravity * traits.mass }, 0.0);
        }
        if traits.friction != 0.0 {
            step.state.edit(slot).speed *= 1.0 - traits.friction;
        }
        return;
    }
    let speed = if sprite.speed == -1.0 { 1.0 } else { sprite.speed };
    if speed != 0.0 && sprite.is(flag::ORIENTED) {
        let (orientation, block) = (sprite.orientation, f64::from(step.state.block));
        step.displace(slot, orientation, (speed * block) as i32);
    }
}

/// Where passive movement takes a sprite of grid physics; None if nowhere.
pub(crate) fn aim(step: &Step<'_>, slot: Slot) -> Option<Rect> {
    let sprite = step.state.sprite(slot);
    let speed = if sprite.speed == -1.0 { 1.0 } else { sprite.speed };
    if speed == 0.0 || !sprite.is(flag::ORIENTED) {
        return None;
    }
    let block = f64::from(step.state.block);
    step.shifted(slot, sprite.orientation, (speed * block) as i32).filter(|&aim| aim != sprite.rect)
}

/// Moves a sprite where it, or its player, wants to go. A speed of 0 stands for the sprite's own.
#[inline]
pub(crate) fn active(step: &mut Step<'_>, slot: Slot, direction: Direction, speed: f64) -> Movement {
    let sprite = step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if traits.continuous {
        return accelerate(step, slot, direction, speed);
    }
    let block = f64::from(step.state.block);
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

/// Continuous physics: a force changes orientation and speed; the next passive movement moves.
fn accelerate(step: &mut Step<'_>, slot: Slot, force: Direction, speed: f64) -> Movement {
    let sprite = *step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let speed = if speed == 0.0 || speed == -1.0 { sprite.speed } else { speed };
    // The reference rounds the mass to 32 bits on the way.
    let mass = f64::from(traits.mass as f32);
    let velocity = Direction {
        x: force.x / mass + sprite.orientation.x * speed,
        y: force.y / mass + sprite.orientation.y * speed,
    };
    let length = (velocity.x * velocity.x + velocity.y * velocity.y).sqrt();
    let limited = if traits.max_speed == -1.0 || length.is_nan() || length <= traits.max_speed {
        length
    } else {
        traits.max_speed
    };
    let sprite = step.state.edit(slot);
    sprite.orientation = velocity.normalised();
    sprite.speed = limited;
    if force == Direction::NONE { Movement::Still } else { Movement::Move }
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

/// Distance of top-left corners: Manhattan on the grid, Euclidean in continuous physics.
pub(crate) fn distance(continuous: bool, a: Rect, b: Rect) -> f64 {
    let (dx, dy) = (f64::from(a.x) - f64::from(b.x), f64::from(a.y) - f64::from(b.y));
    if continuous { (dy * dy + dx * dx).sqrt() } else { dy.abs() + dx.abs() }
}
