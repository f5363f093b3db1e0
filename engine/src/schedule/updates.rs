//! Updates of the sprites in a tick. Updates that change nothing are skipped: idle types, waiting sprites, and
//! producers that only draw random numbers.

use super::sleep::{Shortcuts, mark};
use super::{Foresight, Step};
use crate::numbers::chance::DRAW;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::traits::Traits;
use crate::rules::{Rules, SpriteType};
use crate::tick::sprites::{self, npcs};
use crate::world::{NONE, Slot, Sprite, World, flag};

/// Returns `true` if [`sprites::base`] has no effect on a sprite in this tick, because the sprite does not
/// move by itself or its cooldown has not passed.
#[inline]
fn stays(sprite: &Sprite, traits: &Traits, world: &World) -> bool {
    let stands =
        || world.overrides_of(sprite).speed == 0.0 && !sprite.is(flag::FIRST_TICK) && !traits.continuous;
    sprite.time_to_live < 0
        && (traits.is_static || traits.only_active || stands() || waits(sprite, traits, world))
}

/// Returns `true` if a sprite's cooldown has not passed, so that it does not move on its own.
#[inline]
fn waits(sprite: &Sprite, traits: &Traits, world: &World) -> bool {
    let age = world.tick().wrapping_sub(sprite.moved_at);
    traits.cooldown > age && !sprite.is(flag::FIRST_TICK | flag::FROZEN) && !traits.continuous
}

/// A type whose sprites can do something in their updates, such as move, spawn or turn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    stype: SpriteType,
    class: SpriteClass,
    /// The type's position in the order in which types are updated.
    order: i32,
    update_kind: UpdateKind,
    /// `true` if sprites of the type may fly or sleep, which means that their updates are skipped.
    may_fly: bool,
    /// For producers, the bound below which a draw creates a sprite: see [`threshold`].
    threshold: i32,
}

/// The way in which a type's updates start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum UpdateKind {
    /// The update makes a random draw. If no sprite is created, only [`sprites::base`] follows.
    Draws,
    /// The update consists of [`sprites::base`] alone.
    Moves,
    /// The sprite drifts and chooses a direction. While waiting, it only chooses a direction.
    Chooses,
    Other,
}

/// Returns the way in which a type's updates start.
fn update_kind(class: SpriteClass, traits: &Traits) -> UpdateKind {
    use ClassFamily as Family;
    use SpriteClass as C;
    match (class, class.family()) {
        _ if traits.oriented_image => UpdateKind::Other,
        (C::SpawnPoint | C::Bomber, _) => UpdateKind::Draws,
        (_, Family::Thing | Family::Resource) => UpdateKind::Moves,
        (C::SpriteProducer | C::Missile | C::ErraticMissile, _) => UpdateKind::Moves,
        (_, Family::Npc) if !traits.rotate_in_place => UpdateKind::Chooses,
        (_, Family::Flicker | Family::Missile | Family::Npc | Family::Walker | Family::Producer) => {
            UpdateKind::Other
        }
        (_, Family::Avatar) => UpdateKind::Other,
    }
}

/// Returns the types whose sprites can do something in their updates, in update order.
pub(super) fn movers(rules: &Rules, shortcuts: &[Shortcuts]) -> Vec<Mover> {
    let mover = |&stype: &SpriteType| {
        let info = &rules.types[stype.index()];
        let (class, order) = info.updated()?;
        Some(Mover {
            stype,
            class,
            order,
            update_kind: update_kind(class, &info.traits),
            may_fly: shortcuts[stype.index()].flies,
            threshold: threshold(info.traits.prob),
        })
    };
    rules.order.iter().rev().filter_map(mover).collect()
}

/// Returns the bound for a producer's draws, as an integer with [`DRAW`] bits. A draw below this bound is
/// below the producer's probability.
fn threshold(prob: f64) -> i32 {
    // Scaling by a power of two is exact. No draw is at or above NaN.
    let scaled = (prob * f64::from(1 << DRAW)).ceil();
    if scaled.is_nan() { i32::MAX } else { scaled as i32 }
}

