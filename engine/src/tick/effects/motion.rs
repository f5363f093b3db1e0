//! Effects on position, orientation and speed (`spec/03` §7.3, §8.3, §8.4).

use crate::numbers::geometry::{Direction, Rect};
use crate::rules::class::SpriteClass;
use crate::rules::effects::SpeedChange;
use crate::rules::{Limit, SpriteType};
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::{NONE, Overrides, Slot, flag};

pub(super) fn step_back(step: &mut Step<'_, impl Scheduler>, one: Slot, flush_with: Option<Slot>) {
    let rect = match flush_with {
        Some(two) => pixel_perfect(step, one, two),
        None => step.world.last(one),
    };
    step.place(one, rect);
}

/// Returns the rectangle flush with the partner, on the side from which the sprite came. Returns the sprite's
/// last rectangle if the sprite did not move in exactly one of the four directions.
pub(super) fn pixel_perfect(step: &Step<'_, impl Scheduler>, one: Slot, two: Slot) -> Rect {
    let (sprite, other) = (step.world.sprite(one), step.world.sprite(two).rect);
    let last = step.world.last(one);
    let (now, before) = (sprite.rect.centre(), last.centre());
    let came = Direction { x: now.0 - before.0, y: now.1 - before.1 }.normalised();
    let rect = sprite.rect;
    match came {
        Direction::DOWN => rect.at(rect.x, other.y.wrapping_sub(rect.h)),
        Direction::RIGHT => rect.at(other.x.wrapping_sub(rect.w), rect.y),
        Direction::UP => rect.at(rect.x, other.y.wrapping_add(other.h)),
        Direction::LEFT => rect.at(other.x.wrapping_add(other.w), rect.y),
        _ => last,
    }
}

/// Moves every sprite of every updated type back to its last rectangle.
pub(super) fn undo_all(step: &mut Step<'_, impl Scheduler>, spare: &[SpriteType]) {
    let rules = step.rules;
    // All such sprites are moved back, and sprites of height 0 cannot be placed.
    let is_back = |stype: SpriteType| rules.types[stype.index()].order.is_some() && !spare.contains(&stype);
    if rules.first_differs {
        let mut types = (0..rules.types.len() as u16).map(SpriteType).filter(|&stype| is_back(stype));
        if types.any(|stype| step.world.slots(stype).any(|slot| step.world.last(slot).h == 0)) {
            return step.stop(Limit::FlatSprite);
        }
    }
    // Only sprites that moved in this tick are away from their last rectangle.
    step.work(step.world.moved().len());
    for at in 0..step.world.moved().len() {
        let slot = step.world.moved()[at];
        let last = step.world.last(slot);
        if is_back(step.world.sprite(slot).stype) {
            step.place(slot, last);
        }
    }
}

/// Moves the sprite back and then two steps down, and reverses its direction.
pub(super) fn turn_around(step: &mut Step<'_, impl Scheduler>, one: Slot) {
    let last = step.world.last(one);
    let cooldown = step.rules.types[step.world.sprite(one).stype.index()].traits.cooldown;
    step.place(one, last);
    for _ in 0..2 {
        step.set_age(one, cooldown);
        // With continuous physics, the first of the two steps changes the speed of the second.
        let speed = step.world.overrides(one).speed;
        physics::active(step, one, Direction::DOWN, speed);
    }
    reverse(step, one);
}

pub(super) fn reverse(step: &mut Step<'_, impl Scheduler>, one: Slot) {
    let overrides = step.world.edit_overrides(one);
    overrides.orientation = overrides.orientation.reversed();
}

pub(super) fn flip(step: &mut Step<'_, impl Scheduler>, one: Slot) {
    let drawn = Direction::BASE[step.world.dice().below(4) as usize];
    step.world.face(one, drawn);
}

/// Moves the sprite to the opposite edge along its orientation, on one axis only.
pub(super) fn wrap_around(step: &mut Step<'_, impl Scheduler>, one: Slot, offset: f64) {
    let screen = step.world.screen();
    let (facing, rect) = (step.world.overrides(one).orientation, step.world.sprite(one).rect);
    let near = |size: i32| (offset * f64::from(size)) as i32;
    let far = |edge: i32, size: i32| (f64::from(edge) - f64::from(size) * (1.0 + offset)) as i32;
    let to = if facing.x > 0.0 {
        rect.at(near(rect.w), rect.y)
    } else if facing.x < 0.0 {
        rect.at(far(screen.w, rect.w), rect.y)
    } else if facing.y > 0.0 {
        rect.at(rect.x, near(rect.h))
    } else if facing.y < 0.0 {
        rect.at(rect.x, far(screen.h, rect.h))
    } else {
        rect
    };
    step.place(one, to);
    step.set_age(one, 0);
}

pub(super) fn align(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot, orient: bool) {
    let other = *step.world.sprite(two);
    if orient {
        step.world.face(one, step.world.overrides(two).orientation);
    }
    let rect = step.world.sprite(one).rect.at(other.rect.x, other.rect.y);
    step.place(one, rect);
}

