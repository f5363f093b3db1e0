//! What the player's sprite does with the player's action (`spec/02` §9).

use super::class::SpriteClass;
use crate::game::{Action, SpriteType};
use crate::geometry::Direction;
use crate::ontology::physics::{self, Movement};
use crate::state::{Slot, flag};
use crate::step::Step;

/// The update of the player's avatar, before all other sprites.
pub(crate) fn update(step: &mut Step<'_>, slot: Slot, action: Action) {
    use SpriteClass as C;
    let stype = step.state.sprite(slot).stype;
    let class = step.rules.types[stype.index()].class.expect("an avatar has a class");
    let direction = match action {
        Action::Up => Direction::UP,
        Action::Left => Direction::LEFT,
        Action::Down => Direction::DOWN,
        Action::Right => Direction::RIGHT,
        Action::Nil | Action::Use => Direction::NONE,
    };
    match class {
        C::FlakAvatar => {
            if moving(step, slot, direction) == Movement::Still && action == Action::Use {
                flak(step, slot);
            }
        }
        C::OrientedAvatar => {
            oriented(step, slot, direction);
        }
        C::ShootAvatar => {
            if oriented(step, slot, direction) == Movement::Still && action == Action::Use {
                shoot(step, slot);
            }
        }
        C::OngoingAvatar | C::OngoingShootAvatar => {
            if direction != Direction::NONE {
                physics::turn(step, slot, direction);
            }
            physics::passive(step, slot);
            if class == C::OngoingShootAvatar && action == Action::Use {
                shoot(step, slot);
            }
        }
        C::MissileAvatar => physics::passive(step, slot),
        _ => {
            moving(step, slot, direction);
        }
    }
}

fn moving(step: &mut Step<'_>, slot: Slot, direction: Direction) -> Movement {
    let speed = step.state.sprite(slot).speed;
    physics::active(step, slot, direction, speed)
}

/// Faces where it went.
fn oriented(step: &mut Step<'_>, slot: Slot, direction: Direction) -> Movement {
    let movement = moving(step, slot, direction);
    if movement == Movement::Move {
        let facing = step.last_direction(slot).normalised();
        step.state.edit(slot).orientation = facing;
    }
    movement
}

/// Shoots from its own corner, if it has ammunition; the shot keeps its own orientation.
fn flak(step: &mut Step<'_>, slot: Slot) {
    let sprite = *step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let ammo = traits.ammo.first().copied();
    if let Some(ammo) = ammo {
        let amount = step.state.amount(slot, ammo);
        let least = if traits.min_ammo > -1 { traits.min_ammo } else { 0 };
        if amount <= least {
            return;
        }
    }
    if let Some(shot) = step.add(traits.stypes[0], sprite.rect.x, sprite.rect.y) {
        if let Some(ammo) = ammo {
            spend(step, slot, ammo, traits.ammo_cost);
        }
        step.state.edit(shot).set(flag::FROM_AVATAR, true);
    }
}

/// The reference stores the difference as it is: ammunition may go below 0.
fn spend(step: &mut Step<'_>, slot: Slot, ammo: SpriteType, cost: i32) {
    let held = step.state.held.iter_mut().find(|held| held.holder == slot && held.resource == ammo);
    if let Some(held) = held {
        held.amount = held.amount.saturating_sub(cost);
    }
}

/// Shoots the first kind of shot that it has ammunition for, one body length ahead.
fn shoot(step: &mut Step<'_>, slot: Slot) {
    let sprite = *step.state.sprite(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let ready = traits.stypes.iter().enumerate().find(|(kind, _)| match traits.ammo.get(*kind) {
        Some(&ammo) => step.state.amount(slot, ammo) > 0,
        None => true,
    });
    let Some((kind, &stype)) = ready else { return };
    let facing = sprite.orientation.normalised();
    let ahead =
        |corner: i32, component: f64, size: i32| (f64::from(corner) + component * f64::from(size)) as i32;
    let x = ahead(sprite.rect.x, facing.x, sprite.last.w);
    let y = ahead(sprite.rect.y, facing.y, sprite.last.h);
    if let Some(shot) = step.add(stype, x, y) {
        if let Some(&ammo) = traits.ammo.get(kind) {
            step.state.add_amount(slot, ammo, -1);
        }
        let new = step.state.edit(shot);
        if new.is(flag::ORIENTED) {
            new.orientation = facing;
        }
        new.set(flag::FROM_AVATAR, true);
    }
}
