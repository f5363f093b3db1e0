//! The summary of each effect: what an execution can do, as plain data.
//!
//! All other parts of the workspace ask the summary what an effect does, and none of them names an effect. A row gives
//! only what differs from [`Summary::of`], the summary of an effect that does nothing.

use super::parameters::Recorder;
use super::{Effect, NAMES, SpawnIf, SpawnIfCounterSubTypes, SpeedChange, build};
use crate::rules::SpriteType;
use smallvec::{SmallVec, smallvec};

crate::named_enum! {
    /// The group of an effect: the groups of the engine's ontology, with movement split by its result.
    pub enum EffectFamily {
        /// Sprites go away, perhaps on a condition.
        Kill = "kill",
        /// Health points.
        Health = "health",
        /// Resources of sprites: taken or changed.
        Resource = "resource",
        /// Sprites appear.
        Spawn = "spawn",
        /// Sprites become others.
        Transform = "transform",
        /// Moves are undone.
        Block = "block",
        /// Sprites face another way.
        Turn = "turn",
        /// Sprites are pushed, pulled or carried.
        Push = "push",
        /// Sprites come out elsewhere.
        Travel = "travel",
        /// Sprites get faster or slower, or another physics.
        Speed = "speed",
        /// Continuous physics meets walls and bats.
        Bounce = "bounce",
        /// Something is scheduled for later.
        Timer = "timer",
        /// An interaction is prevented.
        Shield = "shield",
    }
}

impl EffectFamily {
    /// Returns the family of an effect by its keyword; none if it is not an effect.
    pub fn of(keyword: &str) -> Option<EffectFamily> {
        Some(build(keyword, &mut Recorder::default())?.summary().family)
    }
}

/// One side of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The sprite named first: the one acted upon.
    First,
    /// Its partner.
    Second,
}

impl Side {
    pub(crate) fn other(self) -> Side {
        match self {
            Side::First => Side::Second,
            Side::Second => Side::First,
        }
    }
}

/// One effect of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectSummary {
    /// The sprite of that side is removed.
    Kill(Side),
    /// Every sprite of exactly this type is removed.
    KillAll(SpriteType),
    /// The first sprite turns into one of this type.
    Become(SpriteType),
    /// The first sprite turns into one of these types, chosen at random.
    BecomeAny(Box<[SpriteType]>),
    /// Every sprite of exactly the one type turns into one of the other.
    BecomeAll(SpriteType, SpriteType),
    /// The first sprite moves back to its previous position: the second one blocks it.
    Stop,
    /// Every sprite that moved moves back, except sprites of these types.
    Undo(Box<[SpriteType]>),
    /// The first sprite changes its orientation.
    Turn,
    /// The first sprite is pushed along by the second.
    Push,
    /// The first sprite is carried along by the second, or moved to its position.
    Carry,
    /// The first sprite reappears at the exit of the second one.
    Teleport,
    /// The first sprite reappears at the opposite edge.
    Wrap,
    /// Sprites of this type and its relatives, or the first sprite alone, change their speed.
    Speed(Option<SpriteType>),
    /// A sprite of this type appears.
    Make(SpriteType),
    /// Another sprite like the first appears.
    Clone,
    /// The second sprite takes the first one as a resource: as many as the first one's `value`, up to its limit.
    Collect,
    /// The sprite of that side gains (or loses) this amount of a resource.
    Change {
        /// The side whose resources change.
        side: Side,
        /// The resource.
        resource: SpriteType,
        /// The change in the amount.
        by: i32,
    },
    /// Health points change, and a sprite with too few of them dies.
    Health {
        /// The type whose sprites are affected; none: the first sprite.
        of: Option<SpriteType>,
        /// The change in health points.
        by: i32,
        /// The number of health points at or below which it dies.
        dies_at: i32,
    },
    /// For the rest of the tick, interactions of one keyword with sprites of this type do not affect the first sprite's
    /// type.
    Shield {
        /// The shielded-off partner.
        from: SpriteType,
        /// The suppressed keyword, as in VGDL.
        keyword: &'static str,
    },
}