pub(super) fn attract_gaze(
    step: &mut Step<'_, impl Scheduler>,
    one: Slot,
    two: Slot,
    align: bool,
    prob: f64,
) {
    let other = *step.world.sprite(two);
    if !step.world.sprite(one).is(flag::ORIENTED) || !other.is(flag::ORIENTED) {
        return;
    }
    if step.world.dice().double() >= prob {
        return;
    }
    let facing = step.world.overrides(two).orientation;
    step.world.face(one, facing);
    if align {
        let rect = step.world.sprite(one).rect;
        let sideways = facing == Direction::LEFT || facing == Direction::RIGHT;
        let to = if sideways { rect.at(rect.x, other.rect.y) } else { rect.at(other.rect.x, rect.y) };
        step.place(one, to);
    }
}

/// Makes the random draw of attractGaze without its consequences.
pub(super) fn draw_gaze(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot) {
    if step.world.sprite(one).is(flag::ORIENTED) && step.world.sprite(two).is(flag::ORIENTED) {
        step.world.dice().double();
    }
}

/// Pushes the sprite. The sprite moves in the direction of the partner's move in this tick, and turns to face
/// that direction.
pub(super) fn bounce_forward(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot) {
    let moved = step.last_direction(two);
    let &Overrides { orientation: facing, speed, .. } = step.world.overrides(two);
    let mut push = moved.normalised();
    if moved.x * facing.x < 0.0 {
        push.x = -push.x;
    }
    if moved.y * facing.y < 0.0 {
        push.y = -push.y;
    }
    physics::active(step, one, push, speed);
    step.world.face(one, push);
}

/// Carries the sprite along with its partner, once per tick.
pub(super) fn pull_with_it(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    two: Slot,
    onto: bool,
) {
    let Some(others) = step.world.pull(index, one) else { return };
    step.work(others / 64);
    let direction = step.last_direction(two).normalised();
    let amount = (step.world.overrides(two).speed * physics::grid_size(step, one)) as i32;
    step.displace(one, direction, amount);
    if step.rules.types[step.world.sprite(one).stype.index()].traits.off_grid {
        let (rect, carrier) = (step.world.sprite(one).rect, step.world.sprite(two).rect);
        step.place(one, rect.at(rect.x, carrier.y.wrapping_sub(carrier.h)));
        step.world.edit_overrides(one).orientation.y = 0.0;
    }
    if onto {
        let rect = step.world.sprite(two).rect;
        step.place(one, rect);
    }
}

/// Moves the sprite to a random exit, which is a sprite of the partner's exit type. Kills the sprite if there
/// is no exit.
pub(super) fn teleport(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot) {
    let Some(exit_type) = exit_of(step, two) else { return step.message() };
    let count = step.world.group(exit_type).count;
    if count == 0 {
        return step.kill(one);
    }
    step.work(usize::from(count));
    let drawn = step.world.dice().below(i32::from(count));
    let exit = step.world.slots(exit_type).nth(drawn as usize).expect("the drawn index is below the count");
    let (exit, facing) = (*step.world.sprite(exit), step.world.overrides(exit).orientation);
    step.place(one, exit.rect);
    step.set_age(one, 0);
    if exit.is(flag::ORIENTED) {
        step.world.face(one, facing);
    }
}

/// Makes the random draw of teleportToExit without its consequences.
pub(super) fn draw_exit(step: &mut Step<'_, impl Scheduler>, two: Slot) {
    let count = exit_of(step, two).map_or(0, |exit_type| step.world.group(exit_type).count);
    if count > 0 {
        step.world.dice().below(i32::from(count));
    }
}

/// Returns the exit type to which a sprite leads; `None` if it leads nowhere.
fn exit_of(step: &Step<'_, impl Scheduler>, two: Slot) -> Option<SpriteType> {
    let info = &step.rules.types[step.world.sprite(two).stype.index()];
    let spawns = info.class.is_some_and(|class| class.is_a(SpriteClass::SpawnPoint));
    // A spawner leads to the type that it currently creates.
    let leads_to = if spawns { Some(step.world.overrides(two).spawns) } else { info.leads_to() };
    leads_to.filter(|&stype| stype != SpriteType::NONE)
}

pub(super) fn change_speed(
    step: &mut Step<'_, impl Scheduler>,
    stype: SpriteType,
    value: f64,
    how: SpeedChange,
) {
    let rules = step.rules;
    for &stype in &rules.types[stype.index()].tree {
        step.work(usize::from(step.world.group(stype).count));
        let mut slot = step.world.group(stype).head;
        while slot != NONE {
            let overrides = step.world.edit_overrides(slot);
            overrides.speed = match how {
                SpeedChange::Increase => overrides.speed + value,
                SpeedChange::Decrease if overrides.speed - value < 0.0 => 0.0,
                SpeedChange::Decrease => overrides.speed - value,
                SpeedChange::Set => value,
            };
            slot = step.world.sprite(slot).next;
        }
    }
}
