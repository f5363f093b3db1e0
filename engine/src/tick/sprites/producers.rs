//! Sprites that make sprites (`spec/02` §8).

use super::{base, stays};
use crate::chance::DRAW;
use crate::geometry::Direction;
use crate::rules::traits::Traits;
use crate::rules::{Limit, SpriteType};
use crate::schedule::mark;
use crate::tick::Step;
use crate::tick::physics;
use crate::world::{NONE, Overrides, Slot, World, flag};

/// SpawnPoint and Bomber: one draw per update, and a sprite when the tick and the draw allow it.
pub(super) fn spawn_point(step: &mut Step<'_>, slot: Slot) {
    let stype = step.world.overrides(slot).spawns;
    produce(step, slot, &[stype]);
}

/// SpawnPointMultiSprite: one sprite of each type.
pub(super) fn multi_sprite(step: &mut Step<'_>, slot: Slot) {
    let stypes = &step.rules.types[step.world.sprite(slot).stype.index()].traits.stypes;
    produce(step, slot, stypes);
}

/// The bound of a producer's draws, as a number of [`DRAW`] bits: draws below it are below the producer's probability.
pub(crate) fn threshold(prob: f64) -> i32 {
    // Scaling by a power of two is exact. No draw is at or above NaN.
    let scaled = (prob * f64::from(1 << DRAW)).ceil();
    if scaled.is_nan() { i32::MAX } else { scaled as i32 }
}

/// Skips SpawnPoints and Bombers, from `slot` on, that only draw in this tick, the most frequent case. Returns the first
/// one that does more.
pub(crate) fn pass_over(world: &mut World, traits: &Traits, threshold: i32, mut slot: Slot) -> Slot {
    let mut chance = world.chance;
    while slot != NONE {
        let sprite = world.sprite(slot);
        let lives = traits.total <= 0 || sprite.count < traits.total;
        let moves = || sprite.activity & mark::SKIPPED == 0 && !stays(sprite, traits, world);
        if !lives || !sprite.is(flag::STARTED) || moves() {
            break;
        }
        let mut drawn = chance;
        let misses = drawn.next(DRAW) >= threshold;
        let waits = || {
            let start = world.overrides_of(sprite).start;
            traits.cooldown != 1 && start.wrapping_add(world.tick) % traits.cooldown != 0
        };
        if !misses && !waits() {
            break;
        }
        chance = drawn;
        slot = sprite.next;
    }
    world.chance = chance;
    slot
}

fn produce(step: &mut Step<'_>, slot: Slot, stypes: &[SpriteType]) {
    let tick = step.world.tick;
    if !step.world.sprite(slot).is(flag::STARTED) {
        step.world.edit_overrides(slot).start = tick;
        step.world.edit(slot).set(flag::STARTED, true);
    }
    let draw = f64::from(step.world.chance.float());
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

/// Moves at random, then acts as a spawn point at its new place.
pub(super) fn random_bomber(step: &mut Step<'_>, slot: Slot) {
    let direction = Direction::BASE[step.world.chance.below(4) as usize];
    let speed = step.world.overrides(slot).speed;
    physics::active(step, slot, direction, speed);
    spawn_point(step, slot);
}

/// Draws the type that it would make in every update.
pub(super) fn bomber_random_missile(step: &mut Step<'_>, slot: Slot) {
    let count = step.rules.types[step.world.sprite(slot).stype.index()].traits.stypes.len();
    if count == 0 {
        return step.stop(Limit::NoType);
    }
    let drawn = step.world.chance.below(count as i32) as usize;
    let stype = step.world.missile(step.rules, slot, drawn);
    if step.world.overrides(slot).spawns != stype {
        step.world.edit_overrides(slot).spawns = stype;
    }
    spawn_point(step, slot);
}

#[cfg(test)]
mod tests {
    use super::threshold;
    use crate::chance::{Chance, DRAW};

    #[test]
    fn thresholds_are_probabilities() {
        let probabilities = [
            f64::NAN,
            f64::NEG_INFINITY,
            -0.1,
            0.0,
            1e-300,
            0.01,
            0.5,
            0.999_999_99,
            1.0,
            7.0,
            f64::INFINITY,
        ];
        for prob in probabilities.into_iter().chain([1.0, 2.0, 3.0].map(|draws| draws / f64::from(1 << DRAW)))
        {
            for seed in 0..2000 {
                let (mut one, mut two) = (Chance::from_java(seed), Chance::from_java(seed));
                assert_eq!(
                    f64::from(one.float()) >= prob,
                    two.next(DRAW) >= threshold(prob),
                    "{prob}, {seed}"
                );
            }
            for draw in [0, 1, 2, 3, (1 << DRAW) - 1] {
                let float = draw as f32 / (1 << DRAW) as f32;
                assert_eq!(f64::from(float) >= prob, draw >= threshold(prob), "{prob}, {draw}");
            }
        }
    }
}