/// Starting at `slot`, skips the SpawnPoints and Bombers that merely make a draw in this tick, which is the
/// most frequent case. Returns the first sprite that does more.
fn pass_over(world: &mut World, traits: &Traits, threshold: i32, mut slot: Slot) -> Slot {
    let mut chance = world.chance();
    while slot != NONE {
        let sprite = world.own(slot);
        let lives = traits.total <= 0 || sprite.count < traits.total;
        let moves = || sprite.activity & mark::SKIPPED == 0 && !stays(sprite, traits, world);
        if !lives || !sprite.is(flag::STARTED) || moves() {
            break;
        }
        let mut drawn = chance;
        let misses = drawn.next(DRAW) >= threshold;
        let waits = || {
            let start = world.overrides_of(sprite).start;
            traits.cooldown != 1 && start.wrapping_add(world.tick()) % traits.cooldown != 0
        };
        if !misses && !waits() {
            break;
        }
        chance = drawn;
        slot = sprite.next;
    }
    *world.dice() = chance;
    slot
}

/// Updates all sprites except the avatar.
pub(super) fn update_all(step: &mut Step<'_, Foresight<'_>>) {
    let (rules, plan) = (step.rules, step.scheduler.plan);
    for mover in &plan.movers {
        let group = step.world.group(mover.stype);
        let (head, count) = (group.head, group.count);
        let skipped = step.scheduler.schedule.skipped_of(mover.stype);
        if !step.start_type(mover.order, mover.stype) {
            if step.stopped.is_some() {
                return;
            }
            continue;
        }
        if skipped == count && mover.update_kind != UpdateKind::Draws {
            continue;
        }
        let traits = &rules.types[mover.stype.index()].traits;
        let mut slot = head;
        while slot != NONE {
            if mover.update_kind == UpdateKind::Draws {
                slot = pass_over(step.world, traits, mover.threshold, slot);
                if slot == NONE {
                    break;
                }
            }
            if !is_done(step, slot, mover, traits) {
                update_one(step, slot, mover, traits);
            }
            if step.stopped.is_some() {
                return;
            }
            slot = step.world.own(slot).next;
        }
    }
}

/// Returns `true` if nothing is left to do for a sprite's update in this tick.
#[inline(always)]
fn is_done(step: &mut Step<'_, Foresight<'_>>, slot: Slot, mover: &Mover, traits: &Traits) -> bool {
    let sprite = step.world.own(slot);
    match mover.update_kind {
        UpdateKind::Moves => {
            mover.may_fly && sprite.activity & mark::SKIPPED != 0 || stays(sprite, traits, step.world)
        }
        UpdateKind::Chooses => {
            let waits = waits(sprite, traits, step.world);
            if waits {
                npcs::choose(step, slot, mover.class);
            }
            waits
        }
        UpdateKind::Draws => {
            if sprite.flies() {
                step.land_before_update(slot);
            }
            false
        }
        UpdateKind::Other => mover.may_fly && sprite.activity & mark::SKIPPED != 0,
    }
}

#[inline(always)]
fn update_one(step: &mut Step<'_, Foresight<'_>>, slot: Slot, mover: &Mover, traits: &Traits) {
    if mover.update_kind == UpdateKind::Moves {
        step.updating_id = step.world.own(slot).id;
        sprites::base(step, slot);
    } else {
        step.update_sprite(slot, mover.class, traits.oriented_image);
    }
    let moved = mover.may_fly && step.scheduler.flies && !step.world.own(slot).is_back();
    *step.world.activity(slot) = if moved { mark::MOVED } else { mark::NOTHING };
    step.scheduler.any_moved |= moved;
}

#[cfg(test)]
mod tests {
    use super::threshold;
    use crate::numbers::chance::{Chance, DRAW};

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
