//! The effects table: one row per effect, with a summary of the possible consequences of an execution. A row
//! contains only the differences from [`Summary::of`], the summary of an effect that does nothing.

use super::effect_summary::{EffectSummary, Side};
use super::summary::*;
use super::{Effect, SpawnIf, SpawnIfCounterSubTypes};
use crate::keywords::EFFECTS;
use smallvec::{SmallVec, smallvec};

impl Effect {
    /// Returns the effect's row: the possible consequences of an execution.
    pub(crate) fn summary(&self) -> Summary {
        use EffectFamily as Family;
        use EffectSummary::{
            Become, BecomeAll, BecomeAny, Carry, Change, Clone, Collect, Health, Kill, KillAll, Make, Push,
            Shield, Speed, Stop, Teleport, Undo, Wrap,
        };
        use Precondition::{Holds, HoldsAtMost, Movement};
        use Side::{First, Second};
        match *self {
            Effect::KillSprite => Summary {
                effects: smallvec![Kill(First)],
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                is_partner_independent: Provided::Always,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillBoth => Summary {
                effects: smallvec![Kill(First), Kill(Second)],
                needs_partner: true,
                reads_orientation: OrientationRead::Neither,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillAll { stype } => Summary {
                effects: smallvec![KillAll(stype)],
                affects_distant_sprites: true,
                reads_orientation: OrientationRead::Neither,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfAlive => Summary {
                effects: smallvec![Kill(First)],
                needs_partner: true,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfFromAbove => Summary {
                effects: smallvec![Kill(First)],
                precondition: Movement,
                needs_partner: true,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfHasLess { resource, limit } => Summary {
                effects: smallvec![Kill(First)],
                precondition: HoldsAtMost(First, resource, limit),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                is_partner_independent: Provided::Free,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfHasMore { resource, limit } => Summary {
                effects: smallvec![Kill(First)],
                precondition: Holds(First, resource, limit),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                is_partner_independent: Provided::Free,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfOtherHasMore { resource, limit, subtract } => Summary {
                effects: with(
                    Kill(First),
                    subtract,
                    Change { side: Second, resource, by: limit.saturating_neg() },
                ),
                precondition: Holds(Second, resource, limit),
                needs_partner: true,
                overfills: (subtract && limit < 0).then_some(resource),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: if subtract { Provided::Never } else { Provided::Always },
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfFrontal { .. } | Effect::KillIfSpeed { .. } => Summary {
                effects: smallvec![Kill(First)],
                precondition: Movement,
                needs_partner: true,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfNotUpright => Summary {
                effects: smallvec![Kill(First)],
                precondition: Movement,
                spares_avatars: true,
                ..Summary::of(Family::Kill)
            },
            Effect::RemoveScore { kill_second, .. } => Summary {
                effects: kill_second.then_some(Kill(Second)).into_iter().collect(),
                ..Summary::of(Family::Kill)
            },
            Effect::AddHealthPoints { value, kill_second, .. } => Summary {
                effects: with(Health { of: None, by: value, dies_at: i32::MIN }, kill_second, Kill(Second)),
                reads_orientation: OrientationRead::Neither,
                spares_avatars: true,
                ..Summary::of(Family::Health)
            },
            Effect::SubtractHealthPoints { value, limit, stype, score_if_killed } => Summary {
                effects: smallvec![Health { of: stype, by: value.saturating_neg(), dies_at: limit }],
                score_if_killed,
                affects_distant_sprites: stype.is_some(),
                reads_orientation: OrientationRead::Neither,
                spares_avatars: true,
                ..Summary::of(Family::Health)
            },
            Effect::CollectResource { kill_resource } => Summary {
                effects: with(Collect, kill_resource, Kill(First)),
                needs_partner: true,
                gives: Some(Gives::First { used_up: kill_resource }),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                ..Summary::of(Family::Resource)
            },
            Effect::CollectResourceIfHeld { held, value, kill_resource } => Summary {
                effects: with(Collect, kill_resource, Kill(First)),
                precondition: Holds(Second, held, value),
                needs_partner: true,
                gives: Some(Gives::First { used_up: kill_resource }),
                ..Summary::of(Family::Resource)
            },
            Effect::ChangeResource { resource, value, kill_resource } => Summary {
                effects: with(Change { side: First, resource, by: value }, kill_resource, Kill(Second)),
                needs_partner: true,
                gives: Some(Gives::Amount { resource, value, used_up: kill_resource }),
                reads_orientation: OrientationRead::Neither,
                ..Summary::of(Family::Resource)
            },
            Effect::Spawn { stype, prob } => Summary {
                effects: smallvec![Make(stype)],
                precondition: chance(prob),
                draws: Draws::Chance(prob),
                spot: Some(Spot::AtFirst),
                ..Summary::of(Family::Spawn)
            },
            Effect::SpawnIf(SpawnIf { resource, limit, stype, spend, prob, more }) => Summary {
                effects: with(
                    Make(stype),
                    more && spend != 0,
                    Change { side: First, resource, by: spend.saturating_neg() },
                ),
                precondition: if more {
                    Holds(First, resource, limit)
                } else {
                    HoldsAtMost(First, resource, limit)
                },
                draws: Draws::Chance(prob),
                spot: Some(Spot::AtFirst),
                overfills: (spend < 0).then_some(resource),
                ..Summary::of(Family::Spawn)
            },
            Effect::SpawnBeside { stype, shift, step_back, prob } => Summary {
                effects: smallvec![Make(stype)],
                precondition: if step_back { Movement } else { chance(prob) },
                needs_partner: true,
                draws: Draws::Chance(prob),
                spot: Some(Spot::Beside { shift, of_last_place: step_back }),
                ..Summary::of(Family::Spawn)
            },
            Effect::SpawnBehind { stype, prob } => Summary {
                effects: smallvec![Make(stype)],
                precondition: Movement,
                needs_partner: true,
                draws: Draws::Chance(prob),
                spot: Some(Spot::Behind),
                ..Summary::of(Family::Spawn)
            },
            Effect::SpawnIfCounterSubTypes(SpawnIfCounterSubTypes { stype, otherwise, counted, .. }) => {
                Summary {
                    effects: smallvec![Make(stype), Make(otherwise)],
                    precondition: Movement,
                    spot: Some(Spot::AtFirst),
                    counts: Some(counted),
                    ..Summary::of(Family::Spawn)
                }
            }
            Effect::CloneSprite => Summary { effects: smallvec![Clone], ..Summary::of(Family::Spawn) },
            Effect::UpdateSpawnType { stype, spawn_point } => Summary {
                effects: smallvec![Make(stype)],
                redirects: Some(Redirection { spawn_point, to: stype }),
                affects_distant_sprites: true,
                ..Summary::of(Family::Spawn)
            },
            Effect::TransformTo { stype, kill_second, force_orientation } => {
                let alone = if kill_second { Provided::Never } else { Provided::Always };
                Summary {
                    effects: with(Become(stype), kill_second, Kill(Second)),
                    forces_orientation: force_orientation,
                    reads_orientation: if force_orientation {
                        OrientationRead::Either
                    } else {
                        OrientationRead::Neither
                    },
                    is_local_to_first: alone,
                    is_partner_independent: if force_orientation { Provided::Never } else { alone },
                    ..Summary::of(Family::Transform)
                }
            }
            Effect::TransformToAll { stype, to, kill_second, force_orientation } => Summary {
                effects: with(BecomeAll(stype, to), kill_second, Kill(Second)),
                forces_orientation: force_orientation,
                affects_distant_sprites: true,
                ..Summary::of(Family::Transform)
            },
            Effect::TransformToRandomChild { ref options, kill_second, force_orientation } => Summary {
                effects: with(BecomeAny(options.clone()), kill_second, Kill(Second)),
                draws: Draws::OneOf(options.len()),
                forces_orientation: force_orientation,
                ..Summary::of(Family::Transform)
            },
            Effect::TransformIfCount(ref rule) => {
                let otherwise = rule.otherwise.into_iter().map(Become);
                let gone = rule.kill_second.then_some(Kill(Second));
                Summary {
                    effects: otherwise.chain([Become(rule.stype)]).chain(gone).collect(),
                    precondition: Movement,
                    needs_partner: true,
                    forces_orientation: rule.force_orientation,
                    counts: Some(rule.counted),
                    affects_distant_sprites: true,
                    ..Summary::of(Family::Transform)
                }
            }
            Effect::TransformToSingleton { stype, other, take_orientation } => Summary {
                effects: smallvec![Become(stype), BecomeAll(stype, other)],
                needs_partner: true,
                forces_orientation: true,
                takes_orientation: take_orientation,
                affects_distant_sprites: true,
                ..Summary::of(Family::Transform)
            },
            Effect::StepBack { pixel_perfect: false } => Summary {
                effects: smallvec![Stop],
                moves: Moves::First,
                displacement: Some(Displacement::Back),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                is_partner_independent: Provided::Free,
                ..Summary::of(Family::Block)
            },
            Effect::StepBack { pixel_perfect: true } => Summary {
                effects: smallvec![Stop],
                moves: Moves::First,
                displacement: Some(Displacement::Flush),
                ..Summary::of(Family::Block)
            },
            Effect::UndoAll { ref spare } => Summary {
                effects: smallvec![Undo(spare.clone())],
                moves: Moves::Anything,
                affects_distant_sprites: true,
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Free,
                is_partner_independent: Provided::Free,
                ..Summary::of(Family::Block)
            },
            Effect::TurnAround => Summary {
                effects: smallvec![Stop, EffectSummary::Turn],
                moves: Moves::First,
                displacement: Some(Displacement::BackAndDown),
                turn: Some(Turn::Back),
                speed: Some(SpeedEffect::Force),
                is_local_to_first: Provided::Always,
                ..Summary::of(Family::Turn)
            },
            Effect::ReverseDirection => Summary {
                effects: smallvec![EffectSummary::Turn],
                turn: Some(Turn::Back),
                is_local_to_first: Provided::Always,
                ..Summary::of(Family::Turn)
            },
            Effect::FlipDirection => Summary {
                effects: smallvec![EffectSummary::Turn],
                draws: Draws::Direction,
                turn: Some(Turn::AnyOfFour),
                ..Summary::of(Family::Turn)
            },
            Effect::AttractGaze { align, prob } => Summary {
                effects: smallvec![EffectSummary::Turn],
                precondition: chance(prob),
                needs_partner: true,
                draws: Draws::ChanceIfOriented(prob),
                moves: Moves::First,
                displacement: align.then_some(Displacement::InLine),
                turn: Some(Turn::OfPartner),
                ..Summary::of(Family::Turn)
            },
            Effect::Align { orient } => Summary {
                effects: smallvec![Carry],
                needs_partner: true,
                moves: Moves::First,
                displacement: Some(Displacement::OntoPartner),
                turn: orient.then_some(Turn::OfPartner),
                ..Summary::of(Family::Push)
            },
            Effect::BounceForward => Summary {
                effects: smallvec![Push],
                needs_partner: true,
                moves: Moves::First,
                displacement: Some(Displacement::Pushed),
                turn: Some(Turn::OfPush),
                speed: Some(SpeedEffect::Force),
                reads_orientation: OrientationRead::Second,
                is_local_to_first: Provided::Always,
                ..Summary::of(Family::Push)
            },
            Effect::PullWithIt { pixel_perfect } => Summary {
                effects: smallvec![Carry],
                needs_partner: true,
                moves: Moves::First,
                displacement: Some(Displacement::Carried { onto: pixel_perfect }),
                turn: Some(Turn::OfRide),
                ..Summary::of(Family::Push)
            },
            Effect::TeleportToExit => Summary {
                effects: smallvec![Teleport],
                needs_partner: true,
                draws: Draws::Exit,
                spares_avatars: true,
                moves: Moves::First,
                displacement: Some(Displacement::Exit),
                turn: Some(Turn::OfExit),
                affects_distant_sprites: true,
                ..Summary::of(Family::Travel)
            },
            Effect::WrapAround { offset } => Summary {
                effects: smallvec![Wrap],
                moves: Moves::First,
                displacement: Some(Displacement::OppositeEdge { offset }),
                is_local_to_first: Provided::Always,
                ..Summary::of(Family::Travel)
            },
            Effect::HalfSpeed => Summary {
                effects: smallvec![Speed(None)],
                speed: Some(SpeedEffect::Half),
                ..Summary::of(Family::Speed)
            },
            Effect::ChangeSpeed { stype, value, how } => Summary {
                effects: smallvec![Speed(Some(stype))],
                speed: Some(SpeedEffect::OfAll { stype, value, how }),
                affects_distant_sprites: true,
                ..Summary::of(Family::Speed)
            },
            Effect::WaterPhysics => Summary {
                effects: smallvec![Speed(None)],
                speed: Some(SpeedEffect::Force),
                ..Summary::of(Family::Speed)
            },
            Effect::BounceDirection { .. } => Summary {
                effects: smallvec![EffectSummary::Turn],
                needs_partner: true,
                turn: Some(Turn::Any),
                ..Summary::of(Family::Bounce)
            },
            Effect::WallStop => Summary {
                effects: smallvec![Stop],
                needs_partner: true,
                moves: Moves::First,
                displacement: Some(Displacement::Stop),
                turn: Some(Turn::OffWall),
                speed: Some(SpeedEffect::AtLeastGravity),
                ..Summary::of(Family::Bounce)
            },
            Effect::WallBounce => Summary {
                effects: smallvec![Stop, EffectSummary::Turn],
                needs_partner: true,
                batch: Some(Batch::Bounce),
                moves: Moves::Anything,
                displacement: Some(Displacement::Apart),
                turn: Some(Turn::OffWall),
                speed: Some(SpeedEffect::Force),
                ..Summary::of(Family::Bounce)
            },
            Effect::WallReverse => Summary {
                effects: smallvec![Stop, EffectSummary::Turn],
                needs_partner: true,
                batch: Some(Batch::Reverse),
                moves: Moves::Anything,
                displacement: Some(Displacement::Apart),
                turn: Some(Turn::OffWall),
                speed: Some(SpeedEffect::AtLeastGravity),
                ..Summary::of(Family::Bounce)
            },
            // The scheduled effect has its own summary.
            Effect::AddTimer { timed } => Summary {
                schedules: Some(timed),
                affects_distant_sprites: true,
                ..Summary::of(Family::Timer)
            },
            Effect::ShieldFrom { stype, keyword } => Summary {
                effects: smallvec![Shield {
                    from: stype,
                    keyword: EFFECTS.get(usize::from(keyword)).copied().unwrap_or_default(),
                }],
                shield: Some((stype, keyword)),
                ..Summary::of(Family::Shield)
            },
            // A disabled effect still draws random numbers, but its draws decide nothing.
            Effect::Disabled(ref summary) => Summary::of(summary.family),
        }
    }
}

/// Returns a list with one effect and, if `flag` is set, a second effect.
fn with(effect: EffectSummary, flag: bool, more: EffectSummary) -> SmallVec<[EffectSummary; 2]> {
    std::iter::once(effect).chain(flag.then_some(more)).collect()
}

fn chance(prob: f64) -> Precondition {
    if prob < 1.0 { Precondition::Chance(prob) } else { Precondition::Always }
}