impl EffectSummary {
    /// The type that has to exist for it to happen, or to be held.
    pub(crate) fn names(&self, stype: SpriteType) -> bool {
        match self {
            EffectSummary::Make(named)
            | EffectSummary::Become(named)
            | EffectSummary::Change { resource: named, .. } => *named == stype,
            EffectSummary::Health { of, .. } => *of == Some(stype),
            EffectSummary::Kill(_)
            | EffectSummary::KillAll(_)
            | EffectSummary::BecomeAny(_)
            | EffectSummary::BecomeAll(..)
            | EffectSummary::Stop
            | EffectSummary::Undo(_)
            | EffectSummary::Turn
            | EffectSummary::Push
            | EffectSummary::Carry
            | EffectSummary::Teleport
            | EffectSummary::Wrap
            | EffectSummary::Speed(_)
            | EffectSummary::Clone
            | EffectSummary::Collect
            | EffectSummary::Shield { .. } => false,
        }
    }

    /// Tests whether it concerns all sprites of a type, and needs none in particular.
    pub(crate) fn is_at_large(&self) -> bool {
        match self {
            EffectSummary::KillAll(_) | EffectSummary::BecomeAll(..) => true,
            EffectSummary::Speed(of) | EffectSummary::Health { of, .. } => of.is_some(),
            EffectSummary::Kill(_)
            | EffectSummary::Become(_)
            | EffectSummary::BecomeAny(_)
            | EffectSummary::Stop
            | EffectSummary::Undo(_)
            | EffectSummary::Turn
            | EffectSummary::Push
            | EffectSummary::Carry
            | EffectSummary::Teleport
            | EffectSummary::Wrap
            | EffectSummary::Make(_)
            | EffectSummary::Clone
            | EffectSummary::Collect
            | EffectSummary::Change { .. }
            | EffectSummary::Shield { .. } => false,
        }
    }
}

/// The condition under which an interaction takes effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precondition {
    /// At every meeting.
    Always,
    /// The sprite of that side holds at least this amount of the resource.
    Holds(Side, SpriteType, i32),
    /// The sprite of that side holds at most this amount of the resource.
    HoldsAtMost(Side, SpriteType, i32),
    /// With that probability.
    Chance(f64),
    /// Depends on the movement of the two: from above, head-on, leaving a place behind.
    Movement,
}

/// What an execution of an effect can do.
#[derive(Clone, Debug)]
pub(crate) struct Summary {
    pub(crate) family: EffectFamily,
    /// The effects, in order.
    pub(crate) effects: SmallVec<[EffectSummary; 2]>,
    /// The condition of the effects.
    pub(crate) precondition: Precondition,
    /// `true` if it does nothing at the edge or by the clock, where a sprite has no partner.
    pub(crate) needs_partner: bool,
    /// Its execution on all partners of a sprite together, if there is such a form of it.
    pub(crate) batch: Option<Batch>,
    /// The draws that decide something.
    pub(crate) draws: Draws,
    /// The sprites that it may move.
    pub(crate) moves: Moves,
    /// The new place of the first sprite.
    pub(crate) displacement: Option<Displacement>,
    /// The new orientation of the first sprite.
    pub(crate) turn: Option<Turn>,
    pub(crate) speed: Option<SpeedEffect>,
    /// The place where sprites appear, for [`EffectSummary::Make`].
    pub(crate) spot: Option<Spot>,
    /// `true` if a sprite that is transformed keeps its orientation whatever the types say.
    pub(crate) forces_orientation: bool,
    /// `true` if the transformed first sprite faces the partner's way reversed.
    pub(crate) takes_orientation: bool,
    /// The resource that a meeting gives.
    pub(crate) gives: Option<Gives>,
    /// The resource of which a sprite can get more than its limit.
    pub(crate) overfills: Option<SpriteType>,
    /// The type whose sprites are counted.
    pub(crate) counts: Option<SpriteType>,
    /// The spawn points that make another type from then on.
    pub(crate) redirects: Option<Redirection>,
    /// The partner, and the number of the keyword, against which the type of the first sprite is shielded.
    pub(crate) shield: Option<(SpriteType, u16)>,
    /// The timed effect that is scheduled.
    pub(crate) schedules: Option<u16>,
    /// The score change if the execution kills.
    pub(crate) score_if_killed: i32,
    /// `true` if it can change, or read the place of, sprites that take no part in the meeting.
    pub(crate) affects_distant_sprites: bool,
    pub(crate) reads_orientation: OrientationRead,
    /// The effect on the first sprite depends on it and its partner alone, and changes nothing else.
    pub(crate) is_local_to_first: Provided,
    /// The effect on the first sprite is the same whichever partner comes first.
    pub(crate) is_partner_independent: Provided,
}

