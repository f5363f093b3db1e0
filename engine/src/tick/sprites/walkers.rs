//! Walkers: characters that follow the ground and turn at walls (`spec/02` §7.6).

use crate::numbers::geometry::Direction;
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::{Overrides, Slot, flag};

pub(super) fn walker(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    physics::passive(step, slot);
    let sprite = step.world.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if traits.air_steering || sprite.rect.x == step.world.last(slot).x {
        let ahead = step.world.overrides(slot).orientation.x;
        let x = if ahead > 0.0 {
            1.0
        } else if ahead < 0.0 {
            -1.0
        } else {
            [-1.0, 1.0][step.world.dice().below(2) as usize]
        };
        let direction = Direction { x, y: 0.0 };
        step.world.face(slot, direction);
        physics::active(step, slot, direction, traits.max_speed);
    }
    if step.world.overrides(slot).speed.to_bits() != traits.max_speed.to_bits() {
        step.world.edit_overrides(slot).speed = traits.max_speed;
    }
    step.world.edit_motion(slot).set(flag::ON_GROUND, false);
}

/// Updates a WalkerJumper, which jumps occasionally. The reference does not use the game's random number
/// generator for this decision.
pub(super) fn walker_jumper(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    physics::passive(step, slot);
    let sprite = *step.world.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if sprite.is(flag::ON_GROUND) && traits.probability > step.world.second_dice().double() {
        jump(step, slot, traits.jump_strength);
    } else {
        let &Overrides { orientation, speed, .. } = step.world.overrides(slot);
        physics::active(step, slot, orientation, speed);
    }
    step.world.edit_motion(slot).set(flag::ON_GROUND, false);
}

/// Makes a sprite jump upwards and leave the ground immediately.
pub(crate) fn jump(step: &mut Step<'_, impl Scheduler>, slot: Slot, strength: f64) {
    let overrides = step.world.edit_overrides(slot);
    overrides.orientation.y = 0.0;
    let speed = overrides.speed;
    physics::active(step, slot, Direction { x: 0.0, y: -strength }, speed);
    let cooldown = step.rules.types[step.world.sprite(slot).stype.index()].traits.cooldown;
    step.set_age(slot, cooldown);
    step.displace(slot, Direction::UP, 5);
}
