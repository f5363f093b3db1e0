//! Proofs that randomness has no effect, because no draw with an uncertain outcome can ever occur.
//!
//! A draw with a certain outcome only advances the generator. Examples are the draws of a SpawnPoint with
//! `prob=1` and of a Spreader with `spreadprob=1`. PathChasers and PathAltChasers draw only while they have
//! no target (`spec/02` §7), so their draws have no effect if a target always exists.

use super::Analysis;
use super::futures::PossibleFutures;
use super::goals::attain::disappears_by_itself;
use crate::level::Level;
use crate::numbers::geometry::Direction;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::effects::{Draws, Ending, Side, Summary, Target};
use crate::rules::terminations::{Condition, can_be_held_up};
use crate::rules::{Rules, SpriteType, TypeInfo};
use crate::state::State;
use base::Seed;
use std::collections::BTreeSet;

impl Analysis {
    /// Returns `true` if randomness can have an effect in at least one level. If the result is `false`, the same
    /// actions always produce the same sprites, scores and outcomes. Draws with a certain outcome do not count, so this
    /// method and [`Game::is_deterministic`](crate::Game::is_deterministic) can both return `false`.
    pub fn is_stochastic(&self) -> bool {
        self.is_stochastic
    }

    /// Returns `true` only if randomness provably has no effect in any level: the opposite of
    /// [`Analysis::is_stochastic`]. Many levels of stochastic games are deterministic, too: see
    /// [`Analysis::is_deterministic_in`].
    pub fn is_deterministic(&self) -> bool {
        !self.is_stochastic
    }

    /// Returns `true` only if randomness provably has no effect in a level. Cost: starting the level, plus
    /// one call to [`Analysis::is_deterministic_from`].
    pub fn is_deterministic_in(&self, level: &Level) -> bool {
        // Starting a level draws no random numbers.
        self.is_deterministic() || self.is_deterministic_from(&self.game.start(level, Seed::from_text("any")))
    }

    /// Returns `true` only if randomness provably has no effect from this state on: the same actions produce
    /// the same sprites, scores and outcomes for every seed. Cost: O(sprites + rounds × interactions).
    pub fn is_deterministic_from(&self, state: &State) -> bool {
        state.is_over() || !draws(&self.game.0, &self.futures(state), Some(state))
    }
}

/// Returns `true` if any possible future can contain a draw with an uncertain outcome. If `state` is `None`,
/// considers the futures of any level.
pub(super) fn draws(rules: &Rules, futures: &PossibleFutures<'_>, state: Option<&State>) -> bool {
    let outlook = Outlook { rules, futures, state };
    let types = (0..rules.types.len()).map(|at| SpriteType(at as u16));
    let mut types = types.filter(|stype| futures.exists[stype.index()]);
    let mut targets = BTreeSet::new();
    types.any(|stype| outlook.update_draws(stype, &mut targets))
        || outlook.effects().any(|(_, second, summary)| outlook.effect_draws(summary.draws, second))
        || targets.len() > MAX_TARGETS
        || targets.into_iter().any(|target| !outlook.is_always_there(target))
}

/// The maximum number of target types to examine, and the maximum number of rounds per examination. Beyond
/// either limit, the search for a proof is abandoned.
const MAX_TARGETS: usize = 16;
const MAX_ROUNDS: usize = 16;

/// Returns `true` if a draw with this probability has an uncertain outcome.
fn is_open(prob: f64) -> bool {
    prob > 0.0 && prob < 1.0
}

/// The possible futures of a state, or of the start of any level.
#[derive(Clone, Copy)]
struct Outlook<'a> {
    rules: &'a Rules,
    futures: &'a PossibleFutures<'a>,
    state: Option<&'a State>,
}

