//! Forward-looking questions about a game or a state: can chance decide anything, and is every relevant sprite visible?

use super::Analysis;
use super::futures::{PossibleFutures, Start};
use crate::analysis::interactions::encounter::{EffectSummary, Encounter};
use crate::analysis::types::facts::Facts;
use crate::numbers::geometry::Direction;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::effects::Draws;
use crate::rules::{Rules, SpriteType};
use crate::state::State;

impl Analysis {
    /// Returns `true` if chance can decide anything in some level. Draws with a certain outcome do not count, so this
    /// can be `false` where [`Game::is_deterministic`](crate::Game::is_deterministic) is `false`, too. If this is
    /// `false`, the same actions always give the same sprites, scores and outcomes.
    pub fn is_stochastic(&self) -> bool {
        self.is_stochastic
    }

    /// Returns `true` only if chance certainly plays no part from here on: given the sprites in this state, and all
    /// that can follow, the same actions give the same sprites, scores and outcomes for every seed. Cost: O(sprites),
    /// and for the rules O(rounds × interactions).
    pub fn is_deterministic_from(&self, state: &State) -> bool {
        state.is_over() || !draws(&self.game.0, &self.futures(state), Some(state))
    }

    /// The relevant types that the player does not see: in some level they take part in interactions, are counted by
    /// terminations or interactions, make others, or are portal exits of others or followed by them.
    pub fn unseen(&self) -> &[SpriteType] {
        &self.unseen
    }

    /// Returns `true` if the player sees every relevant sprite in any level: see [`Analysis::unseen`].
    pub fn is_fully_observable(&self) -> bool {
        self.unseen.is_empty()
    }

    /// Returns `true` if the player sees every relevant sprite from here on. Cost: as
    /// [`Analysis::is_deterministic_from`].
    pub fn is_fully_observable_from(&self, state: &State) -> bool {
        state.is_over() || unseen(&self.game.0, &self.facts, &self.futures(state), &self.goals).is_empty()
    }

    /// Returns the futures of a state: all that can still follow.
    pub(super) fn futures(&self, state: &State) -> PossibleFutures<'_> {
        let rules = &*self.game.0;
        let existing: Vec<SpriteType> =
            self.game.sprite_types().filter(|&stype| state.world.group(stype).count > 0).collect();
        // Spawn points may have been given another type to make.
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

/// Returns `true` if a probability leaves the outcome open.
fn is_open(prob: f64) -> bool {
    prob > 0.0 && prob < 1.0
}

/// Returns `true` if anything that can happen can draw a random number with an open outcome; without a state, in any
/// level.
pub(super) fn draws(rules: &Rules, futures: &PossibleFutures<'_>, state: Option<&State>) -> bool {
    let types = (0..rules.types.len()).map(|at| SpriteType(at as u16));
    let mut types = types.filter(|stype| futures.exists[stype.index()]);
    let live = futures.encounters().iter().zip(&futures.live).filter(|(_, live)| **live);
    let mut met = live.map(|(encounter, _)| (encounter.second, encounter.effect));
    let timed = rules.timed.iter().zip(&futures.timed).filter(|(_, live)| **live);
    let mut timed = timed.map(|(timed, _)| (None, timed.effect));
    let mut open = |(second, effect): (Option<SpriteType>, u16)| {
        effect_draws(rules, futures, state, rules.effects[usize::from(effect)].summary.draws, second)
    };
    types.any(|stype| update_draws(rules, futures, state, stype)) || met.any(&mut open) || timed.any(open)
}

/// Returns `true` if sprites of the type draw, with an open outcome, in their own updates.
fn update_draws(
    rules: &Rules,
    futures: &PossibleFutures<'_>,
    state: Option<&State>,
    stype: SpriteType,
) -> bool {
    use SpriteClass as C;
    let info = &rules.types[stype.index()];
    let traits = &info.traits;
    // Only leaves of the SpriteSet are updated.
    let (Some(class), Some(_)) = (info.class, info.order) else { return false };
    use ClassFamily as Family;
    match (class, class.family()) {
        (C::RandomMissile, _) => {
            let unset = |state: &State| {
                state.world.slots(stype).any(|slot| state.world.overrides(slot).orientation == Direction::NIL)
            };
            let new = traits.orientation == Direction::NIL && futures.made[stype.index()];
            new || state.map_or(traits.orientation == Direction::NIL, unset)
        }
        (C::Spreader, _) => is_open(traits.spread_probability),
        (C::WalkerJumper, _) => is_open(traits.probability),
        (C::RandomBomber, _) => true,
        (C::BomberRandomMissile, _) => {
            let first = traits.stypes.first();
            is_open(traits.prob) || traits.stypes.iter().any(|stype| Some(stype) != first)
        }
        (C::SpriteProducer, _) => false,
        (_, Family::Producer) => is_open(traits.prob),
        (_, Family::Npc | Family::Walker) => true,
        (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile | Family::Avatar) => false,
    }
}

/// Returns `true` if an effect draws with an open outcome.
fn effect_draws(
    rules: &Rules,
    futures: &PossibleFutures<'_>,
    state: Option<&State>,
    draws: Draws,
    second: Option<SpriteType>,
) -> bool {
    match draws {
        Draws::Nothing => false,
        Draws::Direction => true,
        Draws::Chance(prob) | Draws::ChanceIfOriented(prob) => is_open(prob),
        Draws::OneOf(types) => types > 1,
        Draws::Exit => {
            // A single exit leaves no choice.
            let single = |exit: SpriteType| {
                let few = state.is_some_and(|state| state.world.group(exit).count <= 1);
                few && !futures.made[exit.index()]
            };
            let portals = second.map_or(&[][..], |second| &*rules.types[second.index()].tree);
            let portals = portals.iter().filter(|portal| futures.exists[portal.index()]);
            portals.filter_map(|portal| rules.types[portal.index()].leads_to()).any(|exit| !single(exit))
        }
    }
}

/// Returns the types that the player does not see, among those that can exist and are relevant.
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
        // The types that it chases, flees from, or leads to.
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
