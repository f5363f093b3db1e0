//! Effects on resources (`spec/03` §8.2).

use crate::rules::class::SpriteClass;
use crate::rules::{Limit, SpriteType};
use crate::tick::{Scheduler, Step};
use crate::world::Slot;

/// Returns a resource sprite's type, value and limit, or `None` if the sprite is not a resource.
fn resource_of(step: &mut Step<'_, impl Scheduler>, slot: Slot) -> Option<(SpriteType, i32, i32)> {
    let info = &step.rules.types[step.world.sprite(slot).stype.index()];
    let resource = info.traits.resource;
    if !info.traits.is_resource {
        return None;
    }
    if resource == SpriteType::NONE || !info.class.is_some_and(|class| class.is_a(SpriteClass::Resource)) {
        step.stop(Limit::UnfitSprite);
        return None;
    }
    Some((resource, info.traits.value, step.rules.types[resource.index()].resource_limit))
}

/// Adds the resource to the partner's holdings, up to the limit. If the sprite is not a resource, nothing
/// changes, not even the effect's memory.
pub(super) fn collect(step: &mut Step<'_, impl Scheduler>, index: u16, one: Slot, two: Slot, kill: bool) {
    let Some((resource, value, limit)) = resource_of(step, one) else { return };
    let amount = step.world.amount(two, resource);
    step.apply_score(index, amount < limit);
    if amount < limit {
        step.add_amount(two, resource, value.min(limit.wrapping_sub(amount)));
        if kill {
            step.remove(one);
        }
    }
}

/// Adds the resource to the partner's holdings if the partner holds enough of another resource. The collected
/// sprite disappears even if the holdings are at their limit.
pub(super) fn collect_if_held(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    two: Slot,
    (held, value): (SpriteType, i32),
    kill: bool,
) {
    let Some((resource, worth, limit)) = resource_of(step, one) else { return };
    step.apply_score(index, false);
    if step.world.amount(two, held) < value {
        return;
    }
    if step.world.amount(two, resource).wrapping_add(worth) <= limit {
        step.add_amount(two, resource, worth);
        step.apply_score(index, true);
    }
    if kill {
        step.kill(one);
    }
}

/// Changes the amount that the sprite holds, if the limit allows it.
pub(super) fn change(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    two: Slot,
    (resource, value): (SpriteType, i32),
    kill: bool,
) {
    let Some(info) = step.rules.types.get(resource.index()) else { return step.stop(Limit::NoType) };
    let fits = step.world.amount(one, resource).wrapping_add(value) <= info.resource_limit;
    step.apply_score(index, fits);
    if fits {
        step.add_amount(one, resource, value);
        if kill {
            step.remove(two);
        }
    }
}
