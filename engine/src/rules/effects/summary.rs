//! Summaries of effects: the possible consequences of an execution, as plain data. Each effect has one row
//! (`summaries.rs`).
//!
//! The rest of the workspace uses only summaries, and does not depend on any particular effect.

use super::effect_summary::{EffectSummary, Side};
use crate::rules::SpriteType;
use smallvec::SmallVec;

base::named_enum! {
    /// An effect's family. The families are the groups in the engine's ontology, except that movement is
    /// split by its result.
    pub enum EffectFamily {
        /// Removes sprites, optionally under a condition.
        Kill = "kill",
        /// Changes health points.
        Health = "health",
        /// Collects sprites as resources, or changes the amount of a resource.
        Resource = "resource",
        /// Creates sprites.
        Spawn = "spawn",
        /// Turns sprites into sprites of other types.
        Transform = "transform",
        /// Undoes moves.
        Block = "block",
        /// Changes the directions that sprites face.
        Turn = "turn",
        /// Pushes, pulls or carries sprites.
        Push = "push",
        /// Makes sprites reappear elsewhere.
        Travel = "travel",
        /// Changes sprites' speed or physics.
        Speed = "speed",
        /// Handles continuous physics at walls and paddles.
        Bounce = "bounce",
        /// Schedules another effect.
        Timer = "timer",
        /// Prevents other interactions.
        Shield = "shield",
    }
}

/// The condition under which an interaction takes effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precondition {
    /// The interaction always takes effect.
    Always,
    /// The sprite on the given side holds at least this amount of the resource.
    Holds(Side, SpriteType, i32),
    /// The sprite on the given side holds at most this amount of the resource.
    HoldsAtMost(Side, SpriteType, i32),
    /// The interaction takes effect with this probability.
    Chance(f64),
    /// The condition depends on the movement of the two sprites: from above, head-on, or leaving a cell.
    Movement,
}

/// The possible consequences of one execution of an effect, as plain data.
#[derive(Clone, Debug)]
pub(crate) struct Summary {
    pub(crate) family: EffectFamily,
    /// The effects, in order of execution.
    pub(crate) effects: SmallVec<[EffectSummary; 2]>,
    /// The effects' condition.
    pub(crate) precondition: Precondition,
    /// `true` if the effect does nothing at the edge or when timed, because there is no partner.
    pub(crate) needs_partner: bool,
    /// The batch form of the effect, if any, which runs once on a sprite and all its partners.
    pub(crate) batch: Option<Batch>,
    /// The random draws that affect the result.
    pub(crate) draws: Draws,
    /// `true` only if an avatar that the effect removes, without turning it into another sprite, stays on the
    /// board as a dead avatar.
    pub(crate) spares_avatars: bool,
    /// The sprites that the effect may move.
    pub(crate) moves: Moves,
    /// The new position of the first sprite; `None` if the effect does not move it.
    pub(crate) displacement: Option<Displacement>,
    /// The new orientation of the first sprite; `None` if the effect does not turn it.
    pub(crate) turn: Option<Turn>,
    pub(crate) speed: Option<SpeedEffect>,
    /// The position where sprites appear; `None` unless the effect is an [`EffectSummary::Make`].
    pub(crate) spot: Option<Spot>,
    /// `true` if a transformed sprite keeps its orientation, regardless of the two types.
    pub(crate) forces_orientation: bool,
    /// `true` if the transformed first sprite faces in the direction opposite to the partner's.
    pub(crate) takes_orientation: bool,
    /// The resource that a collision gives; `None` if it gives none.
    pub(crate) gives: Option<Gives>,
    /// The resource whose limit the effect can exceed; `None` if it exceeds no limit.
    pub(crate) overfills: Option<SpriteType>,
    /// The type whose sprites the effect counts; `None` if it counts none.
    pub(crate) counts: Option<SpriteType>,
    /// The spawn points that create a different type after the effect, if any.
    pub(crate) redirects: Option<Redirection>,
    /// The effect from which the first sprite's type is shielded, if any: the partner's type and the index of the
    /// effect's keyword.
    pub(crate) shield: Option<(SpriteType, u16)>,
    /// The index of the timed effect that the effect schedules, if any.
    pub(crate) schedules: Option<u16>,
    /// The score change if an execution kills a sprite.
    pub(crate) score_if_killed: i32,
    /// `true` if the effect can change sprites that take no part in the interaction, or read their positions.
    pub(crate) affects_distant_sprites: bool,
    pub(crate) reads_orientation: OrientationRead,
    /// The condition under which the effect on the first sprite depends only on that sprite and its partner, and
    /// nothing else changes.
    pub(crate) is_local_to_first: Provided,
    /// The condition under which the effect on the first sprite is the same regardless of the partners'
    /// order.
    pub(crate) is_partner_independent: Provided,
}

