//! Forward-looking analysis of a game or a state: its possible futures, and whether the player sees every
//! relevant sprite.

use super::Analysis;
use super::futures::{PossibleFutures, Start};
use crate::analysis::interactions::encounter::{EffectSummary, Encounter};
use crate::analysis::types::facts::Facts;
use crate::rules::class::SpriteClass;
use crate::rules::{Rules, SpriteType};
use crate::state::State;

impl Analysis {
    /// Returns the relevant types that are invisible to the player. A type is relevant if, in at least one level, it
    /// takes part in interactions, is counted by terminations or interactions, creates other sprites, is a portal's
    /// exit, or is followed by other sprites.
    pub fn unseen(&self) -> &[SpriteType] {
        &self.unseen
    }

    /// Returns `true` if the player sees every relevant sprite in any level: see [`Analysis::unseen`].
    pub fn is_fully_observable(&self) -> bool {
        self.unseen.is_empty()
    }

    /// Returns `true` if the player sees every relevant sprite from this state on. Costs as much as
    /// [`Analysis::is_deterministic_from`].
    pub fn is_fully_observable_from(&self, state: &State) -> bool {
        state.is_over() || unseen(&self.game.0, &self.facts, &self.futures(state), &self.goals).is_empty()
    }

    /// Returns the possible futures of a state.
    pub(super) fn futures(&self, state: &State) -> PossibleFutures<'_> {
        let rules = &*self.game.0;
        let existing: Vec<SpriteType> =
            self.game.sprite_types().filter(|&stype| state.world.group(stype).count > 0).collect();
        // A rule may have changed the type that a spawn point's sprite spawns.
        let spawning = |class: SpriteClass| class.is_a(SpriteClass::SpawnPoint);
        let spawners = existing.iter().filter(|stype| rules.types[stype.index()].class.is_some_and(spawning));
        let making = spawners
            .flat_map(|&stype| state.world.slots(stype))
            .map(|slot| state.world.overrides(slot).spawns);
        let making = making.filter(|&stype| stype != SpriteType::NONE).collect();
        let mut held = vec![false; rules.types.len()];
        for holding in state.world.held().iter().filter(|holding| holding.amount > 0) {
            held[holding.resource.index()] = true;
        }
        let scheduled = state.world.timers().iter().map(|timer| timer.timed).collect();
        let start = Start { existing, making, scheduled, held: Some(held) };
        PossibleFutures::of(rules, &self.facts, &self.encounters, start)
    }
}

/// Returns the relevant types that can exist and are invisible to the player.
pub(super) fn unseen(
    rules: &Rules,
    facts: &[Facts],
    futures: &PossibleFutures<'_>,
    goals: &[super::Goal],
) -> Vec<SpriteType> {
    let hidden = |at: &usize| futures.exists[*at] && facts[*at].hidden;
    let hidden: Vec<usize> = (0..facts.len()).filter(hidden).collect();
    if hidden.is_empty() {
        return Vec::new();
    }
    let mut matters: Vec<bool> = facts.iter().map(|fact| !fact.makes.is_empty()).collect();
    let mut mark = |stypes: &[SpriteType]| {
        stypes.iter().for_each(|stype| matters[stype.index()] = true);
    };
    goals.iter().for_each(|goal| mark(goal.condition.types()));
    let family = |stype: SpriteType| &*rules.types[stype.index()].tree;
    for (info, _) in rules.types.iter().zip(&futures.exists).filter(|(_, exists)| **exists) {
        // Mark the types that the sprites chase, flee from, or lead to.
        info.traits
            .stypes
            .iter()
            .filter(|&&stype| stype != SpriteType::NONE)
            .for_each(|&stype| mark(family(stype)));
    }
    let live = futures.encounters().iter().zip(&futures.live).filter(|(_, live)| **live);
    for (encounter, _) in live {
        let Encounter { first, second, effect, .. } = encounter;
        mark(family(*first));
        second.iter().for_each(|second| mark(family(*second)));
        let counted = rules.effects[usize::from(*effect)].summary.counts;
        counted
            .filter(|&counted| counted != SpriteType::NONE)
            .into_iter()
            .for_each(|counted| mark(family(counted)));
        for effect in &encounter.effects {
            if let EffectSummary::BecomeAll(from, _) = effect {
                mark(&[*from]);
            }
        }
    }
    let timed = rules.timed.iter().zip(&futures.timed).filter(|(_, live)| **live);
    timed.filter_map(|(timed, _)| timed.target).for_each(|target| mark(family(target)));
    hidden.into_iter().filter(|&at| matters[at]).map(|at| SpriteType(at as u16)).collect()
}
