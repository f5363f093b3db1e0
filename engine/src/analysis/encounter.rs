//! Interactions in a neutral form: the two sprites, the effects and the condition.

use crate::game::{Rules, SpriteType};
use crate::ontology::effects::Effect;
use smallvec::{SmallVec, smallvec};

/// One side of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The sprite named first: the one acted upon.
    First,
    /// Its partner.
    Second,
}

impl Side {
    pub(super) fn other(self) -> Side {
        match self {
            Side::First => Side::Second,
            Side::Second => Side::First,
        }
    }
}

/// One effect of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum Deed {
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
        who: Side,
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

impl Deed {
    fn names(&self, stype: SpriteType) -> bool {
        match self {
            Deed::Make(made) | Deed::Become(made) | Deed::Change { resource: made, .. } => *made == stype,
            Deed::Health { of, .. } => *of == Some(stype),
            _ => false,
        }
    }
}

/// The condition under which an interaction takes effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Provided {
    /// At every meeting.
    Always,
    /// The sprite of that side holds at least this amount of the resource.
    Holds(Side, SpriteType, i32),
    /// The sprite of that side holds at most this amount of the resource.
    HoldsAtMost(Side, SpriteType, i32),
    /// With that probability.
    Chance(f64),
    /// Depends on the movement of the two: from above, head-on, leaving a place behind.
    Way,
}

/// One interaction line with one of its partners, in neutral form.
#[derive(Clone, Debug)]
pub struct Encounter {
    /// The type named first, as written. The rule holds for its whole tree (see
    /// [`Analysis::applies`](super::Analysis::applies)).
    pub first: SpriteType,
    /// The partner, as written; none: the edge of the screen.
    pub second: Option<SpriteType>,
    /// The effects, in order.
    pub deeds: SmallVec<[Deed; 2]>,
    /// The condition.
    pub provided: Provided,
    /// The change in the score if the interaction happens.
    pub score: i32,
    /// Index of the line in [`Description::interactions`](crate::Description).
    pub line: usize,
    /// The effect with all its parameters.
    pub(super) effect: u16,
    /// The index of the effect's keyword, for shields.
    pub(super) keyword: u16,
}

impl Encounter {
    /// Returns `true` if `wanted` accepts one of the effects.
    pub fn does(&self, wanted: impl Fn(&Deed) -> bool) -> bool {
        self.deeds.iter().any(wanted)
    }

    /// Returns `true` if the first sprite is blocked: it, or everything, moves back.
    pub fn blocks(&self) -> bool {
        self.does(|deed| matches!(deed, Deed::Stop | Deed::Undo(_)))
    }

    /// Returns `true` if the sprite of that side is removed or turns into another type.
    pub fn ends(&self, side: Side) -> bool {
        self.does(|deed| match deed {
            Deed::Kill(who) => *who == side,
            Deed::Become(_) | Deed::BecomeAny(_) => side == Side::First,
            Deed::Health { of: None, by, .. } => side == Side::First && *by < 0,
            _ => false,
        })
    }
}

/// Returns all interactions in the order of a tick, those with the edge first, without repetitions.
pub(super) fn encounters(rules: &Rules) -> Vec<Encounter> {
    let mut seen: Vec<(SpriteType, Option<SpriteType>, u16, u16)> = Vec::new();
    // There is no shield against the edge.
    let edge = rules.edge.iter().filter(|(stype, _)| *stype != SpriteType::NONE);
    let edge = edge.map(|&(stype, effect)| (stype, None, effect, u16::MAX));
    let pairs = rules.passes.iter().map(|pass| (pass.first, Some(pass.second), pass.effect, pass.keyword));
    for key in edge.chain(pairs) {
        // Repetitions of a pass, or of an edge effect, are close together.
        if !seen.iter().rev().take(64).any(|other| *other == key) {
            seen.push(key);
        }
    }
    let encounter = |(first, second, effect, keyword): (SpriteType, Option<SpriteType>, u16, u16)| {
        let info = &rules.effects[usize::from(effect)];
        let (mut deeds, mut provided) = neutral(&info.effect);
        if let Effect::AddTimer { timed } = info.effect {
            deeds.extend(later(rules, timed));
        }
        // Effects on or with undeclared types, in games loaded as the reference does, never happen.
        deeds.retain(|deed| !deed.names(SpriteType::NONE));
        if matches!(provided, Provided::Holds(_, SpriteType::NONE, _)) {
            provided = Provided::Way;
        }
        let score = match info.effect {
            Effect::SubtractHealthPoints { score_if_killed, .. } if score_if_killed != 0 => score_if_killed,
            _ if info.apply_score => info.score_change,
            _ => 0,
        };
        Encounter { first, second, deeds, provided, score, line: info.line, effect, keyword }
    };
    seen.into_iter().map(encounter).collect()
}

