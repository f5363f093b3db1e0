//! Effects of continuous physics at walls and paddles (`spec/03` §5.11, §5.12, §8.3, §9).

use super::motion::pixel_perfect;
use crate::numbers::geometry::{Direction, Rect};
use crate::numbers::trigonometry::{cos, sin};
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::{Overrides, Partners, Slot};

/// Returns a sprite's intended displacement per tick, in pixels rightwards and downwards.
fn velocity(step: &Step<'_, impl Scheduler>, slot: Slot) -> Direction {
    let &Overrides { orientation, speed, .. } = step.world.overrides(slot);
    Direction { x: orientation.x * speed, y: orientation.y * speed }
}

/// Returns two flags for a collision with a rectangle. The first is `true` for a collision from the side, and
/// the second for a collision from above or below. Both or neither may be `true`.
fn collision(step: &Step<'_, impl Scheduler>, one: Slot, other: Rect) -> (bool, bool) {
    let rect = step.world.sprite(one).rect;
    let overlap = |a: i32, a_size: i32, b: i32, b_size: i32| {
        a.wrapping_add(a_size).min(b.wrapping_add(b_size)).wrapping_sub(a.max(b))
    };
    let horizontal = rect.h == overlap(rect.y, rect.h, other.y, other.h);
    let vertical = rect.w == overlap(rect.x, rect.w, other.x, other.w);
    if horizontal || vertical {
        return (horizontal, vertical);
    }
    let (velocity, last) = (velocity(step, one), step.world.last(one));
    let time = |last: i32, size: i32, from: i32, extent: i32, velocity: f64| {
        let gap = if velocity > 0.0 {
            last.wrapping_add(size).wrapping_sub(from)
        } else if velocity < 0.0 {
            from.wrapping_add(extent).wrapping_sub(last)
        } else {
            last.wrapping_sub(from)
        };
        (f64::from(gap.wrapping_abs()) / velocity).abs()
    };
    let across = time(last.x, rect.w, other.x, other.w, velocity.x);
    let along = time(last.y, rect.h, other.y, other.h, velocity.y);
    (across < along, along < across)
}

/// Returns the number of partners to collide with, and the rectangle that they cover. The rectangle covers
/// two aligned partners if there are any, and the closest partner otherwise.
fn joined(step: &Step<'_, impl Scheduler>, one: Slot, partners: &mut Partners) -> (i32, Rect) {
    let rect = |slot: Slot| step.world.sprite(slot).rect;
    if let [first, second] = partners[..] {
        let (a, b) = (rect(first), rect(second));
        if a.centre().0 == b.centre().0 {
            return (2, Rect { x: a.x, y: a.y.min(b.y), w: a.w, h: a.h.wrapping_mul(2) });
        }
        if a.centre().1 == b.centre().1 {
            return (2, Rect { x: a.x.min(b.x), y: a.y, w: a.w.wrapping_mul(2), h: a.h });
        }
    }
    if partners.len() > 1 {
        let own = step.world.last(one).centre();
        let distance = |slot: &Slot| {
            let centre = step.world.last(*slot).centre();
            let (x, y) = (centre.0 - own.0, centre.1 - own.1);
            (x * x + y * y).sqrt()
        };
        partners.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    }
    (1, rect(partners[0]))
}

/// Moves all participants of the collision back to their last rectangles.
fn separate(step: &mut Step<'_, impl Scheduler>, one: Slot, partners: &[Slot]) {
    for &slot in std::iter::once(&one).chain(partners) {
        let last = step.world.last(slot);
        step.place(slot, last);
    }
}

fn reflect(step: &mut Step<'_, impl Scheduler>, one: Slot, wall: Rect) {
    let (horizontal, vertical) = collision(step, one, wall);
    let facing = &mut step.world.edit_overrides(one).orientation;
    if vertical {
        facing.y = -facing.y;
    } else if horizontal {
        facing.x = -facing.x;
    } else {
        *facing = facing.reversed();
    }
}

