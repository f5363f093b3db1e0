//! Sprites of one type that the rules cannot distinguish, either by identity or by orientation.

use super::Analysis;
use super::abstraction::changes_afar;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter};
use crate::analysis::types::facts::{Motion, makes};
use crate::rules::class::SpriteClass;
use crate::rules::effects::{OrientationRead, Provided};
use crate::rules::{EffectInfo, Rules, SpriteType, TypeInfo};

impl Analysis {
    /// Returns, for each type, whether exchanging two of its sprites makes no difference except to their
    /// identities.
    ///
    /// Sprites of a type are interchangeable under three conditions. Each sprite's update affects only that
    /// sprite. Nothing searches for the nearest sprite of the type. Every rule that involves the type gives
    /// the same result regardless of the order in which it processes the sprites.
    pub(super) fn interchangeable(&self) -> Vec<bool> {
        let rules = &*self.game.0;
        let types = rules.types.len();
        if rules.reads_score || rules.reads_counters {
            return vec![false; types];
        }
        let mut interchangeable: Vec<bool> = rules.types.iter().map(is_by_itself).collect();
        for info in &rules.types {
            let makes = info.class.map_or(Vec::new(), |class| makes(class, &info.traits));
            for named in info.traits.stypes.iter().filter(|named| !makes.contains(named)) {
                let Some(named) = rules.types.get(named.index()) else { continue };
                for stype in &named.tree {
                    interchangeable[stype.index()] = false;
                }
            }
        }
        for timed in &rules.timed {
            let Some(target) = timed.target.and_then(|target| rules.types.get(target.index())) else {
                continue;
            };
            for stype in &target.tree {
                interchangeable[stype.index()] = false;
            }
        }
        for encounter in &self.encounters {
            let info = &rules.effects[usize::from(encounter.effect)];
            let family = |written: SpriteType| &rules.types[written.index()];
            let (first, second) = (family(encounter.first), encounter.second.map(family));
            for (at, interchangeable) in interchangeable.iter_mut().enumerate() {
                let stype = SpriteType(at as u16);
                let is_first = first.in_tree(stype);
                let is_second = second.is_some_and(|second| second.in_tree(stype));
                *interchangeable &= match (is_first, is_second) {
                    (false, false) => !is_special(encounter, rules, stype),
                    (true, false) => holds(info.summary.is_local_to_first, rules, encounter, info),
                    (false, true) => holds(info.summary.is_partner_independent, rules, encounter, info),
                    (true, true) => is_undo(info),
                };
            }
        }
        // If a type turns into a type whose order matters, the new sprites appear in the order of the old
        // ones, so that order matters, too.
        loop {
            let mut changed = false;
            for encounter in &self.encounters {
                for effect in &encounter.effects {
                    let EffectSummary::Become(to) = effect else { continue };
                    if interchangeable[to.index()] {
                        continue;
                    }
                    for stype in &rules.types[encounter.first.index()].tree {
                        changed |= std::mem::take(&mut interchangeable[stype.index()]);
                    }
                }
            }
            if !changed {
                return interchangeable;
            }
        }
    }

    /// Returns, for each type, whether the rules ignore the orientation of its sprites, as long as the
    /// sprites are not oriented.
    pub(super) fn orientation_irrelevant(&self) -> Vec<bool> {
        use SpriteClass as C;
        let rules = &*self.game.0;
        let plain = |info: &TypeInfo| {
            matches!(info.class, Some(C::Immovable | C::Passive | C::Door | C::Resource))
                && !info.traits.continuous
                && !info.traits.is_oriented
                && !info.traits.oriented_image
                && !info.ground_aware
        };
        let by_itself = rules.types.iter().zip(&self.facts);
        let mut orientation_irrelevant: Vec<bool> =
            by_itself.map(|(info, facts)| plain(info) && facts.motion == Motion::Still).collect();
        for encounter in &self.encounters {
            let reads = rules.effects[usize::from(encounter.effect)].summary.reads_orientation;
            let first = &rules.types[encounter.first.index()];
            let second = encounter.second.map(|second| &rules.types[second.index()]);
            for (orientation_irrelevant, at) in orientation_irrelevant.iter_mut().zip(0u16..) {
                let stype = SpriteType(at);
                *orientation_irrelevant &= !first.in_tree(stype) || reads != OrientationRead::Either;
                *orientation_irrelevant &=
                    !second.is_some_and(|second| second.in_tree(stype)) || reads == OrientationRead::Neither;
            }
        }
        orientation_irrelevant
    }
}

/// Returns `true` if the update of each of the type's sprites affects only that sprite.
fn is_by_itself(info: &TypeInfo) -> bool {
    use SpriteClass as C;
    let plain = matches!(
        info.class,
        Some(
            C::Immovable
                | C::Passive
                | C::Door
                | C::Resource
                | C::Conveyor
                | C::Missile
                | C::Flicker
                | C::OrientedFlicker
        )
    );
    plain
        && !info.singleton
        && !info.ground_aware
        && !info.first_differs
        && !info.traits.continuous
        && !info.traits.is_avatar
        && !info.repeats()
}

/// Returns `true` if a rule between other types processes sprites of this type one by one, so that their
/// order can matter.
fn is_special(encounter: &Encounter, rules: &Rules, stype: SpriteType) -> bool {
    let info = &rules.types[stype.index()];
    let treats_all_alike = |effect: &EffectSummary| {
        matches!(
            effect,
            EffectSummary::KillAll(_)
                | EffectSummary::Become(_)
                | EffectSummary::Make(_)
                | EffectSummary::BecomeAny(_)
        )
    };
    encounter.does(|effect| !treats_all_alike(effect) && changes_afar(effect, info, stype))
}

/// Returns `true` if the effect does not change the score, and its executions are neither counted nor
/// batched.
fn is_free(encounter: &Encounter, info: &EffectInfo) -> bool {
    encounter.score == 0 && info.score_change == 0 && info.counting.is_none() && !info.in_batch
}

/// Returns `true` if an effect has a property in an interaction. `property` is the condition under which
/// effects have that property.
fn holds(property: Provided, rules: &Rules, encounter: &Encounter, info: &EffectInfo) -> bool {
    let provided = match property {
        Provided::Never => false,
        Provided::Free => is_free(encounter, info),
        Provided::Always => true,
    };
    provided && !info.in_batch && !rules.remembering.contains(&encounter.effect)
}

/// Returns `true` if the effect moves everything back, regardless of the colliding sprites.
fn is_undo(info: &EffectInfo) -> bool {
    info.summary.undoes().is_some() && info.score_change == 0 && info.counting.is_none()
}
