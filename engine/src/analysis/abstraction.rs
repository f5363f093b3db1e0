//! State abstractions, which define the parts of a state that a search can ignore when it compares
//! successors.

use super::Analysis;
use super::futures::PossibleFutures;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Side, timed_effects};
use crate::analysis::types::facts::Motion;
use crate::rules::class::SpriteClass;
use crate::rules::terminations::{Condition, Decision, Termination};
use crate::rules::traits::BLOCK_PAUSE;
use crate::rules::{SpriteType, TypeInfo};
use crate::state::State;
use crate::world::SearchKey;

/// The state abstraction for a search from a single state, the root state.
///
/// In addition to the parts that [`State::search_key`] omits, the key omits:
/// - sprites of types that nothing changes, creates or removes, because these sprites are the same in all
///   successors;
/// - the order of a type's sprites, and their orientation, if the rules cannot distinguish them;
/// - the random state, if it has no effect after the root state;
/// - the phases of spawners that can no longer appear;
/// - the tick, if only a losing Timeout reads it: see [`StateAbstraction::earlier_is_better`].
#[derive(Clone, Debug)]
pub struct StateAbstraction {
    pub(crate) tick: bool,
    pub(crate) chance: bool,
    pub(crate) clocks: Vec<i32>,
    pub(crate) wizard_ticks: Vec<i32>,
    /// For each type, whether its sprites are the same in all successors.
    pub(crate) constant: Vec<bool>,
    pub(crate) interchangeable: Vec<bool>,
    pub(crate) orientation_irrelevant: Vec<bool>,
    earlier_is_better: bool,
}

impl StateAbstraction {
    /// Returns `true` if keys omit the tick even though the game can be lost because a certain tick is reached. In that
    /// case, if two states have the same key and the game can be won from the later state, it can also be won from the
    /// earlier one. A search that visits states in tick order, such as breadth-first search, therefore loses nothing by
    /// dropping the later state.
    pub fn earlier_is_better(&self) -> bool {
        self.earlier_is_better
    }

    /// Returns the same abstraction, but with keys that omit the random state, for searches that assume the
    /// same random future for all states. States with equal keys may then have different futures.
    #[must_use]
    pub fn without_chance(self) -> StateAbstraction {
        StateAbstraction { chance: false, ..self }
    }

    /// Returns `true` if sprites of the type are the same in all successors: nothing changes, creates or
    /// removes them.
    pub fn is_constant(&self, stype: SpriteType) -> bool {
        self.constant[stype.index()]
    }

    /// Returns `true` if randomness can have an effect after the root state, in which case keys include the
    /// random state.
    pub fn reads_chance(&self) -> bool {
        self.chance
    }

    /// Returns the key for a successor of the root state. Two successors with equal keys also have equal keys
    /// and outcomes after the same actions, except for losses by Timeout if
    /// [`StateAbstraction::earlier_is_better`] returns `true`. Cost: O(sprites of types that can change).
    pub fn key(&self, analysis: &Analysis, state: &State) -> SearchKey {
        state.key_left_out(&analysis.game.0, self)
    }

    /// Returns the 64-bit words that [`StateAbstraction::key`] hashes, for detecting hash collisions.
    pub fn words(&self, analysis: &Analysis, state: &State) -> Vec<u64> {
        state.words_left_out(&analysis.game.0, self)
    }
}