pub(super) fn bounce_batch(step: &mut Step<'_, impl Scheduler>, one: Slot, partners: &mut Partners) -> i32 {
    let (count, wall) = joined(step, one, partners);
    reflect(step, one, wall);
    separate(step, one, partners);
    count
}

pub(super) fn bounce(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot) {
    if step.world.gravity(step.rules, one) > 0.0 {
        physics::active(step, one, Direction::UP, 0.0);
    }
    let wall = step.world.sprite(two).rect;
    reflect(step, one, wall);
    separate(step, one, &[two]);
}

/// Reduces the velocity to `rest`, with gravity as the minimum speed.
fn slow(step: &mut Step<'_, impl Scheduler>, one: Slot, rest: Direction) {
    let gravity = step.world.gravity(step.rules, one);
    let length = (rest.x * rest.x + rest.y * rest.y).sqrt();
    let overrides = step.world.edit_overrides(one);
    overrides.orientation = rest.normalised();
    overrides.speed *= length;
    if overrides.speed < gravity {
        overrides.speed = gravity;
    }
}

fn turn_back(step: &mut Step<'_, impl Scheduler>, one: Slot, wall: Rect) {
    let (_, vertical) = collision(step, one, wall);
    let ahead = step.world.overrides(one).orientation.x;
    slow(step, one, Direction { x: if vertical { ahead } else { -ahead }, y: 0.0 });
}

pub(super) fn reverse_batch(step: &mut Step<'_, impl Scheduler>, one: Slot, partners: &mut Partners) -> i32 {
    let (count, wall) = joined(step, one, partners);
    turn_back(step, one, wall);
    separate(step, one, partners);
    count
}

pub(super) fn reverse(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot) {
    let wall = step.world.sprite(two).rect;
    turn_back(step, one, wall);
    separate(step, one, &[two]);
}

/// Places the sprite flush with the wall, and lets the sprite continue along the wall.
pub(super) fn stop(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot) {
    let rect = pixel_perfect(step, one, two);
    step.place(one, rect);
    let (own, wall) = (step.world.sprite(one).rect.centre(), step.world.sprite(two).rect.centre());
    let facing = step.world.overrides(one).orientation;
    let beside = (own.0 - wall.0).abs() > (own.1 - wall.1).abs();
    let rest = if beside { Direction { x: 0.0, y: facing.y } } else { Direction { x: facing.x, y: 0.0 } };
    slow(step, one, rest);
}

/// Bounces the sprite off a paddle. The further the sprite is to one side of the paddle's centre, the more it
/// bounces to that side.
pub(super) fn bounce_direction(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot, most: f64) {
    let (ball, paddle) = (*step.world.sprite(one), step.world.sprite(two).rect);
    let (velocity, last) = (velocity(step, one), step.world.last(one));
    let gap = |last: i32, size: i32, from: i32, extent: i32| {
        let before = last.wrapping_sub(from.wrapping_add(extent)).wrapping_abs();
        let after = last.wrapping_add(size).wrapping_sub(from).wrapping_abs();
        f64::from(before.min(after))
    };
    let across = (gap(last.x, ball.rect.w, paddle.x, paddle.w) / velocity.x).abs();
    let along = (gap(last.y, ball.rect.h, paddle.y, paddle.h) / velocity.y).abs();
    let (own, other) = (ball.rect.centre(), paddle.centre());
    let share = |distance: f64, size: i32| (distance / (0.5 * f64::from(size))).clamp(-1.0, 1.0);
    let facing = if along < across {
        let side = if own.1 < other.1 { 1.0 } else { -1.0 };
        let angle = share(own.0 - other.0, paddle.w) * most;
        Direction { x: sin(angle), y: -cos(angle) * side }
    } else if across < along {
        let side = if own.0 > other.0 { 1.0 } else { -1.0 };
        let angle = share(other.1 - own.1, paddle.h) * most;
        Direction { x: cos(angle) * side, y: -sin(angle) }
    } else {
        let facing = &mut step.world.edit_overrides(one).orientation;
        facing.x = -facing.x;
        return;
    };
    step.world.edit_overrides(one).orientation = facing.normalised();
}
