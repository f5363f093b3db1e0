//! Interactions in summarised form: the two sprites, the effects and the condition.

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
    fn names(&self, stype: SpriteType) -> bool {
        match self {
            EffectSummary::Make(made)
            | EffectSummary::Become(made)
            | EffectSummary::Change { resource: made, .. } => *made == stype,
            EffectSummary::Health { of, .. } => *of == Some(stype),
            _ => false,
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

/// One interaction line with one of its partners, in summarised form.
#[derive(Clone, Debug)]
pub struct Encounter {
    /// The type named first, as written. The rule holds for its whole tree (see
    /// [`Analysis::applies`](super::Analysis::applies)).
    pub first: SpriteType,
    /// The partner, as written; none: the edge of the screen.
    pub second: Option<SpriteType>,
    /// The effects, in order.
    pub effects: SmallVec<[EffectSummary; 2]>,
    /// The condition.
    pub precondition: Precondition,
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
    pub fn does(&self, wanted: impl Fn(&EffectSummary) -> bool) -> bool {
        self.effects.iter().any(wanted)
    }

    /// Returns `true` if the first sprite is blocked: it, or everything, moves back.
    pub fn blocks(&self) -> bool {
        self.does(|effect| matches!(effect, EffectSummary::Stop | EffectSummary::Undo(_)))
    }

    /// Returns `true` if the sprite of that side is removed or turns into another type.
    pub fn ends(&self, side: Side) -> bool {
        self.does(|effect| match effect {
            EffectSummary::Kill(killed) => *killed == side,
            EffectSummary::Become(_) | EffectSummary::BecomeAny(_) => side == Side::First,
            EffectSummary::Health { of: None, by, .. } => side == Side::First && *by < 0,
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
        let (mut effects, mut precondition) = summarise(&info.effect);
        if let Effect::AddTimer { timed } = info.effect {
            effects.extend(global_part(rules, timed));
        }
        // Effects on or with undeclared types, in games loaded as the reference does, never happen.
        effects.retain(|effect| !effect.names(SpriteType::NONE));
        if matches!(precondition, Precondition::Holds(_, SpriteType::NONE, _)) {
            precondition = Precondition::Movement;
        }
        let score = match info.effect {
            Effect::SubtractHealthPoints { score_if_killed, .. } if score_if_killed != 0 => score_if_killed,
            _ if info.apply_score => info.score_change,
            _ => 0,
        };
        Encounter { first, second, effects, precondition, score, line: info.line, effect, keyword }
    };
    seen.into_iter().map(encounter).collect()
}

/// Returns the timed effects, each with the type of its target (none: no particular sprite).
pub(super) fn timed_effects(rules: &Rules) -> Vec<(Option<SpriteType>, SmallVec<[EffectSummary; 2]>)> {
    let effects = |effect: u16| {
        let (mut effects, _) = summarise(&rules.effects[usize::from(effect)].effect);
        effects.retain(|effect| !effect.names(SpriteType::NONE));
        effects
    };
    rules.timed.iter().map(|timed| (timed.target, effects(timed.effect))).collect()
}

/// Returns the part of a timed effect that concerns all sprites of a type. (Effects that need one particular sprite
/// find none.)
fn global_part(rules: &Rules, timed: u16) -> impl Iterator<Item = EffectSummary> {
    let effect = rules.timed[usize::from(timed)].effect;
    let (effects, _) = summarise(&rules.effects[usize::from(effect)].effect);
    let at_large = |effect: &EffectSummary| {
        matches!(
            effect,
            EffectSummary::KillAll(_)
                | EffectSummary::BecomeAll(..)
                | EffectSummary::Speed(Some(_))
                | EffectSummary::Health { of: Some(_), .. }
        )
    };
    effects.into_iter().filter(at_large)
}

/// Returns the effects and their condition, without the details.
fn summarise(effect: &Effect) -> (SmallVec<[EffectSummary; 2]>, Precondition) {
    use Side::{First, Second};
    let always = |effects: SmallVec<[EffectSummary; 2]>| (effects, Precondition::Always);
    // A second effect, requested by a flag of the first.
    let with = |effect: EffectSummary, flag: bool, more: EffectSummary| {
        let mut effects: SmallVec<[EffectSummary; 2]> = smallvec![effect];
        effects.extend(flag.then_some(more));
        effects
    };
    let chance = |prob: f64| if prob < 1.0 { Precondition::Chance(prob) } else { Precondition::Always };
    match *effect {
        Effect::KillSprite | Effect::KillIfAlive => always(smallvec![EffectSummary::Kill(First)]),
        Effect::KillBoth => always(smallvec![EffectSummary::Kill(First), EffectSummary::Kill(Second)]),
        Effect::KillAll { stype } => always(smallvec![EffectSummary::KillAll(stype)]),
        Effect::KillIfFromAbove
        | Effect::KillIfFrontal { .. }
        | Effect::KillIfSpeed { .. }
        | Effect::KillIfNotUpright => (smallvec![EffectSummary::Kill(First)], Precondition::Movement),
        Effect::KillIfHasLess { resource, limit } => {
            (smallvec![EffectSummary::Kill(First)], Precondition::HoldsAtMost(First, resource, limit))
        }
        Effect::KillIfHasMore { resource, limit } => {
            (smallvec![EffectSummary::Kill(First)], Precondition::Holds(First, resource, limit))
        }
        Effect::KillIfOtherHasMore { resource, limit, subtract } => {
            let spend = EffectSummary::Change { side: Second, resource, by: limit.saturating_neg() };
            (with(EffectSummary::Kill(First), subtract, spend), Precondition::Holds(Second, resource, limit))
        }
        Effect::AddHealthPoints { value, kill_second, .. } => {
            let health = EffectSummary::Health { of: None, by: value, dies_at: i32::MIN };
            always(with(health, kill_second, EffectSummary::Kill(Second)))
        }
        Effect::SubtractHealthPoints { value, limit, stype, .. } => {
            always(smallvec![EffectSummary::Health { of: stype, by: value.saturating_neg(), dies_at: limit }])
        }
        Effect::StepBack { .. } => always(smallvec![EffectSummary::Stop]),
        Effect::UndoAll { ref spare } => always(smallvec![EffectSummary::Undo(spare.clone())]),
        Effect::TurnAround => always(smallvec![EffectSummary::Stop, EffectSummary::Turn]),
        Effect::ReverseDirection | Effect::FlipDirection => always(smallvec![EffectSummary::Turn]),
        Effect::AttractGaze { prob, .. } => (smallvec![EffectSummary::Turn], chance(prob)),
        Effect::HalfSpeed => always(smallvec![EffectSummary::Speed(None)]),
        Effect::ChangeSpeed { stype, .. } => always(smallvec![EffectSummary::Speed(Some(stype))]),
        Effect::WrapAround { .. } => always(smallvec![EffectSummary::Wrap]),
        Effect::Align { .. } | Effect::PullWithIt { .. } => always(smallvec![EffectSummary::Carry]),
        Effect::BounceForward => always(smallvec![EffectSummary::Push]),
        Effect::TeleportToExit => always(smallvec![EffectSummary::Teleport]),
        Effect::Spawn { stype, prob } => (smallvec![EffectSummary::Make(stype)], chance(prob)),
        Effect::SpawnBeside { stype, step_back, prob, .. } => (
            smallvec![EffectSummary::Make(stype)],
            if step_back { Precondition::Movement } else { chance(prob) },
        ),
        Effect::SpawnBehind { stype, .. } => (smallvec![EffectSummary::Make(stype)], Precondition::Movement),
        Effect::SpawnIf { resource, limit, stype, spend, more, .. } => {
            let spends = EffectSummary::Change { side: First, resource, by: spend.saturating_neg() };
            let precondition = if more {
                Precondition::Holds(First, resource, limit)
            } else {
                Precondition::HoldsAtMost(First, resource, limit)
            };
            (with(EffectSummary::Make(stype), more && spend != 0, spends), precondition)
        }
        Effect::CloneSprite => always(smallvec![EffectSummary::Clone]),
        Effect::TransformTo { stype, kill_second, .. } => {
            always(with(EffectSummary::Become(stype), kill_second, EffectSummary::Kill(Second)))
        }
        Effect::TransformToAll { stype, to, kill_second, .. } => {
            always(with(EffectSummary::BecomeAll(stype, to), kill_second, EffectSummary::Kill(Second)))
        }
        Effect::TransformToRandomChild { ref options, kill_second, .. } => {
            always(with(EffectSummary::BecomeAny(options.clone()), kill_second, EffectSummary::Kill(Second)))
        }
        Effect::CollectResource { kill_resource } => {
            always(with(EffectSummary::Collect, kill_resource, EffectSummary::Kill(First)))
        }
        Effect::CollectResourceIfHeld { held, value, kill_resource } => {
            let effects = with(EffectSummary::Collect, kill_resource, EffectSummary::Kill(First));
            (effects, Precondition::Holds(Second, held, value))
        }
        Effect::ChangeResource { resource, value, kill_resource } => {
            let change = EffectSummary::Change { side: First, resource, by: value };
            always(with(change, kill_resource, EffectSummary::Kill(Second)))
        }
        Effect::RemoveScore { kill_second, .. } => {
            always(if kill_second { smallvec![EffectSummary::Kill(Second)] } else { smallvec![] })
        }
        Effect::UpdateSpawnType { stype, .. } => always(smallvec![EffectSummary::Make(stype)]),
        Effect::SpawnIfCounterSubTypes { stype, otherwise, .. } => {
            (smallvec![EffectSummary::Make(stype), EffectSummary::Make(otherwise)], Precondition::Movement)
        }
        Effect::TransformIfCount(ref rule) => {
            let mut effects: SmallVec<[EffectSummary; 2]> =
                rule.otherwise.into_iter().map(EffectSummary::Become).collect();
            effects.push(EffectSummary::Become(rule.stype));
            effects.extend(rule.kill_second.then_some(EffectSummary::Kill(Second)));
            (effects, Precondition::Movement)
        }
        Effect::TransformToSingleton { stype, other, .. } => {
            always(smallvec![EffectSummary::Become(stype), EffectSummary::BecomeAll(stype, other)])
        }
        Effect::WaterPhysics => always(smallvec![EffectSummary::Speed(None)]),
        Effect::BounceDirection { .. } => always(smallvec![EffectSummary::Turn]),
        Effect::WallStop => always(smallvec![EffectSummary::Stop]),
        Effect::WallBounce | Effect::WallReverse => {
            always(smallvec![EffectSummary::Stop, EffectSummary::Turn])
        }
        // The effect happens later: see `global_part`.
        Effect::AddTimer { .. } | Effect::Disabled(_) => always(smallvec![]),
        Effect::ShieldFrom { stype, keyword } => {
            let keyword =
                crate::ontology::effects::NAMES.get(usize::from(keyword)).copied().unwrap_or_default();
            always(smallvec![EffectSummary::Shield { from: stype, keyword }])
        }
    }
}