impl<'a> Outlook<'a> {
    fn info(&self, stype: SpriteType) -> &'a TypeInfo {
        &self.rules.types[stype.index()]
    }

    /// Returns the types to which rules written for the given type apply. The result is empty for an
    /// undeclared type.
    fn tree(&self, stype: SpriteType) -> &'a [SpriteType] {
        self.rules.types.get(stype.index()).map_or(&[], |info| &info.tree)
    }

    /// Returns the effects that can run, each with the first and second type as written in its rule.
    fn effects(self) -> impl Iterator<Item = (Option<SpriteType>, Option<SpriteType>, &'a Summary)> {
        let summary = move |effect: u16| &*self.rules.effects[usize::from(effect)].summary;
        let met = self.futures.encounters().iter().zip(&self.futures.live).filter(|(_, live)| **live);
        let met = met.map(move |(met, _)| (Some(met.first), met.second, summary(met.effect)));
        let timed = self.rules.timed.iter().zip(&self.futures.timed).filter(|(_, live)| **live);
        met.chain(timed.map(move |(timed, _)| (timed.target, None, summary(timed.effect))))
    }

    /// Returns `true` if updating the type's sprites involves draws with an uncertain outcome, even while
    /// every type in `targets` has a sprite. Adds the type's own target to `targets`.
    fn update_draws(&self, stype: SpriteType, targets: &mut BTreeSet<SpriteType>) -> bool {
        use ClassFamily as Family;
        use SpriteClass as C;
        let info = self.info(stype);
        let traits = &info.traits;
        // Only leaves of the SpriteSet are updated.
        let (Some(class), Some(_)) = (info.class, info.order) else { return false };
        match (class, class.family()) {
            (C::RandomMissile, _) => self.can_be_unoriented(),
            (C::Spreader, _) => is_open(traits.spread_probability),
            (C::WalkerJumper, _) => is_open(traits.probability),
            (C::RandomBomber, _) => true,
            (C::BomberRandomMissile, _) => {
                let first = traits.stypes.first();
                is_open(traits.prob) || traits.stypes.iter().any(|stype| Some(stype) != first)
            }
            (C::SpriteProducer, _) => false,
            (_, Family::Producer) => is_open(traits.prob),
            (C::PathChaser, _) => {
                targets.extend(traits.stypes.first());
                traits.stypes.is_empty()
            }
            (C::PathAltChaser | C::RandomPathAltChaser, _) => {
                let strays = class == C::RandomPathAltChaser && traits.epsilon > 0.0;
                targets.extend(&traits.stypes);
                // The sprite draws randomly among several types or targets.
                strays || traits.random_target || traits.stypes.len() != 1
            }
            (_, Family::Npc | Family::Walker) => true,
            (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile | Family::Avatar) => {
                false
            }
        }
    }

    /// Returns `true` if a sprite can have [`Direction::NIL`] as its orientation, which makes a RandomMissile
    /// draw a direction. Sprites may pass `NIL` on to other sprites.
    fn can_be_unoriented(&self) -> bool {
        let types = self.rules.types.iter().enumerate();
        let mut unset = types.filter(|(_, info)| info.traits.orientation == Direction::NIL);
        match self.state {
            None => unset.any(|(at, _)| self.futures.exists[at]),
            Some(state) => {
                let mut now = (0u16..).map(SpriteType).take(self.rules.types.len());
                let is_unset = |slot| state.world.overrides(slot).orientation == Direction::NIL;
                unset.any(|(at, _)| self.futures.made[at])
                    || now.any(|stype| state.world.slots(stype).any(is_unset))
            }
        }
    }

    /// Returns `true` if an effect makes draws with an uncertain outcome.
    fn effect_draws(&self, draws: Draws, second: Option<SpriteType>) -> bool {
        match draws {
            Draws::Nothing => false,
            Draws::Direction => true,
            Draws::Chance(prob) | Draws::ChanceIfOriented(prob) => is_open(prob),
            Draws::OneOf(types) => types > 1,
            Draws::Exit => {
                let portals = second.map_or(&[][..], |second| self.tree(second));
                let mut portals = portals.iter().filter(|portal| self.futures.exists[portal.index()]);
                portals.any(|&portal| self.exits(portal).into_iter().any(|exit| !self.is_single(exit)))
            }
        }
    }

    /// Returns the types to which a portal of the given type leads. A spawner leads to the types that it
    /// creates, and rules may change those types.
    fn exits(&self, portal: SpriteType) -> Vec<SpriteType> {
        let info = self.info(portal);
        let mut exits: Vec<SpriteType> = info.leads_to().into_iter().collect();
        if info.class.is_some_and(|class| class.is_a(SpriteClass::SpawnPoint)) {
            exits.extend(&info.traits.stypes);
            let redirects = self.rules.effects.iter().filter_map(|info| info.summary.redirects);
            exits.extend(redirects.map(|redirect| redirect.to));
            let now = self
                .state
                .into_iter()
                .flat_map(|state| state.world.slots(portal).map(|slot| state.world.overrides(slot).spawns));
            exits.extend(now);
        }
        exits.retain(|&exit| exit != SpriteType::NONE);
        exits
    }

    /// Returns `true` if, from now on, at most one sprite of the type exists at any time, so that a choice
    /// among its sprites has a certain outcome.
    fn is_single(&self, stype: SpriteType) -> bool {
        let few = self.state.is_some_and(|state| state.world.group(stype).count <= 1);
        few && !self.futures.made[stype.index()]
    }

    /// Returns `true` only if a sprite of the type or of a related type exists whenever sprites are updated.
    /// Such a sprite must exist now. In addition, the sprites of its type must never be removed, or removing
    /// the last of them must end the game. This suffices because sprites are removed only after a tick's
    /// updates, just before terminations are checked.
    fn is_always_there(&self, stype: SpriteType) -> bool {
        let family = self.tree(stype);
        let lasting = self.lasting(family);
        self.is_there_now(&|one| lasting[one.index()])
            || self.ends_without(family) && self.is_there_now(&|one| family.contains(&one))
    }

    /// Returns `true` only if `fits` accepts the type of some existing sprite. With a state, the sprite exists in this
    /// state. Without a state, such a sprite exists at the start of every level.
    fn is_there_now(&self, fits: &dyn Fn(SpriteType) -> bool) -> bool {
        let mut types = (0u16..).map(SpriteType).take(self.rules.types.len());
        match self.state {
            Some(state) => types.any(|stype| fits(stype) && state.world.group(stype).count > 0),
            // Every level has exactly one avatar.
            None => {
                let placed =
                    |stype: &SpriteType| self.rules.mapping.iter().flatten().any(|placed| placed == stype);
                let mut avatars =
                    types.filter(|&stype| is_avatar(self.info(stype))).filter(placed).peekable();
                !self.rules.as_reference
                    && avatars.peek().is_some()
                    && avatars.all(|stype| fits(stype) && !self.may_be_left_out(stype))
            }
        }
    }

    /// Returns `true` if a level may lack an avatar that its text places, because a related singleton already
    /// exists.
    fn may_be_left_out(&self, avatar: SpriteType) -> bool {
        let placed = || self.rules.mapping.iter().flatten();
        let mut singletons = self.info(avatar).path.iter().filter(|one| self.info(**one).singleton);
        singletons
            .any(|&one| placed().any(|&other| self.info(one).in_tree(other) && !is_avatar(self.info(other))))
    }

    /// Returns, for each type, whether the type is in `family` and permanent. A permanent type's sprites
    /// never leave the board, except by turning into sprites of another permanent type in `family`. Dead
    /// avatars stay on the board.
    fn lasting(&self, family: &[SpriteType]) -> Vec<bool> {
        let mut lasting = vec![false; self.rules.types.len()];
        for stype in family {
            lasting[stype.index()] =
                is_avatar(self.info(*stype)) || !disappears_by_itself(self.rules, *stype);
        }
        for _ in 0..MAX_ROUNDS {
            let before = lasting.iter().filter(|lasts| **lasts).count();
            for (first, second, summary) in self.effects() {
                self.end(first, second, summary, &mut lasting);
            }
            if lasting.iter().filter(|lasts| **lasts).count() == before {
                return lasting;
            }
        }
        vec![false; lasting.len()]
    }

    /// Removes from `lasting` the types whose sprites the effect removes.
    fn end(
        &self,
        first: Option<SpriteType>,
        second: Option<SpriteType>,
        summary: &Summary,
        lasting: &mut [bool],
    ) {
        let tree = |written: Option<SpriteType>| written.map_or(&[][..], |written| self.tree(written));
        for effect in &summary.effects {
            let Some((target, ending)) = effect.ending() else { continue };
            let of: [&[SpriteType]; 2] = match &target {
                Target::Side(Side::First) => [tree(first), &[]],
                Target::Side(Side::Second) => [tree(second), &[]],
                Target::All(stype) => [std::slice::from_ref(stype), &[]],
                // If the type has no sprites, the effect may remove the first sprite instead.
                Target::Tree(stype) => [self.tree(*stype), tree(first)],
            };
            let stays = ending == Ending::Turned
                && effect.makes().iter().all(|made| lasting.get(made.index()).is_some_and(|lasts| *lasts));
            for &stype in of.into_iter().flatten() {
                let Some(lasts) = lasting.get_mut(stype.index()) else { continue };
                let stays_dead =
                    ending != Ending::Turned && summary.spares_avatars && is_avatar(self.info(stype));
                *lasts &= stays || stays_dead;
            }
        }
    }

    /// Returns `true` only if some termination ends the game as soon as no sprite of these types exists.
    fn ends_without(&self, family: &[SpriteType]) -> bool {
        let within = |stype: &SpriteType| {
            let tree = self.tree(*stype);
            !tree.is_empty() && tree.iter().all(|one| family.contains(one))
        };
        let ends = self.rules.terminations.iter().any(|end| match &end.condition {
            Condition::SpriteCounter { stype, limit } => *limit >= 0 && within(stype),
            Condition::MultiSpriteCounter { stypes, limit, .. } => *limit == 0 && stypes.iter().all(within),
            Condition::SpriteCounterMore { .. }
            | Condition::MultiSpriteCounterSubTypes { .. }
            | Condition::StopCounter { .. }
            | Condition::Timeout { .. } => false,
        });
        ends && !can_be_held_up(self.rules)
    }
}

/// Returns `true` if the type's class is an avatar class.
fn is_avatar(info: &TypeInfo) -> bool {
    info.class.is_some_and(SpriteClass::is_avatar)
}