/// An effect that runs once on a sprite and all its partners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Batch {
    Bounce,
    Reverse,
}

/// The sprites that an effect may move when it runs; decides how a pass may look for hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moves {
    Nothing,
    First,
    Anything,
}

/// The draws of an execution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Draws {
    Nothing,
    /// One of the four directions.
    Direction,
    /// With this probability something happens.
    Chance(f64),
    /// The same, if both sprites are oriented.
    ChanceIfOriented(f64),
    /// One of that number of types.
    OneOf(usize),
    /// One of the sprites that the partner leads to.
    Exit,
}

/// The place to which the first sprite is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Displacement {
    /// Its last place.
    Back,
    /// Beside the partner, on the side that it came from.
    Flush,
    /// As [`Displacement::Flush`], where it loses the part of its velocity that points at the partner.
    Stop,
    /// Its last place, and the partner's last place for the partner.
    Apart,
    /// Two steps below its last place.
    BackAndDown,
    /// The opposite edge, this part of its size away from it.
    OppositeEdge { offset: f64 },
    /// The partner's place.
    OntoPartner,
    /// The partner's row or column.
    InLine,
    /// A step ahead of the partner's move.
    Pushed,
    /// A step along with the partner, and then `onto` its place.
    Carried { onto: bool },
    /// The exit that the partner leads to.
    Exit,
}

/// The new orientation of the first sprite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// The opposite of its own.
    Back,
    /// One of four.
    AnyOfFour,
    /// Any at all.
    Any,
    /// The opposite, or at an angle to a wall.
    OffWall,
    /// The partner's.
    OfPartner,
    /// The direction in which the partner pushes.
    OfPush,
    /// Its own, without the vertical part for a sprite that is not bound to the grid.
    OfRide,
    /// That of the exit.
    OfExit,
}

/// The effect on speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SpeedEffect {
    /// Sprites of a type and its relatives change their speed.
    OfAll { stype: SpriteType, value: f64, how: SpeedChange },
    /// The first sprite's speed is halved.
    Half,
    /// The first sprite's speed becomes at least its gravity.
    AtLeastGravity,
    /// In continuous physics, a force acts on the first sprite.
    Force,
}

/// The place where a sprite appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spot {
    /// At the first sprite.
    AtFirst,
    /// A cell away from the partner, or from the place it has left.
    Beside { shift: (i32, i32), of_last_place: bool },
    /// The place that the partner has left.
    Behind,
}

/// The resource that a meeting gives, within its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gives {
    /// The first sprite itself, to the second.
    First { used_up: bool },
    /// An amount, from the second sprite to the first.
    Amount { resource: SpriteType, value: i32, used_up: bool },
}

/// Spawn points of a type and its relatives that make another type from then on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Redirection {
    pub(crate) spawn_point: SpriteType,
    pub(crate) to: SpriteType,
}

/// The orientations that an execution can depend on, of sprites that are not oriented.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OrientationRead {
    Either,
    Second,
    Neither,
}

/// The condition of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Provided {
    Never,
    /// If the execution leaves the score alone and is recorded nowhere.
    Free,
    Always,
}

/// The way in which an effect that does nothing else puts the first sprite back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PutBack {
    ToLastPlace,
    FlushWithPartner,
}

/// The part of a summary that a tick reads at every execution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TickSummary {
    pub(crate) affects_distant_sprites: bool,
    pub(crate) shields: bool,
    pub(crate) puts_back: Option<PutBack>,
}

impl Summary {
    /// The summary of an effect that does nothing, of which nothing is known that would permit a shortcut.
    fn of(family: EffectFamily) -> Summary {
        Summary {
            family,
            effects: SmallVec::new(),
            precondition: Precondition::Always,
            needs_partner: false,
            batch: None,
            draws: Draws::Nothing,
            moves: Moves::Nothing,
            displacement: None,
            turn: None,
            speed: None,
            spot: None,
            forces_orientation: false,
            takes_orientation: false,
            gives: None,
            overfills: None,
            counts: None,
            redirects: None,
            shield: None,
            schedules: None,
            score_if_killed: 0,
            affects_distant_sprites: false,
            reads_orientation: OrientationRead::Either,
            is_local_to_first: Provided::Never,
            is_partner_independent: Provided::Never,
        }
    }