/// An effect that runs once on a sprite and all its partners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Batch {
    Bounce,
    Reverse,
}

/// The sprites that an effect may move. They determine how a pass may search for overlapping sprites.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moves {
    Nothing,
    First,
    Anything,
}

/// The random draws that an execution makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Draws {
    Nothing,
    /// Draws one of the four directions.
    Direction,
    /// Decides with this probability whether something happens.
    Chance(f64),
    /// Decides with this probability whether something happens, if both sprites are oriented.
    ChanceIfOriented(f64),
    /// Draws one of several types. The value is the number of types.
    OneOf(usize),
    /// Draws one of the sprites to which the partner leads.
    Exit,
}

/// The position to which the first sprite moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Displacement {
    /// The first sprite's previous position.
    Back,
    /// The position beside the partner, on the side from which the first sprite came.
    Flush,
    /// The same position as for [`Displacement::Flush`], but the first sprite also loses the component of its
    /// velocity towards the partner.
    Stop,
    /// The first sprite's previous position. The partner also moves back to its own previous position.
    Apart,
    /// Two steps below the first sprite's previous position.
    BackAndDown,
    /// The position at the opposite edge, offset by `offset` times the sprite's size.
    OppositeEdge { offset: f64 },
    /// The partner's position.
    OntoPartner,
    /// The partner's row or column.
    InLine,
    /// One step in the direction of the partner's move.
    Pushed,
    /// One step along with the partner, followed by a move to the partner's position if `onto` is set.
    Carried { onto: bool },
    /// The exit to which the partner leads.
    Exit,
}

/// The first sprite's new orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// The opposite of the first sprite's own orientation.
    Back,
    /// One of the four directions.
    AnyOfFour,
    /// Any direction.
    Any,
    /// The opposite direction, or an angle to a wall.
    OffWall,
    /// The partner's orientation.
    OfPartner,
    /// The direction in which the partner pushes.
    OfPush,
    /// The first sprite's own orientation, without the vertical component for a sprite with continuous
    /// physics.
    OfRide,
    /// The exit's orientation.
    OfExit,
}

/// A change in speed. The variants distinguish increaseSpeedToAll, decreaseSpeedToAll and setSpeedForAll.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SpeedChange {
    Increase,
    Decrease,
    Set,
}

/// An effect on the speed of sprites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SpeedEffect {
    /// The speeds of a type and of related types in the SpriteSet change.
    OfAll { stype: SpriteType, value: f64, how: SpeedChange },
    /// The first sprite's speed is halved.
    Half,
    /// The first sprite's speed becomes at least its gravity.
    AtLeastGravity,
    /// In continuous physics, a force acts on the first sprite.
    Force,
}

/// The position where a sprite appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spot {
    /// The first sprite's position.
    AtFirst,
    /// One cell away from the partner, or from the partner's previous position.
    Beside { shift: (i32, i32), of_last_place: bool },
    /// The partner's previous position.
    Behind,
}

/// The resource that an interaction gives, within the resource's limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gives {
    /// The second sprite receives the first sprite itself.
    First { used_up: bool },
    /// The first sprite receives an amount of the resource from the second sprite.
    Amount { resource: SpriteType, value: i32, used_up: bool },
}

/// Spawn points of a type and of related types in the SpriteSet that create a different type from then on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Redirection {
    pub(crate) spawn_point: SpriteType,
    pub(crate) to: SpriteType,
}

/// The sprites whose orientation an execution can depend on, although they are not oriented.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OrientationRead {
    Either,
    Second,
    Neither,
}

