//! The summary of an effect: the possible consequences of an execution, as plain data. Each effect has a row (`rows.rs`).
//!
//! All other parts of the workspace ask the summary what an effect does, and none of them names an effect.

use super::effect_summary::{EffectSummary, Side};
use crate::rules::SpriteType;
use smallvec::SmallVec;

base::named_enum! {
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

/// The possible consequences of an execution of an effect, as plain data.
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
    /// `true` only if an avatar that it removes, without turning it into another sprite, stays on the board as a dead one.
    pub(crate) spares_avatars: bool,
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

/// The difference between increaseSpeedToAll, decreaseSpeedToAll and setSpeedForAll.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpeedChange {
    Increase,
    Decrease,
    Set,
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
    /// Returns the summary of an effect that does nothing, of which nothing is known that would permit a shortcut.
    pub(super) fn of(family: EffectFamily) -> Summary {
        Summary {
            family,
            effects: SmallVec::new(),
            precondition: Precondition::Always,
            needs_partner: false,
            batch: None,
            draws: Draws::Nothing,
            spares_avatars: false,
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

    /// Returns the types of the sprites that it makes.
    pub(crate) fn makes(&self) -> Vec<SpriteType> {
        let types = self.effects.iter().flat_map(EffectSummary::makes).copied();
        types.filter(|&stype| stype != SpriteType::NONE).collect()
    }

    /// Returns the types of the sprites that appear at its [`Spot`].
    pub(crate) fn spawns(&self) -> impl Iterator<Item = SpriteType> + '_ {
        self.effects.iter().filter_map(|effect| {
            let EffectSummary::Make(stype) = effect else { return None };
            (*stype != SpriteType::NONE).then_some(*stype)
        })
    }

    /// Returns the types that the first sprite can turn into.
    pub(crate) fn becomes(&self) -> impl Iterator<Item = SpriteType> + '_ {
        // Of two types, the one that a condition permits comes last.
        let types = self
            .effects
            .iter()
            .rev()
            .filter(|effect| matches!(effect, EffectSummary::Become(_) | EffectSummary::BecomeAny(_)));
        let types = types.flat_map(EffectSummary::makes);
        types.copied().filter(|&stype| stype != SpriteType::NONE)
    }

    /// Returns the types of which every sprite turns into another type.
    pub(crate) fn becomes_all(&self) -> Option<(SpriteType, SpriteType)> {
        self.effects.iter().find_map(|effect| {
            let EffectSummary::BecomeAll(from, to) = *effect else { return None };
            Some((from, to))
        })
    }

    /// Returns the resource that it changes or tests: such a type need not exist as a sprite.
    pub(crate) fn resource(&self) -> Option<SpriteType> {
        let tested = match self.precondition {
            Precondition::Holds(_, resource, _) | Precondition::HoldsAtMost(_, resource, _) => Some(resource),
            Precondition::Always | Precondition::Chance(_) | Precondition::Movement => None,
        };
        let changed = self.effects.iter().find_map(|effect| {
            let EffectSummary::Change { resource, .. } = effect else { return None };
            Some(*resource)
        });
        tested.or(changed).filter(|&resource| resource != SpriteType::NONE)
    }

    /// Returns the type to whose sprites without speed it can give speed when it is executed on sprites of `one`. A
    /// force acts with continuous physics alone.
    pub(crate) fn gives_speed(&self, one: SpriteType) -> Option<SpriteType> {
        match self.speed? {
            SpeedEffect::OfAll { stype, .. } => Some(stype),
            SpeedEffect::AtLeastGravity | SpeedEffect::Force => Some(one),
            SpeedEffect::Half => None,
        }
    }

    /// Returns the types whose sprites stay where they are when everything is moved back; `None` if it does no such thing.
    pub(crate) fn undoes(&self) -> Option<&[SpriteType]> {
        self.effects.iter().find_map(|effect| {
            let EffectSummary::Undo(spare) = effect else { return None };
            Some(&**spare)
        })
    }

    /// Returns `true` if the partner takes the first sprite as a resource.
    pub(crate) fn collects(&self) -> bool {
        self.effects.contains(&EffectSummary::Collect)
    }

    /// Returns the way in which it puts the first sprite back, if it does nothing else.
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

    /// Returns `true` if an execution leaves a second sprite as it is that nothing else moves, and whose type no
    /// parameter names.
    pub(crate) fn spares_still_second(&self) -> bool {
        let stays = match self.moves {
            Moves::Nothing | Moves::First => true,
            // It is at its last place already.
            Moves::Anything => self.undoes().is_some() || self.displacement == Some(Displacement::Apart),
        };
        stays && self.redirects.is_none() && !self.effects.iter().any(|effect| effect.changes(Side::Second))
    }

    /// Returns the part that a tick reads.
    pub(crate) fn in_tick(&self) -> TickSummary {
        TickSummary {
            affects_distant_sprites: self.affects_distant_sprites,
            shields: self.shield.is_some(),
            puts_back: self.puts_back(),
        }
    }
}
