//! Sprites that make sprites (`spec/02` §8).

use super::{base, stays};
use crate::chance::Chance;
use crate::game::{Limit, SpriteType};
use crate::geometry::Direction;
use crate::ontology::physics;
use crate::ontology::traits::Traits;
use crate::state::{Slot, Sprite, State};
use crate::step::Step;

/// SpawnPoint and Bomber: a draw in every update; a sprite when the tick and the draw allow it.
pub(super) fn spawn_point(step: &mut Step<'_>, slot: Slot) {
    let stype = step.state.sprite(slot).spawns;
    produce(step, slot, &[stype]);
}

/// SpawnPointMultiSprite: one of each.
pub(super) fn multi_sprite(step: &mut Step<'_>, slot: Slot) {
    let stypes = &step.rules.types[step.state.sprite(slot).stype.index()].traits.stypes;
    produce(step, slot, stypes);
}

/// If all that a SpawnPoint or a Bomber does in this tick is to draw, as most do in most ticks: the chance after that.
#[inline]
pub(crate) fn idle(sprite: &Sprite, traits: &Traits, state: &State) -> Option<Chance> {
    let lives = traits.total <= 0 || sprite.count < traits.total;
    if !lives || sprite.start == -1 || !stays(sprite, traits, state) {
        return None;
    }
    let mut chance = state.chance;
    let draw = f64::from(chance.float());
    let waits = || traits.cooldown != 1 && sprite.start.wrapping_add(state.tick) % traits.cooldown != 0;
    (draw >= traits.prob || waits()).then_some(chance)
}

fn produce(step: &mut Step<'_>, slot: Slot, stypes: &[SpriteType]) {
    let tick = step.state.tick;
    if step.state.sprite(slot).start == -1 {
        step.state.edit(slot).start = tick;
    }
    let draw = f64::from(step.state.chance.float());
    let sprite = step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    if sprite.start.wrapping_add(tick) % traits.cooldown == 0 && draw < traits.prob {
        let sprite = *sprite;
        for &stype in stypes {
            let Some(made) = step.add(stype, sprite.rect.x, sprite.rect.y) else { continue };
            step.state.edit_motion(slot).count += 1;
            let new = step.state.edit(made);
            if traits.spawn_orientation != Direction::NONE {
                new.orientation = traits.spawn_orientation;
            } else if new.orientation == Direction::NONE {
                new.orientation = sprite.orientation;
            }
        }
    }
    base(step, slot);
    if traits.total > 0 && step.state.sprite(slot).count >= traits.total {
        step.kill(slot);
    }
}

/// Moves at random, then does what a spawn point does, where it now stands.
pub(super) fn random_bomber(step: &mut Step<'_>, slot: Slot) {
    let direction = Direction::BASE[step.state.chance.below(4) as usize];
    let speed = step.state.sprite(slot).speed;
    physics::active(step, slot, direction, speed);
    spawn_point(step, slot);
}

/// Draws what it would make, in every update.
pub(super) fn bomber_random_missile(step: &mut Step<'_>, slot: Slot) {
    let count = step.rules.types[step.state.sprite(slot).stype.index()].traits.stypes.len();
    if count == 0 {
        return step.stop(Limit::NoType);
    }
    let drawn = step.state.chance.below(count as i32) as usize;
    let stype = step.state.missile(step.rules, slot, drawn);
    if step.state.sprite(slot).spawns != stype {
        step.state.edit(slot).spawns = stype;
    }
    spawn_point(step, slot);
}
