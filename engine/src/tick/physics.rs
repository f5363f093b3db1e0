//! Grid and continuous physics (`spec/02` §3).

use crate::numbers::geometry::{Direction, Rect};
use crate::rules::Rules;
use crate::tick::{Scheduler, Step};
use crate::world::{Overrides, Slot, flag};

/// The result of an active movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Movement {
    Still,
    Rotate,
    Move,
}

/// Returns the grid cell size, in pixels, that the sprite's physics uses. For continuous physics, the size is
/// a constant.
pub(crate) fn grid_size(step: &Step<'_, impl Scheduler>, slot: Slot) -> f64 {
    if is_continuous(step.rules, step, slot) { 10.0 } else { f64::from(step.world.block()) }
}

fn is_continuous(rules: &Rules, step: &Step<'_, impl Scheduler>, slot: Slot) -> bool {
    rules.types[step.world.sprite(slot).stype.index()].traits.continuous
}

/// Moves a sprite along its own orientation, unless the sprite is static. The first call only clears the
/// sprite's first-tick flag.
#[inline]
pub(crate) fn passive(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let sprite = step.world.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if traits.is_static || traits.only_active {
        return;
    }
    if sprite.is(flag::FIRST_TICK) {
        step.world.edit_motion(slot).set(flag::FIRST_TICK, false);
        return;
    }
    if traits.continuous {
        let &Overrides { orientation, speed, .. } = step.world.overrides_of(sprite);
        if speed == 0.0 {
            return;
        }
        step.displace(slot, orientation, speed as i32);
        let gravity = step.world.gravity(step.rules, slot);
        if gravity > 0.0 && traits.mass > 0.0 && !step.world.sprite(slot).is(flag::ON_GROUND) {
            active(step, slot, Direction { x: 0.0, y: gravity * traits.mass }, 0.0);
        }
        if traits.friction != 0.0 {
            step.world.edit_overrides(slot).speed *= 1.0 - traits.friction;
        }
        return;
    }
    if !sprite.is(flag::ORIENTED) {
        return;
    }
    let &Overrides { orientation, speed, .. } = step.world.overrides_of(sprite);
    let speed = if speed == -1.0 { 1.0 } else { speed };
    if speed != 0.0 {
        let block = f64::from(step.world.block());
        step.displace(slot, orientation, (speed * block) as i32);
    }
}

/// Returns the rectangle after passive movement with grid physics, or `None` if the sprite does not move.
pub(crate) fn aim(step: &Step<'_, impl Scheduler>, slot: Slot) -> Option<Rect> {
    let sprite = step.world.sprite(slot);
    let &Overrides { orientation, speed, .. } = step.world.overrides_of(sprite);
    let speed = if speed == -1.0 { 1.0 } else { speed };
    if speed == 0.0 || !sprite.is(flag::ORIENTED) {
        return None;
    }
    let block = f64::from(step.world.block());
    step.shifted(slot, orientation, (speed * block) as i32).filter(|&aim| aim != sprite.rect)
}

/// Moves a sprite in the direction that the sprite or the player has chosen. A speed of 0 stands for the
/// sprite's own speed.
#[inline]
pub(crate) fn active(
    step: &mut Step<'_, impl Scheduler>,
    slot: Slot,
    direction: Direction,
    speed: f64,
) -> Movement {
    let sprite = step.world.own(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if traits.continuous {
        return accelerate(step, slot, direction, speed);
    }
    let block = f64::from(step.world.block());
    if traits.stationary || direction == Direction::NONE {
        return Movement::Still;
    }
    let speed = match speed {
        0.0 => match step.world.overrides_of(sprite).speed {
            own if own <= 0.0 => 1.0,
            own => own,
        },
        speed => speed,
    };
    if traits.rotate_in_place && turn(step, slot, direction) {
        return Movement::Rotate;
    }
    if step.displace(slot, direction, (speed * block) as i32) { Movement::Move } else { Movement::Still }
}

/// Moves a sprite like [`active`], along one of [`Direction::BASE`].
#[inline(always)]
pub(crate) fn active_along(
    step: &mut Step<'_, impl Scheduler>,
    slot: Slot,
    base: usize,
    speed: f64,
) -> Movement {
    let sprite = step.world.own(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let pixels = (speed * f64::from(step.world.block())) as i32;
    if traits.continuous || traits.stationary || traits.rotate_in_place || pixels == 0 {
        return active(step, slot, Direction::BASE[base], speed);
    }
    if step.displace_along(slot, base, pixels) { Movement::Move } else { Movement::Still }
}

/// Applies a force in continuous physics. The force changes the orientation and the speed, but only the next
/// passive movement moves the sprite.
fn accelerate(step: &mut Step<'_, impl Scheduler>, slot: Slot, force: Direction, speed: f64) -> Movement {
    let &Overrides { orientation, speed: own, .. } = step.world.overrides(slot);
    let traits = &step.rules.types[step.world.own(slot).stype.index()].traits;
    let speed = if speed == 0.0 || speed == -1.0 { own } else { speed };
    // The reference rounds the mass to 32 bits in this calculation.
    let mass = f64::from(traits.mass as f32);
    let velocity =
        Direction { x: force.x / mass + orientation.x * speed, y: force.y / mass + orientation.y * speed };
    let length = (velocity.x * velocity.x + velocity.y * velocity.y).sqrt();
    let limited = if traits.max_speed == -1.0 || length.is_nan() || length <= traits.max_speed {
        length
    } else {
        traits.max_speed
    };
    let overrides = step.world.edit_overrides(slot);
    overrides.orientation = velocity.normalised();
    overrides.speed = limited;
    if force == Direction::NONE { Movement::Still } else { Movement::Move }
}

/// Changes the orientation of an oriented sprite if the new orientation is different. Returns `true` if the
/// orientation changed.
#[inline(always)]
pub(crate) fn turn(step: &mut Step<'_, impl Scheduler>, slot: Slot, direction: Direction) -> bool {
    let sprite = step.world.own(slot);
    if !sprite.is(flag::ORIENTED) || step.world.overrides_of(sprite).orientation == direction {
        return false;
    }
    step.world.turn_to(slot, direction);
    true
}

/// Returns the distance between the top-left corners: the Manhattan distance with grid physics, and the
/// Euclidean distance with continuous physics.
pub(crate) fn distance(continuous: bool, a: Rect, b: Rect) -> f64 {
    let (dx, dy) = (f64::from(a.x) - f64::from(b.x), f64::from(a.y) - f64::from(b.y));
    if continuous { (dy * dy + dx * dx).sqrt() } else { dy.abs() + dx.abs() }
}
