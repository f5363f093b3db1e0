//! The avatar: the sprite that the player controls, and its reactions to actions (`spec/02` §9).

use super::sprites::walkers::jump;
use crate::numbers::geometry::Direction;
use crate::numbers::trigonometry::{cos, sin};
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::traits::BLOCK_PAUSE;
use crate::rules::{Action, SpriteType};
use crate::tick::physics::{self, Movement};
use crate::tick::{Scheduler, Step};
use crate::world::{Slot, flag};

/// Updates the player's avatar, before all other sprites.
pub(crate) fn update(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    use SpriteClass as C;
    let stype = step.world.own(slot).stype;
    let class = step.rules.types[stype.index()].class.expect("an avatar has a class");
    let direction = base(action).map_or(Direction::NONE, |base| Direction::BASE[base]);
    use ClassFamily as Family;
    match (class, class.family()) {
        (C::FlakAvatar, _) => {
            if moving(step, slot, action) == Movement::Still && action == Action::Use {
                flak(step, slot);
            }
        }
        (C::OrientedAvatar, _) => {
            oriented(step, slot, action);
        }
        (C::ShootAvatar, _) => shooting(step, slot, action),
        (C::ShootOnlyAvatar, _) => shoot_only(step, slot, action),
        (C::OngoingAvatar | C::OngoingShootAvatar, _) => {
            if direction != Direction::NONE {
                physics::turn(step, slot, direction);
            }
            physics::passive(step, slot);
            if class == C::OngoingShootAvatar && action == Action::Use {
                shoot(step, slot);
            }
        }
        (C::OngoingTurningAvatar, _) => ongoing_turning(step, slot, direction),
        (C::MissileAvatar, _) => physics::passive(step, slot),
        (C::AimedAvatar, _) => aimed(step, slot, action),
        (C::SpaceshipAvatar, _) => spaceship(step, slot, action),
        (C::CarAvatar, _) => car(step, slot, action),
        (C::LanderAvatar, _) => lander(step, slot, action),
        (C::BirdAvatar, _) => bird(step, slot, action),
        (C::PlatformerAvatar, _) => {
            platformer(step, slot, direction, action);
            step.world.edit_motion(slot).set(flag::ON_GROUND, false);
        }
        (C::WizardAvatar, _) => wizard(step, slot, direction, action),
        (_, Family::Avatar) => {
            moving(step, slot, action);
        }
        // A parameter can turn sprites of other classes into avatars.
        (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => {
            moving(step, slot, action);
        }
        (_, Family::Npc | Family::Walker | Family::Producer) => {
            moving(step, slot, action);
        }
    }
}

/// Returns an action's direction, as an index into [`Direction::BASE`]; `None` for actions without a direction.
fn base(action: Action) -> Option<usize> {
    match action {
        Action::Up => Some(0),
        Action::Left => Some(1),
        Action::Down => Some(2),
        Action::Right => Some(3),
        Action::Nil | Action::Use => None,
    }
}

fn is_off_grid(step: &Step<'_, impl Scheduler>, slot: Slot) -> bool {
    step.rules.types[step.world.own(slot).stype.index()].traits.off_grid
}

/// Moves the avatar passively, unless it has grid physics.
fn glide(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    if is_off_grid(step, slot) {
        physics::passive(step, slot);
    }
}

#[inline(always)]
fn moving(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) -> Movement {
    glide(step, slot);
    let speed = step.world.overrides(slot).speed;
    match base(action) {
        Some(base) => physics::active_along(step, slot, base, speed),
        None => physics::active(step, slot, Direction::NONE, speed),
    }
}

/// Moves the avatar, and turns it to face the direction of the move.
#[inline(always)]
fn oriented(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) -> Movement {
    let movement = moving(step, slot, action);
    if movement == Movement::Move && !is_off_grid(step, slot) {
        let facing = step.last_direction(slot).normalised();
        step.world.face(slot, facing);
    }
    movement
}

fn shooting(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    if oriented(step, slot, action) == Movement::Still && action == Action::Use {
        shoot(step, slot);
    }
}

/// Shoots from the avatar's corner if the avatar has ammunition. The shot keeps its own orientation.
fn flak(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let sprite = *step.world.own(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let ammo = traits.ammo.first().copied();
    if let Some(ammo) = ammo {
        let amount = step.world.amount(slot, ammo);
        let least = if traits.min_ammo > -1 { traits.min_ammo } else { 0 };
        if amount <= least {
            return;
        }
    }
    if let Some(shot) =
        step.add(traits.stypes.first().copied().unwrap_or(SpriteType::NONE), sprite.rect.x, sprite.rect.y)
    {
        if let Some(ammo) = ammo {
            // The reference does not limit the remaining ammunition, so it may drop below 0.
            step.world.overdraw(slot, ammo, traits.ammo_cost);
        }
        step.world.edit(shot).set(flag::FROM_AVATAR, true);
    }
}

/// Shoots the first type of shot for which the avatar has ammunition. The shot appears one body length ahead.
fn shoot(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    let facing = step.world.overrides(slot).orientation.normalised();
    shoot_towards(step, slot, facing);
}

fn shoot_towards(step: &mut Step<'_, impl Scheduler>, slot: Slot, facing: Direction) {
    let kinds = step.rules.types[step.world.own(slot).stype.index()].traits.stypes.len();
    let ready = (0..kinds).find(|&kind| is_loaded(step, slot, kind));
    if let Some(kind) = ready {
        shoot_kind(step, slot, kind, facing);
    }
}

fn is_loaded(step: &Step<'_, impl Scheduler>, slot: Slot, kind: usize) -> bool {
    let traits = &step.rules.types[step.world.own(slot).stype.index()].traits;
    traits.ammo.get(kind).is_none_or(|&ammo| step.world.amount(slot, ammo) > 0)
}

fn shoot_kind(step: &mut Step<'_, impl Scheduler>, slot: Slot, kind: usize, facing: Direction) {
    let sprite = *step.world.own(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let ahead =
        |corner: i32, component: f64, size: i32| (f64::from(corner) + component * f64::from(size)) as i32;
    let last = step.world.last(slot);
    let x = ahead(sprite.rect.x, facing.x, last.w);
    let y = ahead(sprite.rect.y, facing.y, last.h);
    if let Some(shot) = step.add(traits.stypes[kind], x, y) {
        if let Some(&ammo) = traits.ammo.get(kind) {
            step.add_amount(slot, ammo, -1);
        }
        let new = step.world.edit(shot);
        new.set(flag::FROM_AVATAR, true);
        if new.is(flag::ORIENTED) {
            step.world.face(shot, facing);
        }
    }
}

/// Shoots a different type of shot for each key, always in the same direction.
fn shoot_only(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    glide(step, slot);
    let kind = match action {
        Action::Left => 0,
        Action::Up => 1,
        Action::Right => 2,
        Action::Down => 3,
        Action::Use => 4,
        Action::Nil => return,
    };
    let sprite = *step.world.own(slot);
    let kinds = step.rules.types[sprite.stype.index()].traits.stypes.len();
    if kind < kinds && is_loaded(step, slot, kind) {
        shoot_kind(step, slot, kind, step.world.overrides(slot).orientation.normalised());
    }
}

/// Turns the avatar, but only by right angles, and leaves sprites behind.
fn ongoing_turning(step: &mut Step<'_, impl Scheduler>, slot: Slot, direction: Direction) {
    let facing = step.world.overrides(slot).orientation;
    if direction != Direction::NONE && direction.x * facing.x + direction.y * facing.y == 0.0 {
        physics::turn(step, slot, direction);
    }
    physics::passive(step, slot);
    let (rect, last) = (step.world.own(slot).rect, step.world.last(slot));
    if !rect.intersects(last) {
        step.add(step.world.overrides(slot).spawns, last.x, last.y);
    }
}

fn heading(angle: f64) -> Direction {
    Direction { x: cos(angle), y: sin(angle) }
}

/// Shoots twice, turns the aim up or down, and thrusts along the aim.
fn aimed(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    shooting(step, slot, action);
    if action == Action::Use {
        shoot(step, slot);
    }
    let diff = step.rules.types[step.world.own(slot).stype.index()].traits.angle_diff;
    let angle = match action {
        Action::Up => -diff,
        Action::Down => diff,
        _ => 0.0,
    };
    let Direction { x, y } = step.world.overrides(slot).orientation;
    let turned = Direction { x: x * cos(angle) - y * sin(angle), y: x * sin(angle) + y * cos(angle) };
    let rotation = libm::atan2(turned.y, turned.x);
    step.world.face(slot, turned);
    step.world.extra(step.rules, slot).rotation = rotation;
    thrust(step, slot, action);
}

/// Thrusts the avatar along its rotation, or against it.
fn thrust(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    let rotation = step.world.rotation(step.rules, step.world.own(slot));
    let speed = step.world.overrides(slot).speed;
    match action {
        Action::Up => physics::active(step, slot, heading(rotation), speed),
        Action::Down => physics::active(step, slot, heading(rotation + std::f64::consts::PI), speed),
        _ => Movement::Still,
    };
}

/// Changes the avatar's rotation if the left or right key is pressed.
fn steer(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    let diff = step.rules.types[step.world.own(slot).stype.index()].traits.angle_diff;
    let extra = step.world.extra(step.rules, slot);
    match action {
        Action::Left => extra.rotation -= diff,
        Action::Right => extra.rotation += diff,
        _ => {}
    }
}

fn spaceship(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    glide(step, slot);
    if action == Action::Use {
        let facing = heading(step.world.rotation(step.rules, step.world.own(slot)));
        shoot_towards(step, slot, facing);
        shoot_towards(step, slot, facing);
    }
    steer(step, slot, action);
    thrust(step, slot, action);
}

/// Drives forwards or backwards, always with the same thrust.
fn car(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    glide(step, slot);
    steer(step, slot, action);
    let extra = step.world.extra(step.rules, slot);
    match action {
        Action::Up => extra.facing.x = 0.0,
        Action::Down => extra.facing.x = 1.0,
        _ => {}
    }
    let angle = extra.rotation + extra.facing.x * std::f64::consts::PI;
    physics::active(step, slot, heading(angle), 5.0);
}

fn lander(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    glide(step, slot);
    steer(step, slot, action);
    if action == Action::Up {
        thrust(step, slot, action);
    }
}

fn bird(step: &mut Step<'_, impl Scheduler>, slot: Slot, action: Action) {
    oriented(step, slot, action);
    let overrides = *step.world.overrides(slot);
    let strength = step.rules.types[step.world.own(slot).stype.index()].traits.jump_strength;
    let push = if overrides.orientation.x.abs() < 0.5 { Direction::RIGHT } else { Direction::NONE };
    if action == Action::Use {
        step.world.edit_overrides(slot).orientation.y = 0.0;
        physics::active(step, slot, Direction { x: 0.0, y: -strength }, overrides.speed);
    }
    let speed = step.world.overrides(slot).speed;
    physics::active(step, slot, push, speed);
    let facing = step.world.overrides(slot).orientation;
    step.world.extra(step.rules, slot).rotation = libm::atan2(facing.y, facing.x);
}

/// Runs, and jumps if the last event phase detected ground.
fn platformer(step: &mut Step<'_, impl Scheduler>, slot: Slot, direction: Direction, action: Action) {
    glide(step, slot);
    let sprite = *step.world.own(slot);
    let traits = &step.rules.types[sprite.stype.index()].traits;
    let grounded = sprite.is(flag::ON_GROUND);
    if direction != Direction::NONE {
        let x =
            if grounded { direction.x * traits.ground_speedup } else { direction.x / traits.air_slowdown };
        let speed = step.world.overrides(slot).speed;
        physics::active(step, slot, Direction { x, y: direction.y }, speed);
    }
    if action == Action::Use && grounded {
        jump(step, slot, traits.jump_strength);
    }
}

/// Moves a wizard like a platformer, and places blocks in the direction that the wizard faces.
fn wizard(step: &mut Step<'_, impl Scheduler>, slot: Slot, direction: Direction, action: Action) {
    platformer(step, slot, direction, action);
    let rules = step.rules;
    let tick = step.world.tick();
    let ready = step.world.extra(rules, slot).block_time.wrapping_add(BLOCK_PAUSE) <= tick;
    if action == Action::Up && ready {
        physics::active(step, slot, Direction::DOWN, -1.0);
        let (sprite, last) = (*step.world.own(slot), step.world.last(slot));
        let facing = step.world.extra(rules, slot).facing;
        for &stype in &rules.types[sprite.stype.index()].traits.stypes {
            let x = f64::from(sprite.rect.x) + facing.x * f64::from(last.w) * 1.2;
            let y = f64::from(sprite.rect.y) + facing.y * f64::from(last.h);
            step.add(stype, x as i32, y as i32);
        }
        step.world.extra(rules, slot).block_time = tick;
    }
    match action {
        Action::Left => step.world.extra(rules, slot).facing = Direction::LEFT,
        Action::Right => step.world.extra(rules, slot).facing = Direction::RIGHT,
        _ => {}
    }
    step.world.edit_motion(slot).set(flag::ON_GROUND, false);
}
