//! Summaries of interactions: the two sprites, the effects and the condition.

pub use crate::rules::effects::{EffectSummary, Precondition, Side};
use crate::rules::effects::{Ending, Target};
use crate::rules::{Rules, SpriteType};
use smallvec::SmallVec;

/// A summary of one interaction line for one of its partners.
#[derive(Clone, Debug)]
pub struct Encounter {
    /// The first type, as written. The rule also applies to all related types in the SpriteSet (see
    /// [`Analysis::applies`](crate::analysis::Analysis::applies)).
    pub first: SpriteType,
    /// The partner, as written, or `None` for the edge of the screen.
    pub second: Option<SpriteType>,
    /// The effects, in order of execution.
    pub effects: SmallVec<[EffectSummary; 2]>,
    /// The condition under which the interaction happens.
    pub precondition: Precondition,
    /// The score change if the interaction happens.
    pub score: i32,
    /// The index of the interaction's line in [`Description::interactions`](crate::Description).
    pub line: usize,
    /// The index of the effect with all its parameters.
    pub(crate) effect: u16,
    /// The keyword index of the effect, for matching shields.
    pub(crate) keyword: u16,
}

impl Encounter {
    /// Returns `true` if `wanted` accepts one of the effects.
    pub fn does(&self, wanted: impl Fn(&EffectSummary) -> bool) -> bool {
        self.effects.iter().any(wanted)
    }

    /// Returns `true` if the interaction blocks the first sprite by moving back either that sprite or every
    /// sprite.
    pub fn blocks(&self) -> bool {
        self.does(|effect| matches!(effect, EffectSummary::Stop | EffectSummary::Undo(_)))
    }

    /// Returns `true` if a sprite of one of these types definitely appears, or if the first sprite definitely
    /// turns into one. `types` must be sorted.
    pub(crate) fn brings_one_of(&self, types: &[SpriteType]) -> bool {
        self.does(|effect| {
            let (EffectSummary::Become(to) | EffectSummary::Make(to)) = effect else { return false };
            types.binary_search(to).is_ok()
        })
    }

    /// Returns `true` if the sprite on this side is removed or turns into a sprite of a different type.
    pub fn ends(&self, side: Side) -> bool {
        self.does(|effect| match effect.ending() {
            Some((target, Ending::Killed | Ending::Turned)) => target == Target::Side(side),
            Some((target, Ending::Health { by, .. })) => target == Target::Side(side) && by < 0,
            Some((_, Ending::Stranded)) | None => false,
        })
    }
}

/// Returns all interactions in the order in which a tick checks them, without duplicates. Interactions with
/// the edge come first.
pub(crate) fn encounters(rules: &Rules) -> Vec<Encounter> {
    let mut seen: Vec<(SpriteType, Option<SpriteType>, u16, u16)> = Vec::new();
    // No sprite can be shielded against the edge.
    let edge = rules.edge.iter().map(|&(stype, effect)| (stype, None, effect, u16::MAX));
    let pairs = rules.passes.iter().map(|pass| (pass.first, Some(pass.second), pass.effect, pass.keyword));
    for key in edge.chain(pairs) {
        // Duplicate passes and edge effects are close together.
        if !seen.iter().rev().take(64).any(|other| *other == key) {
            seen.push(key);
        }
    }
    let encounter = |(first, second, effect, keyword): (SpriteType, Option<SpriteType>, u16, u16)| {
        let info = &rules.effects[usize::from(effect)];
        // At the edge, an effect that needs a partner only changes the score.
        let runs = second.is_some() || !info.summary.needs_partner;
        let mut effects = if runs { info.summary.effects.clone() } else { SmallVec::new() };
        effects.extend(info.summary.schedules.into_iter().flat_map(|timed| global_part(rules, timed)));
        let mut precondition = info.summary.precondition;
        // In games loaded in reference mode, effects that involve undeclared types never happen.
        effects.retain(|effect| !effect.names(SpriteType::NONE));
        if matches!(precondition, Precondition::Holds(_, SpriteType::NONE, _)) {
            precondition = Precondition::Movement;
        }
        let score = match info.summary.score_if_killed {
            0 if info.apply_score => info.score_change,
            if_killed => if_killed,
        };
        Encounter { first, second, effects, precondition, score, line: info.line, effect, keyword }
    };
    seen.into_iter().map(encounter).collect()
}

/// Returns the timed effects, each with its target type. The target is `None` if the effect does not run on
/// any particular sprite.
pub(crate) fn timed_effects(rules: &Rules) -> Vec<(Option<SpriteType>, SmallVec<[EffectSummary; 2]>)> {
    let effects = |effect: u16| {
        let mut effects = rules.effects[usize::from(effect)].summary.effects.clone();
        effects.retain(|effect| !effect.names(SpriteType::NONE));
        effects
    };
    rules.timed.iter().map(|timed| (timed.target, effects(timed.effect))).collect()
}

/// Returns the part of a timed effect that applies to all sprites of a type. A timed effect that needs one
/// particular sprite does nothing.
fn global_part(rules: &Rules, timed: u16) -> impl Iterator<Item = EffectSummary> {
    let effect = rules.timed[usize::from(timed)].effect;
    let effects = &rules.effects[usize::from(effect)].summary.effects;
    effects.iter().filter(|effect| effect.at_large().is_some()).cloned()
}
