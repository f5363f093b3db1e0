//! The updates of sprites in a tick (`spec/02` §4–§8).

pub(crate) mod npcs;
mod plain;
pub(crate) mod producers;
pub(super) mod walkers;

use crate::rules::SpriteType;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::traits::Traits;
use crate::tick::Step;
use crate::tick::physics;
use crate::world::{Slot, Sprite, World, flag};

/// Tests whether [`base`] does nothing to a sprite in this tick: the sprite does not move by itself, or its cooldown has
/// not passed.
#[inline]
pub(crate) fn stays(sprite: &Sprite, traits: &Traits, world: &World) -> bool {
    let stands =
        || world.overrides_of(sprite).speed == 0.0 && !sprite.is(flag::FIRST_TICK) && !traits.continuous;
    sprite.time_to_live < 0
        && (traits.is_static || traits.only_active || stands() || waits(sprite, traits, world))
}

/// Tests whether a sprite does not move by itself because its cooldown has not passed.
#[inline]
pub(crate) fn waits(sprite: &Sprite, traits: &Traits, world: &World) -> bool {
    let age = world.tick.wrapping_sub(sprite.moved_at);
    traits.cooldown > age && !sprite.is(flag::FIRST_TICK | flag::FROZEN) && !traits.continuous
}

/// A type whose sprites have updates that do something.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    pub(crate) stype: SpriteType,
    pub(crate) class: SpriteClass,
    /// The place in the update order.
    pub(crate) order: i32,
    pub(crate) update_kind: UpdateKind,
    /// `true` if its sprites may fly or sleep.
    pub(crate) may_fly: bool,
    /// Producers: the bound of the draws with which they make something, see [`producers::threshold`].
    pub(crate) threshold: i32,
}

/// The start of a type's updates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UpdateKind {
    /// A draw; if no sprite is made, only [`base`] follows.
    Draws,
    /// [`base`], and nothing else.
    Moves,
    /// A drift, unless the sprite waits; then only the choice of a direction.
    Chooses,
    Other,
}

/// The kind of update of a type.
pub(crate) fn update_kind(class: SpriteClass, traits: &Traits) -> UpdateKind {
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

/// Updates a sprite. The avatar is updated in `avatars`.
pub(crate) fn update(step: &mut Step<'_>, slot: Slot, class: SpriteClass) {
    use SpriteClass as C;
    match class {
        C::Immovable | C::Door | C::Passive | C::Conveyor | C::Resource | C::ResourcePack => base(step, slot),
        C::Portal | C::SpriteProducer | C::Missile | C::ErraticMissile => base(step, slot),
        C::RandomMissile => plain::random_missile(step, slot),
        C::Flicker | C::OrientedFlicker => plain::flicker(step, slot),
        C::Spreader => plain::spreader(step, slot),
        C::RandomNPC
        | C::RandomInertial
        | C::Chaser
        | C::Fleeing
        | C::LOSChaser
        | C::PathChaser
        | C::AlternateChaser
        | C::RandomAltChaser
        | C::PathAltChaser
        | C::RandomPathAltChaser => npcs::update(step, slot, class),
        C::Walker => walkers::walker(step, slot),
        C::WalkerJumper => walkers::walker_jumper(step, slot),
        C::SpawnPoint | C::Bomber => producers::spawn_point(step, slot),
        C::RandomBomber => producers::random_bomber(step, slot),
        C::BomberRandomMissile => producers::bomber_random_missile(step, slot),
        C::SpawnPointMultiSprite => producers::multi_sprite(step, slot),
        // Avatars are updated only as the player's.
        C::MovingAvatar
        | C::HorizontalAvatar
        | C::VerticalAvatar
        | C::NullAvatar
        | C::FlakAvatar
        | C::OrientedAvatar
        | C::ShootAvatar
        | C::ShootOnlyAvatar
        | C::OngoingAvatar
        | C::OngoingShootAvatar
        | C::OngoingTurningAvatar
        | C::MissileAvatar
        | C::AimedAvatar
        | C::SpaceshipAvatar
        | C::CarAvatar
        | C::LanderAvatar
        | C::BirdAvatar
        | C::PlatformerAvatar
        | C::WizardAvatar => {}
    }
}

/// The default update: passive movement, then the time to live.
#[inline]
pub(crate) fn base(step: &mut Step<'_>, slot: Slot) {
    physics::passive(step, slot);
    let time_to_live = step.world.sprite(slot).time_to_live;
    if time_to_live > 0 {
        step.world.edit_motion(slot).time_to_live -= 1;
    } else if time_to_live == 0 {
        step.kill(slot);
    }
}
