//! Effects on resources (`spec/03` §8.2).

use crate::game::SpriteType;
use crate::state::Slot;
use crate::step::Step;

/// The partner takes the resource, up to its limit. On a sprite that is no resource nothing happens, not even to what
/// the effect remembers.
pub(super) fn collect(step: &mut Step<'_>, index: u16, one: Slot, two: Slot, kill: bool) {
    let resource = step.state.sprite(one).stype;
    let info = &step.rules.types[resource.index()];
    if !info.traits.is_resource {
        return;
    }
    let room = info.resource_limit - step.state.amount(two, resource);
    step.apply_score(index, room > 0);
    if room > 0 {
        step.state.add_amount(two, resource, info.traits.value.min(room));
        if kill {
            step.remove(one);
        }
    }
}

/// The partner takes the resource if it holds enough of another; it goes even where there is no room.
pub(super) fn collect_if_held(
    step: &mut Step<'_>,
    index: u16,
    one: Slot,
    two: Slot,
    (held, value): (SpriteType, i32),
    kill: bool,
) {
    let resource = step.state.sprite(one).stype;
    let info = &step.rules.types[resource.index()];
    if !info.traits.is_resource {
        return;
    }
    step.apply_score(index, false);
    if step.state.amount(two, held) < value {
        return;
    }
    if step.state.amount(two, resource) + info.traits.value <= info.resource_limit {
        step.state.add_amount(two, resource, info.traits.value);
        step.apply_score(index, true);
    }
    if kill {
        step.kill(one);
    }
}

/// Changes what the sprite holds, if the limit allows.
pub(super) fn change(
    step: &mut Step<'_>,
    index: u16,
    one: Slot,
    two: Slot,
    (resource, value): (SpriteType, i32),
    kill: bool,
) {
    let limit = step.rules.types[resource.index()].resource_limit;
    let fits = step.state.amount(one, resource).saturating_add(value) <= limit;
    step.apply_score(index, fits);
    if fits {
        step.state.add_amount(one, resource, value);
        if kill {
            step.remove(two);
        }
    }
}