impl Analysis {
    /// Returns the state abstraction for a search that starts from this state. Cost: O(types × interactions).
    pub fn abstraction(&self, state: &State) -> StateAbstraction {
        let rules = &*self.game.0;
        let futures = self.futures(state);
        let made = |wanted: fn(SpriteClass) -> bool| {
            let types = rules.types.iter().zip(&futures.made);
            let types = types.filter(move |(info, made)| **made && info.class.is_some_and(wanted));
            types.map(|(info, _)| &info.traits)
        };
        let clocks = made(SpriteClass::is_spawner).map(|traits| traits.cooldown);
        let clocks = rules.clocks.iter().copied().filter(|clock| clocks.clone().any(|made| made == *clock));
        let is_wizard = |class: SpriteClass| class == SpriteClass::WizardAvatar;
        let first_blocks = made(is_wizard).map(|traits| traits.last_block_time.wrapping_add(BLOCK_PAUSE));
        let wizard_ticks = rules.wizard_ticks.iter().copied();
        let wizard_ticks =
            wizard_ticks.filter(|first| first_blocks.clone().any(|made| made == *first)).collect();
        let by_timeout = |end: &&Termination| matches!(end.condition, Condition::Timeout { .. });
        let mut timeouts = rules.terminations.iter().filter(by_timeout);
        let lose = timeouts.all(|end| end.decided_by == Decision::Line && !end.win);
        let constant = self.constant(&futures);
        StateAbstraction {
            tick: rules.reads_tick && !lose,
            chance: !state.is_over() && !self.is_deterministic_from(state),
            clocks: clocks.collect(),
            wizard_ticks,
            interchangeable: self.interchangeable(),
            orientation_irrelevant: self.orientation_irrelevant(),
            constant,
            earlier_is_better: rules.reads_tick && lose,
        }
    }

    /// Returns, for each type, whether its sprites stay the same in all possible futures: nothing changes,
    /// creates or removes them.
    fn constant(&self, futures: &PossibleFutures<'_>) -> Vec<bool> {
        let rules = &*self.game.0;
        let mut constant: Vec<bool> =
            self.game.sprite_types().map(|stype| self.is_inert(stype, futures)).collect();
        let mut spoil = |changes: &dyn Fn(&TypeInfo, SpriteType) -> bool| {
            for ((at, info), constant) in (0u16..).zip(&rules.types).zip(&mut constant) {
                *constant &= !changes(info, SpriteType(at));
            }
        };
        for encounter in &self.encounters {
            spoil(&|info, _| info.in_tree(encounter.first) && changes_first(encounter));
            if let Some(second) = encounter.second {
                spoil(&|info, _| info.in_tree(second) && changes_second(encounter));
            }
        }
        let scheduled = timed_effects(rules);
        let scheduled = scheduled.iter().map(|(target, effects)| (*target, effects.as_slice()));
        let met = self.encounters.iter().map(|encounter| (None, encounter.effects.as_slice()));
        for (target, effects) in scheduled.chain(met) {
            spoil(&|info, _| target.is_some_and(|target| info.in_tree(target)));
            for effect in effects {
                spoil(&|info, stype| changes_afar(effect, info, stype));
            }
        }
        constant
    }

    /// Returns `true` if sprites of the type never act on their own.
    fn is_inert(&self, stype: SpriteType, futures: &PossibleFutures<'_>) -> bool {
        use SpriteClass as C;
        let (facts, info) = (self.facts(stype), &self.game.0.types[stype.index()]);
        let plain = matches!(info.class, Some(C::Immovable | C::Passive | C::Door | C::Resource));
        plain
            && facts.motion == Motion::Still
            && facts.makes.is_empty()
            && !facts.fleeting
            && !futures.made[stype.index()]
            && !info.traits.continuous
            && !info.ground_aware
    }
}

fn changes_first(encounter: &Encounter) -> bool {
    let harmless = |effect: &EffectSummary| {
        matches!(
            effect,
            EffectSummary::Make(_)
                | EffectSummary::KillAll(_)
                | EffectSummary::BecomeAll(..)
                | EffectSummary::Shield { .. }
                | EffectSummary::Kill(Side::Second)
                | EffectSummary::Undo(_)
        )
    };
    !encounter.effects.iter().all(harmless)
}

fn changes_second(encounter: &Encounter) -> bool {
    encounter.does(|effect| effect.changes(Side::Second))
}

/// Returns `true` if the effect applies to all sprites of the type, not only to the sprites that collided.
pub(super) fn changes_afar(effect: &EffectSummary, info: &TypeInfo, stype: SpriteType) -> bool {
    effect.at_large().is_some_and(|of| info.in_tree(of)) || effect.makes().contains(&stype)
}