    /// The types of the sprites that it makes.
    pub(crate) fn makes(&self) -> Vec<SpriteType> {
        let mut types = Vec::new();
        for effect in &self.effects {
            match effect {
                EffectSummary::Make(to) | EffectSummary::Become(to) | EffectSummary::BecomeAll(_, to) => {
                    types.push(*to);
                }
                EffectSummary::BecomeAny(options) => types.extend_from_slice(options),
                EffectSummary::Kill(_)
                | EffectSummary::KillAll(_)
                | EffectSummary::Stop
                | EffectSummary::Undo(_)
                | EffectSummary::Turn
                | EffectSummary::Push
                | EffectSummary::Carry
                | EffectSummary::Teleport
                | EffectSummary::Wrap
                | EffectSummary::Speed(_)
                | EffectSummary::Clone
                | EffectSummary::Collect
                | EffectSummary::Change { .. }
                | EffectSummary::Health { .. }
                | EffectSummary::Shield { .. } => {}
            }
        }
        types.retain(|&stype| stype != SpriteType::NONE);
        types
    }

    /// The types of the sprites that appear at its [`Spot`].
    pub(crate) fn spawns(&self) -> impl Iterator<Item = SpriteType> + '_ {
        self.effects.iter().filter_map(|effect| match effect {
            EffectSummary::Make(stype) if *stype != SpriteType::NONE => Some(*stype),
            _ => None,
        })
    }

    /// The types that the first sprite can turn into.
    pub(crate) fn becomes(&self) -> impl Iterator<Item = SpriteType> + '_ {
        // Of two types, the one that a condition permits comes last.
        let types = self.effects.iter().rev().flat_map(|effect| match effect {
            EffectSummary::Become(to) => std::slice::from_ref(to),
            EffectSummary::BecomeAny(options) => options,
            _ => &[],
        });
        types.copied().filter(|&stype| stype != SpriteType::NONE)
    }

    /// The types of which every sprite turns into another type.
    pub(crate) fn becomes_all(&self) -> Option<(SpriteType, SpriteType)> {
        self.effects.iter().find_map(|effect| match *effect {
            EffectSummary::BecomeAll(from, to) => Some((from, to)),
            _ => None,
        })
    }

    /// The resource that it changes or tests: such a type need not exist as a sprite.
    pub(crate) fn resource(&self) -> Option<SpriteType> {
        let tested = match self.precondition {
            Precondition::Holds(_, resource, _) | Precondition::HoldsAtMost(_, resource, _) => Some(resource),
            Precondition::Always | Precondition::Chance(_) | Precondition::Movement => None,
        };
        let changed = self.effects.iter().find_map(|effect| match effect {
            EffectSummary::Change { resource, .. } => Some(*resource),
            _ => None,
        });
        tested.or(changed).filter(|&resource| resource != SpriteType::NONE)
    }

    /// The type that it can give speed to when it is executed on sprites of `one`: sprites with grid physics and without
    /// speed.
    pub(crate) fn gives_speed(&self, one: SpriteType) -> Option<SpriteType> {
        match self.speed? {
            SpeedEffect::OfAll { stype, .. } => Some(stype),
            SpeedEffect::AtLeastGravity => Some(one),
            SpeedEffect::Half | SpeedEffect::Force => None,
        }
    }

    /// The types whose sprites stay where they are when everything is moved back; `None` if it does no such thing.
    pub(crate) fn undoes(&self) -> Option<&[SpriteType]> {
        self.effects.iter().find_map(|effect| match effect {
            EffectSummary::Undo(spare) => Some(&**spare),
            _ => None,
        })
    }

    /// Tests whether the partner takes the first sprite as a resource.
    pub(crate) fn collects(&self) -> bool {
        self.effects.contains(&EffectSummary::Collect)
    }

    /// The way in which it puts the first sprite back, if it does nothing else.
    pub(crate) fn puts_back(&self) -> Option<PutBack> {
        let alone = self.effects[..] == [EffectSummary::Stop] && self.precondition == Precondition::Always;
        match self.displacement.filter(|_| alone && self.turn.is_none() && self.speed.is_none())? {
            Displacement::Back => Some(PutBack::ToLastPlace),
            Displacement::Flush => Some(PutBack::FlushWithPartner),
            Displacement::Stop
            | Displacement::Apart
            | Displacement::BackAndDown
            | Displacement::OppositeEdge { .. }
            | Displacement::OntoPartner
            | Displacement::InLine
            | Displacement::Pushed
            | Displacement::Carried { .. }
            | Displacement::Exit => None,
        }
    }

    /// The part that a tick reads.
    pub(crate) fn in_tick(&self) -> TickSummary {
        TickSummary {
            affects_distant_sprites: self.affects_distant_sprites,
            shields: self.shield.is_some(),
            puts_back: self.puts_back(),
        }
    }
}

