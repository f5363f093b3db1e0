//! Missiles and flickers (`spec/02` §6).

use super::base;
use crate::numbers::geometry::Direction;
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::Slot;

pub(super) fn random_missile(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    if step.world.overrides(slot).orientation == Direction::NIL {
        let drawn = Direction::BASE[step.world.dice().below(4) as usize];
        step.world.face(slot, drawn);
    }
    physics::passive(step, slot);
}

/// Updates a flicker, and kills it if its age exceeds the limit.
pub(super) fn flicker(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    base(step, slot);
    let sprite = step.world.sprite(slot);
    if sprite.count > step.rules.types[sprite.stype.index()].traits.limit {
        step.kill(slot);
    }
    let sprite = step.world.edit_motion(slot);
    sprite.count = sprite.count.wrapping_add(1);
}

/// Updates a flicker that spreads in its second update. Spreading always makes four random draws.
pub(super) fn spreader(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    flicker(step, slot);
    let (sprite, last) = (*step.world.sprite(slot), step.world.last(slot));
    if sprite.count != 2 {
        return;
    }
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let stype = traits.stypes.first().copied().unwrap_or(sprite.stype);
    for direction in Direction::BASE {
        if step.world.dice().double() < traits.spread_probability {
            let at = |corner: i32, component: f64, size: i32| {
                (f64::from(corner) + component * f64::from(size)) as i32
            };
            let x = at(last.x, direction.x, last.w);
            let y = at(last.y, direction.y, last.h);
            step.add(stype, x, y);
        }
    }
}
