//! The highest score that a level allows, if the rules limit it.

use crate::analysis::Analysis;
use crate::analysis::interactions::encounter::Side;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{EffectFamily, EffectSummary, Gives, OrientationRead, Precondition, Summary};
use crate::state::State;

impl Analysis {
    /// Returns a score that no episode from the start of a level exceeds; `None` if no limit can be proved.
    ///
    /// A limit is proved only if every gain uses up a sprite of a type that nothing creates, and if only the avatar or
    /// the edge of the screen can cause the gain. The limit is the sum of the gains for all sprites at the start. It
    /// may be out of reach, for example if the player cannot carry enough keys for all doors. Cost: O(interactions ×
    /// (types + interactions)).
    pub fn most_points(&self, start: &State) -> Option<i64> {
        let rules = &*self.game.0;
        if self.has_timed_effects() {
            return None;
        }
        let types: Vec<SpriteType> = self.game.sprite_types().collect();
        let tree = |written: SpriteType| types.iter().copied().filter(move |&t| self.applies(written, t));
        let is_avatar = |stype: SpriteType| self.game.class(stype).is_some_and(SpriteClass::is_avatar);
        let avatars: Vec<SpriteType> = types.iter().copied().filter(|&stype| is_avatar(stype)).collect();
        let is_single = avatars.iter().map(|&stype| start.alive(stype)).sum::<usize>() <= 1;
        if !is_single || !avatars.iter().all(|&stype| self.is_never_made(stype)) {
            return None;
        }
        let edge = rules.edge.iter().map(|&(stype, effect)| (stype, None, effect));
        let passes = rules.passes.iter().map(|pass| (pass.first, Some(pass.second), pass.effect));
        let mut most = 0_i64;
        // A repeated pass executes its effect again in the same tick, so it counts again.
        for (first, second, effect) in edge.chain(passes) {
            let info = &rules.effects[usize::from(effect)];
            let gain = i64::from(info.score_change.max(info.summary.score_if_killed));
            let occurs = |written: SpriteType| tree(written).any(|stype| self.can_exist(stype));
            if gain <= 0 || !occurs(first) || !second.is_none_or(occurs) {
                continue;
            }
            let (used, other) = match (used_up(&info.summary), second) {
                (Some(Side::First), Some(second)) => (first, Some(second)),
                (Some(Side::Second), Some(second)) => (second, Some(first)),
                (Some(Side::First), None) if !info.summary.needs_partner => (first, None),
                _ => return None,
            };
            let meets_avatar =
                other.is_none_or(|other| tree(other).all(|t| is_avatar(t) || !self.can_exist(t)));
            let gives = matches!(info.summary.gives, Some(Gives::First { .. }));
            let is_fit = |stype: SpriteType| {
                let traits = &rules.types[stype.index()].traits;
                !is_avatar(stype) && self.is_never_made(stype) && (!gives || traits.is_resource)
            };
            if !meets_avatar || !tree(used).filter(|&stype| self.can_exist(stype)).all(is_fit) {
                return None;
            }
            let count: usize = tree(used).map(|stype| start.alive(stype)).sum();
            most = most.saturating_add(gain.saturating_mul(count as i64));
        }
        Some(most)
    }

    /// Returns `true` if no sprite and no effect ever creates a sprite of the type.
    fn is_never_made(&self, stype: SpriteType) -> bool {
        let makes = |maker: SpriteType| self.can_exist(maker) && self.facts(maker).makes.contains(&stype);
        let made = |effect: &EffectSummary| effect.makes().contains(&stype);
        let cloned = self
            .encounters
            .iter()
            .any(|met| met.does(|effect| *effect == EffectSummary::Clone) && self.applies(met.first, stype));
        !cloned && !self.game.sprite_types().any(makes) && !self.any_effect(made)
    }
}

/// Returns the side whose sprite disappears whenever the effect changes the score; `None` if there is no such side.
fn used_up(summary: &Summary) -> Option<Side> {
    let kills = |side| summary.effects.contains(&EffectSummary::Kill(side));
    // The summary of killIfAlive does not state its condition, and effects with conditions on movement may change the
    // score without a kill. Only effects without such a condition declare that they read no orientation.
    let is_unconditional = summary.precondition != Precondition::Movement
        && summary.reads_orientation == OrientationRead::Neither;
    if summary.family == EffectFamily::Kill {
        return (is_unconditional && kills(Side::First)).then_some(Side::First);
    }
    match summary.gives {
        Some(Gives::First { used_up: true }) => Some(Side::First),
        Some(Gives::Amount { used_up: true, .. }) => Some(Side::Second),
        Some(Gives::First { used_up: false } | Gives::Amount { used_up: false, .. }) | None => None,
    }
}