/// Returns the timed effects, each with the type of its target (none: no particular sprite).
pub(super) fn clockwork(rules: &Rules) -> Vec<(Option<SpriteType>, SmallVec<[Deed; 2]>)> {
    let deeds = |effect: u16| {
        let (mut deeds, _) = neutral(&rules.effects[usize::from(effect)].effect);
        deeds.retain(|deed| !deed.names(SpriteType::NONE));
        deeds
    };
    rules.timed.iter().map(|timed| (timed.target, deeds(timed.effect))).collect()
}

/// Returns the part of a timed effect that concerns all sprites of a type. (Effects that need one particular sprite
/// find none.)
fn later(rules: &Rules, timed: u16) -> impl Iterator<Item = Deed> {
    let effect = rules.timed[usize::from(timed)].effect;
    let (deeds, _) = neutral(&rules.effects[usize::from(effect)].effect);
    let at_large = |deed: &Deed| {
        matches!(
            deed,
            Deed::KillAll(_) | Deed::BecomeAll(..) | Deed::Speed(Some(_)) | Deed::Health { of: Some(_), .. }
        )
    };
    deeds.into_iter().filter(at_large)
}

/// Returns the effects and their condition, without the details.
fn neutral(effect: &Effect) -> (SmallVec<[Deed; 2]>, Provided) {
    use Side::{First, Second};
    let always = |deeds: SmallVec<[Deed; 2]>| (deeds, Provided::Always);
    // A second effect, requested by a flag of the first.
    let with = |deed: Deed, flag: bool, more: Deed| {
        let mut deeds: SmallVec<[Deed; 2]> = smallvec![deed];
        deeds.extend(flag.then_some(more));
        deeds
    };
    let chance = |prob: f64| if prob < 1.0 { Provided::Chance(prob) } else { Provided::Always };
    match *effect {
        Effect::KillSprite | Effect::KillIfAlive => always(smallvec![Deed::Kill(First)]),
        Effect::KillBoth => always(smallvec![Deed::Kill(First), Deed::Kill(Second)]),
        Effect::KillAll { stype } => always(smallvec![Deed::KillAll(stype)]),
        Effect::KillIfFromAbove | Effect::KillIfFrontal { .. } => {
            (smallvec![Deed::Kill(First)], Provided::Way)
        }
        Effect::KillIfHasLess { resource, limit } => {
            (smallvec![Deed::Kill(First)], Provided::HoldsAtMost(First, resource, limit))
        }
        Effect::KillIfHasMore { resource, limit } => {
            (smallvec![Deed::Kill(First)], Provided::Holds(First, resource, limit))
        }
        Effect::KillIfOtherHasMore { resource, limit, subtract } => {
            let spend = Deed::Change { who: Second, resource, by: limit.saturating_neg() };
            (with(Deed::Kill(First), subtract, spend), Provided::Holds(Second, resource, limit))
        }
        Effect::AddHealthPoints { value, kill_second, .. } => {
            let health = Deed::Health { of: None, by: value, dies_at: i32::MIN };
            always(with(health, kill_second, Deed::Kill(Second)))
        }
        Effect::SubtractHealthPoints { value, limit, stype, .. } => {
            always(smallvec![Deed::Health { of: stype, by: value.saturating_neg(), dies_at: limit }])
        }
        Effect::StepBack { .. } => always(smallvec![Deed::Stop]),
        Effect::UndoAll { ref spare } => always(smallvec![Deed::Undo(spare.clone())]),
        Effect::TurnAround => always(smallvec![Deed::Stop, Deed::Turn]),
        Effect::ReverseDirection | Effect::FlipDirection => always(smallvec![Deed::Turn]),
        Effect::AttractGaze { prob, .. } => (smallvec![Deed::Turn], chance(prob)),
        Effect::HalfSpeed => always(smallvec![Deed::Speed(None)]),
        Effect::ChangeSpeed { stype, .. } => always(smallvec![Deed::Speed(Some(stype))]),
        Effect::WrapAround { .. } => always(smallvec![Deed::Wrap]),
        Effect::Align { .. } | Effect::PullWithIt { .. } => always(smallvec![Deed::Carry]),
        Effect::BounceForward => always(smallvec![Deed::Push]),
        Effect::TeleportToExit => always(smallvec![Deed::Teleport]),
        Effect::Spawn { stype, prob } => (smallvec![Deed::Make(stype)], chance(prob)),
        Effect::SpawnBeside { stype, step_back, prob, .. } => {
            (smallvec![Deed::Make(stype)], if step_back { Provided::Way } else { chance(prob) })
        }
        Effect::SpawnBehind { stype, .. } => (smallvec![Deed::Make(stype)], Provided::Way),
        Effect::SpawnIf { resource, limit, stype, spend, more, .. } => {
            let spends = Deed::Change { who: First, resource, by: spend.saturating_neg() };
            let provided = if more {
                Provided::Holds(First, resource, limit)
            } else {
                Provided::HoldsAtMost(First, resource, limit)
            };
            (with(Deed::Make(stype), more && spend != 0, spends), provided)
        }
        Effect::CloneSprite => always(smallvec![Deed::Clone]),
        Effect::TransformTo { stype, kill_second, .. } => {
            always(with(Deed::Become(stype), kill_second, Deed::Kill(Second)))
        }
        Effect::TransformToAll { stype, to, kill_second, .. } => {
            always(with(Deed::BecomeAll(stype, to), kill_second, Deed::Kill(Second)))
        }
        Effect::TransformToRandomChild { ref options, kill_second, .. } => {
            always(with(Deed::BecomeAny(options.clone()), kill_second, Deed::Kill(Second)))
        }
        Effect::CollectResource { kill_resource } => {
            always(with(Deed::Collect, kill_resource, Deed::Kill(First)))
        }
        Effect::CollectResourceIfHeld { held, value, kill_resource } => {
            let deeds = with(Deed::Collect, kill_resource, Deed::Kill(First));
            (deeds, Provided::Holds(Second, held, value))
        }
        Effect::ChangeResource { resource, value, kill_resource } => {
            let change = Deed::Change { who: First, resource, by: value };
            always(with(change, kill_resource, Deed::Kill(Second)))
        }
        Effect::KillIfSpeed { .. } | Effect::KillIfNotUpright => {
            (smallvec![Deed::Kill(First)], Provided::Way)
        }
        Effect::RemoveScore { kill_second, .. } => {
            always(if kill_second { smallvec![Deed::Kill(Second)] } else { smallvec![] })
        }
        Effect::UpdateSpawnType { stype, .. } => always(smallvec![Deed::Make(stype)]),
        Effect::SpawnIfCounterSubTypes { stype, otherwise, .. } => {
            (smallvec![Deed::Make(stype), Deed::Make(otherwise)], Provided::Way)
        }
        Effect::TransformIfCount(ref rule) => {
            let mut deeds: SmallVec<[Deed; 2]> = rule.otherwise.into_iter().map(Deed::Become).collect();
            deeds.push(Deed::Become(rule.stype));
            deeds.extend(rule.kill_second.then_some(Deed::Kill(Second)));
            (deeds, Provided::Way)
        }
        Effect::TransformToSingleton { stype, other, .. } => {
            always(smallvec![Deed::Become(stype), Deed::BecomeAll(stype, other)])
        }
        Effect::WaterPhysics => always(smallvec![Deed::Speed(None)]),
        Effect::BounceDirection { .. } => always(smallvec![Deed::Turn]),
        Effect::WallStop => always(smallvec![Deed::Stop]),
        Effect::WallBounce | Effect::WallReverse => always(smallvec![Deed::Stop, Deed::Turn]),
        // The effect happens later: see `later`.
        Effect::AddTimer { .. } | Effect::Disabled(_) => always(smallvec![]),
        Effect::ShieldFrom { stype, keyword } => {
            let keyword =
                crate::ontology::effects::NAMES.get(usize::from(keyword)).copied().unwrap_or_default();
            always(smallvec![Deed::Shield { from: stype, keyword }])
        }
    }
}
