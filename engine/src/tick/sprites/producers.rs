//! Sprites that create sprites (`spec/02` §8).

use super::base;
use crate::numbers::geometry::Direction;
use crate::rules::{Limit, SpriteType};
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::{Overrides, Slot, flag};

/// Updates a SpawnPoint or Bomber. Makes one random draw per update, and creates a sprite if the tick and
/// the draw allow it.
pub(super) fn spawn_point(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let stype = step.world.overrides(slot).spawns;
    produce(step, slot, &[stype]);
}

/// Updates a SpawnPointMultiSprite, which creates one sprite of each type.
pub(super) fn multi_sprite(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let stypes = &step.rules.types[step.world.sprite(slot).stype.index()].traits.stypes;
    produce(step, slot, stypes);
}

fn produce(step: &mut Step<'_, impl Scheduler>, slot: Slot, stypes: &[SpriteType]) {
    let tick = step.world.tick();
    if !step.world.sprite(slot).is(flag::STARTED) {
        step.world.edit_overrides(slot).start = tick;
        step.world.edit(slot).set(flag::STARTED, true);
    }
    let draw = f64::from(step.world.dice().float());
    let sprite = step.world.sprite(slot);
    let &Overrides { start, orientation, .. } = step.world.overrides_of(sprite);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if start.wrapping_add(tick) % traits.cooldown == 0 && draw < traits.prob {
        let (x, y) = (sprite.rect.x, sprite.rect.y);
        for &stype in stypes {
            let Some(made) = step.add(stype, x, y) else { continue };
            step.world.edit_motion(slot).count += 1;
            if traits.spawn_orientation != Direction::NONE {
                step.world.face(made, traits.spawn_orientation);
            } else if step.world.overrides(made).orientation == Direction::NONE {
                step.world.face(made, orientation);
            }
        }
    }
    base(step, slot);
    if traits.total > 0 && step.world.sprite(slot).count >= traits.total {
        step.kill(slot);
    }
}

/// Moves a RandomBomber at random, then updates it as a spawn point at its new position.
pub(super) fn random_bomber(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let direction = Direction::BASE[step.world.dice().below(4) as usize];
    let speed = step.world.overrides(slot).speed;
    physics::active(step, slot, direction, speed);
    spawn_point(step, slot);
}

/// Updates a BomberRandomMissile, which draws the type of its next missile in every update.
pub(super) fn bomber_random_missile(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let count = step.rules.types[step.world.sprite(slot).stype.index()].traits.stypes.len();
    if count == 0 {
        return step.stop(Limit::NoType);
    }
    let drawn = step.world.dice().below(count as i32) as usize;
    let stype = step.world.missile(step.rules, slot, drawn);
    if step.world.overrides(slot).spawns != stype {
        step.world.edit_overrides(slot).spawns = stype;
    }
    spawn_point(step, slot);
}
