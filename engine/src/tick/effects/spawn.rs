//! Effects that create sprites (`spec/03` §7.4). They make their random draw first, even if the outcome is
//! certain.

use crate::rules::class::SpriteClass;
use crate::rules::effects::{SpawnIf, SpawnIfCounterSubTypes};
use crate::rules::{Limit, SpriteType};
use crate::tick::{Scheduler, Step};
use crate::world::{NONE, Slot};

pub(super) fn here(step: &mut Step<'_, impl Scheduler>, one: Slot, stype: SpriteType, prob: f64) {
    // A `prob` of NaN always spawns.
    if step.world.dice().double() >= prob {
        return;
    }
    let rect = step.world.sprite(one).rect;
    step.add(stype, rect.x, rect.y);
}

/// Executes spawnIfHasMore and spawnIfHasLess. Only spawnIfHasMore can spend the resource.
pub(super) fn if_amount(step: &mut Step<'_, impl Scheduler>, index: u16, one: Slot, rule: &SpawnIf) {
    let SpawnIf { resource, limit, stype, spend, prob, more } = *rule;
    step.apply_score(index, false);
    if step.world.dice().double() >= prob {
        return;
    }
    let amount = step.world.amount(one, resource);
    if if more { amount >= limit } else { amount <= limit } {
        let rect = step.world.sprite(one).rect;
        step.add(stype, rect.x, rect.y);
        step.apply_score(index, true);
        if more {
            step.add_amount(one, resource, spend.saturating_neg());
        }
    }
}

/// Executes spawnAbove, spawnBelow, spawnLeft and spawnRight, which spawn a sprite one block away from the
/// partner's position, or from its last position.
pub(super) fn beside(
    step: &mut Step<'_, impl Scheduler>,
    two: Slot,
    stype: SpriteType,
    shift: (i32, i32),
    step_back: bool,
    prob: f64,
) {
    if step.world.dice().double() >= prob {
        return;
    }
    let (rect, last) = (step.world.sprite(two).rect, step.world.last(two));
    if step_back && last.intersects(rect) {
        return;
    }
    let from = if step_back { last } else { rect };
    let block = step.world.block();
    let (x, y) = (from.x.wrapping_add(shift.0 * block), from.y.wrapping_add(shift.1 * block));
    step.add(stype, x, y);
}

/// Spawns a sprite at the partner's last position, if the partner has left it.
pub(super) fn behind(step: &mut Step<'_, impl Scheduler>, two: Slot, stype: SpriteType, prob: f64) {
    if step.world.dice().double() >= prob {
        return;
    }
    let (rect, last) = (step.world.sprite(two).rect, step.world.last(two));
    if !last.intersects(rect) {
        step.add(stype, last.x, last.y);
    }
}

pub(super) fn clone(step: &mut Step<'_, impl Scheduler>, one: Slot) {
    let sprite = step.world.sprite(one);
    step.add(sprite.stype, sprite.rect.x, sprite.rect.y);
}

/// Spawns a sprite of one of two types, depending on a third type's numbers of sprites and subtypes.
pub(super) fn if_counter_subtypes(
    step: &mut Step<'_, impl Scheduler>,
    index: u16,
    one: Slot,
    rule: &SpawnIfCounterSubTypes,
) {
    let SpawnIfCounterSubTypes { stype, otherwise, counted, limit, kinds } = *rule;
    let rules = step.rules;
    let rect = step.world.sprite(one).rect;
    let mut met = false;
    let tree = &rules.types[counted.index()].tree;
    step.work(tree.len());
    if step.world.count_live(rules, counted) == limit {
        step.work(tree.len() * tree.len());
        let alive = tree.iter().filter(|&&stype| step.world.count_live(rules, stype) > 0).count();
        met = (alive / 2) as i32 == kinds;
    }
    step.apply_score(index, met);
    step.apply_count(index, met);
    step.add(if met { stype } else { otherwise }, rect.x, rect.y);
}

/// Sets the type that spawn points of a type and of related types in the SpriteSet create. For spawn points that draw
/// from a list, replaces the partner's type in the list.
pub(super) fn update_type(
    step: &mut Step<'_, impl Scheduler>,
    partner: Option<Slot>,
    stype: SpriteType,
    spawn_point: SpriteType,
) {
    let rules = step.rules;
    for &family in &rules.types[spawn_point.index()].tree {
        let class = rules.types[family.index()].class;
        let is_spawner = class.is_some_and(|class| class.is_a(SpriteClass::SpawnPoint));
        step.work(usize::from(step.world.group(family).count));
        let mut slot = step.world.group(family).head;
        while slot != NONE && is_spawner {
            let Some(partner) = partner else { return step.stop(Limit::NoSprite) };
            step.world.edit_overrides(slot).spawns = stype;
            if class == Some(SpriteClass::BomberRandomMissile) {
                let before = step.world.sprite(partner).stype;
                step.world.replace_missile(rules, slot, before, stype);
            }
            slot = step.world.sprite(slot).next;
        }
    }
}
