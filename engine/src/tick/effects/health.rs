//! Effects on health points (`spec/03` §7.2).

use crate::rules::{Limit, SpriteType, memory};
use crate::tick::{Scheduler, Step};
use crate::world::{NONE, Slot};

/// Executes addHealthPoints and addHealthPointsToMax. addHealthPoints never reaches the limit, and
/// addHealthPointsToMax stops at the limit.
pub(super) fn add(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    victim: Option<Slot>,
    value: i32,
    to_max: bool,
) {
    let sprite = step.world.sprite(one);
    let limit = step.rules.types[sprite.stype.index()].traits.limit_health;
    let health = step.world.overrides_of(sprite).health.wrapping_add(value);
    if !to_max && health >= limit {
        return step.apply_score(index, false);
    }
    step.apply_score(index, true);
    let overrides = step.world.edit_overrides(one);
    overrides.health = health.min(limit);
    overrides.max_health = overrides.max_health.max(overrides.health);
    if let Some(two) = victim {
        step.kill(two);
    }
}

/// Executes subtractHealthPoints on the first sprite of the last non-empty group in the tree of `stype`. Without a
/// `stype`, or if all groups are empty, the effect acts on `one`. If the effect kills the sprite, `scoreChangeIfKilled`
/// replaces `scoreChange`.
pub(super) fn subtract(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    value: i32,
    limit: i32,
    stype: Option<SpriteType>,
) {
    if stype == Some(SpriteType::NONE) {
        return step.stop(Limit::NoType);
    }
    let target = stype.and_then(|stype| last_of(step, stype)).unwrap_or(one);
    let overrides = step.world.edit_overrides(target);
    overrides.health = overrides.health.wrapping_sub(value);
    let killed = overrides.health <= limit;
    step.world.remember(index, memory::KILLED, killed);
    if killed {
        step.kill(target);
    }
}

/// Returns the first sprite of the last non-empty group in a type's tree; `None` if all groups are empty.
pub(super) fn last_of(step: &Step<'_, impl Scheduler>, stype: SpriteType) -> Option<Slot> {
    let tree = step.rules.types.get(stype.index()).map_or(&[][..], |info| &info.tree);
    let groups = tree.iter().map(|&stype| step.world.group(stype).head);
    groups.rev().find(|&head| head != NONE)
}
