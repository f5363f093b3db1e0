//! Effects that kill (`spec/03` §7.1, §8.1).

use crate::numbers::geometry::Direction;
use crate::rules::{Limit, SpriteType};
use crate::tick::{Scheduler, Step};
use crate::world::{NONE, Slot, flag};

/// Kills the sprite if `hit` is `true`. Only then does the score change.
pub(super) fn when(step: &mut Step<'_, impl Scheduler>, index: u16, one: Slot, hit: bool) {
    step.apply_score(index, hit);
    if hit {
        step.kill(one);
    }
}

/// Kills every sprite of exactly this type.
pub(super) fn all(step: &mut Step<'_, impl Scheduler>, stype: SpriteType) {
    step.work(usize::from(step.world.group(stype).count));
    let mut slot = step.world.group(stype).head;
    while slot != NONE {
        step.kill(slot);
        slot = step.world.sprite(slot).next;
    }
}

pub(super) fn if_from_above(step: &mut Step<'_, impl Scheduler>, index: u16, one: Slot, two: Slot) {
    let (second, last) = (step.world.sprite(two), step.world.last(two));
    let above = step.world.last(one).y > last.y.wrapping_add(second.rect.h / 2);
    let falling = second.rect.y > last.y;
    when(step, index, one, above && falling);
}

/// Executes killIfFrontal and killIfNotFrontal, which both kill a sprite that does not move.
pub(super) fn if_frontal(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    two: Slot,
    frontal: bool,
) {
    let (u, v) = (step.last_direction(one).normalised(), step.last_direction(two).normalised());
    let still = u == Direction::NONE;
    let head_on = u.x + v.x == 0.0 && u.y + v.y == 0.0;
    when(step, index, one, still || head_on == frontal);
}

/// Executes killIfFast and killIfSlow, which compare the moving sprite's speed or, if both sprites move, the
/// difference between their orientations.
pub(super) fn if_speed(step: &mut Step<'_, impl Scheduler>, one: Slot, two: Slot, limit: f64, fast: bool) {
    let (first, second) = (step.world.overrides(one), step.world.overrides(two));
    let is_static = |slot: Slot| step.rules.types[step.world.sprite(slot).stype.index()].traits.is_static;
    let speed = if is_static(one) {
        second.speed
    } else if is_static(two) {
        first.speed
    } else {
        let x = first.orientation.x - second.orientation.x;
        let y = first.orientation.y - second.orientation.y;
        (x * x + y * y).sqrt()
    };
    if if fast { speed > limit } else { speed < limit } {
        step.kill(one);
    }
}

/// Executes killIfNotUpright. A sprite is upright, with its nose up, at a rotation of about 3π/2.
pub(super) fn if_not_upright(step: &mut Step<'_, impl Scheduler>, one: Slot) {
    let full = 2.0 * std::f64::consts::PI;
    let rotation = (step.world.rotation(step.rules, step.world.sprite(one)) + full) % full;
    if !(rotation > 4.4 && rotation < 5.0) {
        step.kill(one);
    }
}

/// Sets scores to 0: either the sprite's own score if the sprite is the avatar, or the scores of all avatars
/// of a type.
pub(super) fn remove_score(
    step: &mut Step<'_, impl Scheduler>,
    one: Slot,
    victim: Option<Slot>,
    stype: Option<SpriteType>,
) {
    if stype == Some(SpriteType::NONE) {
        return step.stop(Limit::NoType);
    }
    let mut slot = stype.map_or(one, |stype| step.world.group(stype).head);
    while slot != NONE {
        step.work(1);
        if step.world.sprite(slot).is(flag::AVATAR) {
            // Each avatar has its own score, and that of the player's avatar is the game's score.
            if slot == step.world.avatar() {
                step.world.reset_score();
            }
            if let Some(victim) = victim {
                step.remove(victim);
            }
        }
        slot = if stype.is_some() { step.world.sprite(slot).next } else { NONE };
    }
}
