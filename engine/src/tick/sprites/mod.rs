//! The updates of sprites in a tick (`spec/02` §4–§8).

pub(crate) mod npcs;
mod plain;
pub(crate) mod producers;
pub(super) mod walkers;

use crate::rules::class::SpriteClass;
use crate::tick::physics;
use crate::tick::{Scheduler, Step};
use crate::world::Slot;

/// Updates a sprite. The avatar is updated in `avatars` instead.
pub(crate) fn update(step: &mut Step<'_, impl Scheduler>, slot: Slot, class: SpriteClass) {
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
        // Avatars are updated only if the player controls them.
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

/// Performs the default update: passive movement, followed by a check of the time to live.
#[inline]
pub(crate) fn base(step: &mut Step<'_, impl Scheduler>, slot: Slot) {
    physics::passive(step, slot);
    let time_to_live = step.world.sprite(slot).time_to_live;
    if time_to_live > 0 {
        step.world.edit_motion(slot).time_to_live -= 1;
    } else if time_to_live == 0 {
        step.kill(slot);
    }
}