impl Effect {
    /// The row of the effect: what an execution can do.
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
                ..Summary::of(Family::Kill)
            },
            Effect::KillBoth => Summary {
                effects: smallvec![Kill(First), Kill(Second)],
                needs_partner: true,
                reads_orientation: OrientationRead::Neither,
                ..Summary::of(Family::Kill)
            },
            Effect::KillAll { stype } => Summary {
                effects: smallvec![KillAll(stype)],
                affects_distant_sprites: true,
                reads_orientation: OrientationRead::Neither,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfAlive => {
                Summary { effects: smallvec![Kill(First)], needs_partner: true, ..Summary::of(Family::Kill) }
            }
            Effect::KillIfFromAbove => Summary {
                effects: smallvec![Kill(First)],
                precondition: Movement,
                needs_partner: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfHasLess { resource, limit } => Summary {
                effects: smallvec![Kill(First)],
                precondition: HoldsAtMost(First, resource, limit),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                is_partner_independent: Provided::Free,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfHasMore { resource, limit } => Summary {
                effects: smallvec![Kill(First)],
                precondition: Holds(First, resource, limit),
                reads_orientation: OrientationRead::Neither,
                is_local_to_first: Provided::Always,
                is_partner_independent: Provided::Free,
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
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfFrontal { .. } | Effect::KillIfSpeed { .. } => Summary {
                effects: smallvec![Kill(First)],
                precondition: Movement,
                needs_partner: true,
                ..Summary::of(Family::Kill)
            },
            Effect::KillIfNotUpright => Summary {
                effects: smallvec![Kill(First)],
                precondition: Movement,
                ..Summary::of(Family::Kill)
            },
            Effect::RemoveScore { kill_second, .. } => Summary {
                effects: kill_second.then_some(Kill(Second)).into_iter().collect(),
                ..Summary::of(Family::Kill)
            },
            Effect::AddHealthPoints { value, kill_second, .. } => Summary {
                effects: with(Health { of: None, by: value, dies_at: i32::MIN }, kill_second, Kill(Second)),
                reads_orientation: OrientationRead::Neither,
                ..Summary::of(Family::Health)
            },
            Effect::SubtractHealthPoints { value, limit, stype, score_if_killed } => Summary {
                effects: smallvec![Health { of: stype, by: value.saturating_neg(), dies_at: limit }],
                score_if_killed,
                affects_distant_sprites: stype.is_some(),
                reads_orientation: OrientationRead::Neither,
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
            // What it schedules has a summary of its own.
            Effect::AddTimer { timed } => Summary {
                schedules: Some(timed),
                affects_distant_sprites: true,
                ..Summary::of(Family::Timer)
            },
            Effect::ShieldFrom { stype, keyword } => Summary {
                effects: smallvec![Shield {
                    from: stype,
                    keyword: NAMES.get(usize::from(keyword)).copied().unwrap_or_default(),
                }],
                shield: Some((stype, keyword)),
                ..Summary::of(Family::Shield)
            },
            // It draws, but its draws decide nothing.
            Effect::Disabled(ref summary) => Summary::of(summary.family),
        }
    }
}

/// An effect, and a second one that a flag requests.
fn with(effect: EffectSummary, flag: bool, more: EffectSummary) -> SmallVec<[EffectSummary; 2]> {
    std::iter::once(effect).chain(flag.then_some(more)).collect()
}

fn chance(prob: f64) -> Precondition {
    if prob < 1.0 { Precondition::Chance(prob) } else { Precondition::Always }
}
