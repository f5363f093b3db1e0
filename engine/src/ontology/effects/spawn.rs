//! Effects that make sprites (`spec/03` §7.4). The draw comes first, also where the outcome is certain.

use super::Effect;
use crate::game::SpriteType;
use crate::state::Slot;
use crate::step::Step;

pub(super) fn here(step: &mut Step<'_>, one: Slot, stype: SpriteType, prob: f64) {
    if step.state.chance.double() < prob {
        let rect = step.state.sprite(one).rect;
        step.add(stype, rect.x, rect.y);
    }
}

/// spawnIfHasMore and spawnIfHasLess; only the former spends.
pub(super) fn if_amount(step: &mut Step<'_>, index: u16, one: Slot, effect: &Effect) {
    let Effect::SpawnIf { resource, limit, stype, spend, prob, more } = *effect else { return };
    step.apply_score(index, false);
    if step.state.chance.double() >= prob {
        return;
    }
    let amount = step.state.amount(one, resource);
    if if more { amount >= limit } else { amount <= limit } {
        let rect = step.state.sprite(one).rect;
        step.add(stype, rect.x, rect.y);
        step.apply_score(index, true);
        if more {
            step.state.add_amount(one, resource, spend.saturating_neg());
        }
    }
}

/// spawnAbove, spawnBelow, spawnLeft, spawnRight: a block beside the partner, or beside where it came from.
pub(super) fn beside(
    step: &mut Step<'_>,
    two: Slot,
    stype: SpriteType,
    shift: (i32, i32),
    step_back: bool,
    prob: f64,
) {
    if step.state.chance.double() >= prob {
        return;
    }
    let sprite = step.state.sprite(two);
    if step_back && sprite.last.intersects(sprite.rect) {
        return;
    }
    let from = if step_back { sprite.last } else { sprite.rect };
    let block = step.state.block;
    step.add(stype, from.x + shift.0 * block, from.y + shift.1 * block);
}

/// Where the partner was, if it has left that place.
pub(super) fn behind(step: &mut Step<'_>, two: Slot, stype: SpriteType, prob: f64) {
    if step.state.chance.double() >= prob {
        return;
    }
    let sprite = step.state.sprite(two);
    if !sprite.last.intersects(sprite.rect) {
        step.add(stype, sprite.last.x, sprite.last.y);
    }
}

pub(super) fn clone(step: &mut Step<'_>, one: Slot) {
    let sprite = step.state.sprite(one);
    step.add(sprite.stype, sprite.rect.x, sprite.rect.y);
}