/// The condition under which a property holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Provided {
    Never,
    /// The property holds if the execution does not change the score and is not recorded anywhere.
    Free,
    Always,
}

/// The way in which an effect moves the first sprite back without any other consequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PutBack {
    ToLastPlace,
    FlushWithPartner,
}

/// The part of a summary that a tick reads for each execution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TickSummary {
    pub(crate) affects_distant_sprites: bool,
    pub(crate) shields: bool,
    pub(crate) puts_back: Option<PutBack>,
}

impl Summary {
    /// Returns the summary for an effect that does nothing, without any property that would permit a
    /// shortcut.
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

    /// Returns the types of the sprites created by the effect.
    pub(crate) fn makes(&self) -> Vec<SpriteType> {
        let types = self.effects.iter().flat_map(EffectSummary::makes).copied();
        types.filter(|&stype| stype != SpriteType::NONE).collect()
    }

    /// Returns the types of the sprites that appear at the effect's [`Spot`].
    pub(crate) fn spawns(&self) -> impl Iterator<Item = SpriteType> + '_ {
        self.effects.iter().filter_map(|effect| {
            let EffectSummary::Make(stype) = effect else { return None };
            (*stype != SpriteType::NONE).then_some(*stype)
        })
    }

    /// Returns the types that the first sprite can turn into.
    pub(crate) fn becomes(&self) -> impl Iterator<Item = SpriteType> + '_ {
        // If there are two types, the conditional one comes last.
        let types = self
            .effects
            .iter()
            .rev()
            .filter(|effect| matches!(effect, EffectSummary::Become(_) | EffectSummary::BecomeAny(_)));
        let types = types.flat_map(EffectSummary::makes);
        types.copied().filter(|&stype| stype != SpriteType::NONE)
    }

    /// Returns the two types if the effect turns every sprite of one type into a sprite of another.
    pub(crate) fn becomes_all(&self) -> Option<(SpriteType, SpriteType)> {
        self.effects.iter().find_map(|effect| {
            let EffectSummary::BecomeAll(from, to) = *effect else { return None };
            Some((from, to))
        })
    }

    /// Returns the resource that the effect changes or tests; `None` if it changes and tests none. The resource's type
    /// need not exist as a sprite.
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

    /// Returns the type whose sprites can gain speed from a standstill when the effect runs on sprites of `one`; `None`
    /// if no sprite can. Forces act only on sprites with continuous physics.
    pub(crate) fn gives_speed(&self, one: SpriteType) -> Option<SpriteType> {
        match self.speed? {
            SpeedEffect::OfAll { stype, .. } => Some(stype),
            SpeedEffect::AtLeastGravity | SpeedEffect::Force => Some(one),
            SpeedEffect::Half => None,
        }
    }

    /// Returns the types whose sprites keep their position when everything moves back, or `None` if the
    /// effect does not move everything back.
    pub(crate) fn undoes(&self) -> Option<&[SpriteType]> {
        self.effects.iter().find_map(|effect| {
            let EffectSummary::Undo(spare) = effect else { return None };
            Some(&**spare)
        })
    }

    /// Returns `true` if the partner collects the first sprite as a resource.
    pub(crate) fn collects(&self) -> bool {
        self.effects.contains(&EffectSummary::Collect)
    }

    /// Returns how the effect moves the first sprite back, if the effect has no other consequence.
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

    /// Returns `true` if an execution leaves the second sprite unchanged, provided that nothing else moves
    /// that sprite and no parameter refers to its type.
    pub(crate) fn spares_still_second(&self) -> bool {
        let stays = match self.moves {
            Moves::Nothing | Moves::First => true,
            // A second sprite that nothing moves is already at its previous position.
            Moves::Anything => self.undoes().is_some() || self.displacement == Some(Displacement::Apart),
        };
        stays && self.redirects.is_none() && !self.effects.iter().any(|effect| effect.changes(Side::Second))
    }

    /// Returns the part of the summary that a tick reads.
    pub(crate) fn in_tick(&self) -> TickSummary {
        TickSummary {
            affects_distant_sprites: self.affects_distant_sprites,
            shields: self.shield.is_some(),
            puts_back: self.puts_back(),
        }
    }
}
