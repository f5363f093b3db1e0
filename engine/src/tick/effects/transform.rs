//! Effects that turn sprites into sprites of other types (`spec/03` §5.8, §7.5, §8.5).

use crate::limits::EFFECT_WORK;
use crate::numbers::geometry::Direction;
use crate::rules::effects::TransformIfCount;
use crate::rules::{Limit, SpriteType};
use crate::tick::{Scheduler, Step};
use crate::world::{Held, NONE, Slot, flag};
use smallvec::SmallVec;

pub(super) fn to(
    step: &mut Step<'_, impl Scheduler>,
    one: Slot,
    victim: Option<Slot>,
    stype: SpriteType,
    force: bool,
) {
    if step.world.sprite(one).is(flag::DISABLED) {
        return;
    }
    let rect = step.world.sprite(one).rect;
    if let Some(new) = step.add(stype, rect.x, rect.y) {
        hand_over(step, one, new, victim, force);
    }
}

/// Transforms every sprite of exactly this type, even into singletons.
pub(super) fn all(
    step: &mut Step<'_, impl Scheduler>,
    victim: Option<Slot>,
    stype: SpriteType,
    to: SpriteType,
    force: bool,
) {
    if stype == to && step.world.group(stype).head != NONE {
        return step.stop(Limit::EndlessTransform);
    }
    step.work(EFFECT_WORK * usize::from(step.world.group(stype).count));
    let mut slot = step.world.group(stype).head;
    while slot != NONE {
        let rect = step.world.sprite(slot).rect;
        if let Some(new) = step.add_forced(to, rect.x, rect.y) {
            hand_over(step, slot, new, victim, force);
        }
        slot = step.world.sprite(slot).next;
    }
}

/// Transforms the sprite into one of `options`, drawn at random: the ancestors and descendants of the rule's `stype` in
/// the SpriteSet. Without options, nothing happens. If the drawn type has no class, the effect only logs a message.
pub(super) fn random_child(
    step: &mut Step<'_, impl Scheduler>,
    one: Slot,
    victim: Option<Slot>,
    options: &[SpriteType],
    force: bool,
) {
    if options.is_empty() {
        return;
    }
    let drawn = options[step.world.dice().below(options.len() as i32) as usize];
    if step.rules.types[drawn.index()].class.is_none() {
        return step.message();
    }
    let rect = step.world.sprite(one).rect;
    if let Some(new) = step.add(drawn, rect.x, rect.y) {
        hand_over(step, one, new, victim, force);
    }
}

/// Transforms the sprite depending on a type's number of sprites, including killed and disabled sprites.
pub(super) fn if_count(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    two: Slot,
    rule: &TransformIfCount,
) {
    if rule.counted == SpriteType::NONE {
        return step.stop(Limit::NoType);
    }
    step.work(step.rules.types[rule.counted.index()].tree.len());
    let count = step.world.count(step.rules, rule.counted);
    let met = (rule.at_least..=rule.at_most).contains(&count);
    step.apply_score(index, met);
    step.apply_count(index, met);
    step.apply_count_else(index, !met && rule.otherwise.is_some());
    let Some(stype) = (if met { Some(rule.stype) } else { rule.otherwise }) else { return };
    let rect = step.world.sprite(one).rect;
    if let Some(new) = step.add_forced(stype, rect.x, rect.y) {
        hand_over(step, one, new, Some(two).filter(|_| rule.kill_second), rule.force_orientation);
    }
}

/// Turns all sprites of exactly `stype` into sprites of `other`, and then the first sprite into a sprite of `stype`.
pub(super) fn to_singleton(
    step: &mut Step<'_, impl Scheduler>,
    one: Slot,
    two: Slot,
    stype: SpriteType,
    other: SpriteType,
    take_orientation: bool,
) {
    if stype == other && step.world.group(stype).head != NONE {
        return step.stop(Limit::EndlessTransform);
    }
    step.work(EFFECT_WORK * usize::from(step.world.group(stype).count));
    let mut slot = step.world.group(stype).head;
    while slot != NONE {
        let rect = step.world.sprite(slot).rect;
        if let Some(new) = step.add(other, rect.x, rect.y) {
            inherit(step, slot, new);
        }
        slot = step.world.sprite(slot).next;
    }
    let rect = step.world.sprite(one).rect;
    if let Some(new) = step.add(stype, rect.x, rect.y) {
        inherit(step, one, new);
        if take_orientation {
            let facing = step.world.overrides(two).orientation.reversed();
            step.world.edit(new).set(flag::ORIENTED, true);
            step.world.face(new, facing);
        }
    }
}

/// Passes properties on like [`hand_over`], but always includes the orientation, and never the health.
fn inherit(step: &mut Step<'_, impl Scheduler>, old: Slot, new: Slot) {
    if step.world.sprite(old).is(flag::ORIENTED) && step.world.sprite(new).is(flag::ORIENTED) {
        step.world.face(new, step.world.overrides(old).orientation);
    }
    pass_on(step, old, new);
}

/// Passes on the old sprite's properties to the new sprite, and removes the old sprite.
fn hand_over(step: &mut Step<'_, impl Scheduler>, old: Slot, new: Slot, victim: Option<Slot>, force: bool) {
    let (before, after) = (*step.world.overrides(old), *step.world.overrides(new));
    let oriented = step.world.sprite(new).is(flag::ORIENTED) && step.world.sprite(old).is(flag::ORIENTED);
    if force || (oriented && after.orientation == Direction::NONE) {
        step.world.face(new, before.orientation);
    }
    if after.health != before.health {
        step.world.edit_overrides(new).health = before.health;
    }
    pass_on(step, old, new);
    if let Some(victim) = victim {
        step.remove(victim);
    }
}

/// Passes on the last rectangle, the resources and the player's control, and then removes the old sprite.
fn pass_on(step: &mut Step<'_, impl Scheduler>, old: Slot, new: Slot) {
    let before = *step.world.sprite(old);
    step.set_last(new, step.world.last(old));
    if !step.world.held().is_empty() {
        let held: SmallVec<[Held; 4]> = step.world.held_by(old).into();
        for Held { resource, amount, .. } in held {
            step.add_amount(new, resource, amount);
        }
    }
    // The player takes over the new sprite if it can be an avatar. Otherwise, the old avatar stays on the
    // board, disabled.
    let player_lost = before.is(flag::AVATAR) && !step.can_be_played(new);
    if before.is(flag::AVATAR) && !player_lost {
        if step.world.avatar() == NONE {
            // The reference would take the score and the player from an avatar that does not exist.
            return step.stop(Limit::NoAvatar);
        }
        step.control(new);
    }
    if player_lost {
        step.kill(old);
    } else {
        step.remove(old);
    }
}
