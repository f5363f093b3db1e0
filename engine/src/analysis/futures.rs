//! Possible futures: a fixed point over the existing sprites, the sprites that they create, and the effects
//! of their collisions.

use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Precondition, Side, timed_effects};
use crate::analysis::types::facts::Facts;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Ending, Target};
use crate::rules::{Rules, SpriteType};

/// An over-approximation of the sprites, resources and interactions that are possible from a given start. It
/// assumes that any two possible types can collide.
#[derive(Clone, Debug)]
pub(super) struct PossibleFutures<'a> {
    rules: &'a Rules,
    facts: &'a [Facts],
    encounters: &'a [Encounter],
    /// For each type, whether its sprites can exist.
    pub(super) exists: Vec<bool>,
    /// For each type, whether its sprites can appear from now on.
    pub(super) made: Vec<bool>,
    /// For each type, whether some sprite can hold the type as a resource. `None` if every amount of every
    /// resource can be held.
    held: Option<Vec<bool>>,
    /// For each interaction, whether it can happen.
    pub(super) live: Vec<bool>,
    /// For each timed effect, whether the effect is or can be scheduled.
    pub(super) timed: Vec<bool>,
    /// For each type, whether sprites of the type or of a related type can exist, so that rules on the type
    /// can apply.
    applicable: Vec<bool>,
    /// For each type, whether sprites can hold it as a resource beyond its limit.
    unlimited: Vec<bool>,
}

/// The starting point of the possible futures.
#[derive(Clone, Debug, Default)]
pub(super) struct Start {
    /// The types that have sprites at the start.
    pub(super) existing: Vec<SpriteType>,
    /// The types that existing sprites create in addition to the types that all sprites of their types create.
    pub(super) making: Vec<SpriteType>,
    /// The timed effects that are scheduled at the start, as indices.
    pub(super) scheduled: Vec<u16>,
    /// For each type, whether some sprite holds the type as a resource. `None` if every amount of every
    /// resource can be held.
    pub(super) held: Option<Vec<bool>>,
}

impl Start {
    /// Returns the start of an episode in a level that places every placeable type, with no resources held.
    pub(super) fn of_any_level(rules: &Rules) -> Start {
        let existing = rules.mapping.iter().flatten().copied().collect();
        let held = Some(vec![false; rules.types.len()]);
        Start { existing, making: Vec::new(), scheduled: Start::scheduled(rules), held }
    }

    /// Returns the timed effects scheduled at the start of an episode.
    pub(super) fn scheduled(rules: &Rules) -> Vec<u16> {
        let timed = (0u16..).zip(&rules.timed);
        timed.filter(|(_, timed)| timed.first_due.is_some()).map(|(number, _)| number).collect()
    }
}

impl<'a> PossibleFutures<'a> {
    /// Computes the possible futures. Cost: O(rounds × interactions), with at most one round per added type.
    pub(super) fn of(
        rules: &'a Rules,
        facts: &'a [Facts],
        encounters: &'a [Encounter],
        Start { existing, making, scheduled, held }: Start,
    ) -> PossibleFutures<'a> {
        let none = vec![false; rules.types.len()];
        let mut futures = PossibleFutures {
            rules,
            facts,
            encounters,
            exists: none.clone(),
            made: none.clone(),
            held,
            live: vec![false; encounters.len()],
            timed: vec![false; rules.timed.len()],
            applicable: none,
            unlimited: unlimited(rules),
        };
        existing.into_iter().for_each(|stype| futures.add(stype));
        for stype in making {
            futures.make(stype);
        }
        scheduled.into_iter().for_each(|timed| futures.timed[usize::from(timed)] = true);
        let timed_effects = timed_effects(rules);
        while futures.round(&timed_effects) {}
        futures
    }

    /// Returns `true` if the rules written for a type can apply to some sprite.
    pub(super) fn can_apply(&self, written: SpriteType) -> bool {
        self.applicable[written.index()]
    }

    fn add(&mut self, stype: SpriteType) {
        let info = &self.rules.types[stype.index()];
        if info.class.is_some() && !std::mem::replace(&mut self.exists[stype.index()], true) {
            info.tree.iter().for_each(|relative| self.applicable[relative.index()] = true);
        }
    }

    fn make(&mut self, stype: SpriteType) -> bool {
        let new = self.rules.types[stype.index()].class.is_some() && !self.made[stype.index()];
        if new {
            self.made[stype.index()] = true;
            self.add(stype);
        }
        new
    }

    /// Makes one pass over all types and interactions. Returns `true` if the pass added a type, interaction
    /// or resource.
    fn round(
        &mut self,
        timed_effects: &[(Option<SpriteType>, smallvec::SmallVec<[EffectSummary; 2]>)],
    ) -> bool {
        let mut new = false;
        let facts = self.facts;
        for (at, fact) in facts.iter().enumerate().filter(|(at, _)| self.exists[*at]).collect::<Vec<_>>() {
            for (kind, &stype) in fact.makes.iter().enumerate() {
                new |= self.can_make(at, kind) && self.make(stype);
            }
            new |= self.leaves_walls(at) && self.make(SpriteType(0));
        }
        for (at, encounter) in self.encounters.iter().enumerate() {
            if !self.live[at] {
                let meets = encounter.second.is_none_or(|second| self.can_apply(second));
                if !meets || !self.can_apply(encounter.first) || !self.can_happen(encounter.precondition) {
                    continue;
                }
                self.live[at] = true;
                new = true;
            }
            new |= self.apply(Some(encounter.first), &encounter.effects);
            if let Some(timed) = self.rules.effects[usize::from(encounter.effect)].summary.schedules {
                new |= !std::mem::replace(&mut self.timed[usize::from(timed)], true);
            }
        }
        for (timed, (target, effects)) in timed_effects.iter().enumerate() {
            if self.timed[timed] && target.is_none_or(|target| self.can_apply(target)) {
                new |= self.apply(*target, effects);
                let effect = self.rules.timed[timed].effect;
                if let Some(timed) = self.rules.effects[usize::from(effect)].summary.schedules {
                    new |= !std::mem::replace(&mut self.timed[usize::from(timed)], true);
                }
            }
        }
        new
    }

    fn apply(&mut self, first: Option<SpriteType>, effects: &[EffectSummary]) -> bool {
        let mut new = false;
        for effect in effects {
            let turns_none = matches!(effect.ending(), Some((Target::All(from), Ending::Turned)) if !self.exists[from.index()]);
            for &made in effect.makes().iter().filter(|_| !turns_none) {
                new |= self.make(made);
            }
            let (clones, collects) = (*effect == EffectSummary::Clone, *effect == EffectSummary::Collect);
            if clones || collects {
                let rules = self.rules;
                let tree = first.map_or(&[][..], |first| &rules.types[first.index()].tree);
                for &stype in tree.iter().filter(|stype| self.exists[stype.index()]).collect::<Vec<_>>() {
                    let traits = &rules.types[stype.index()].traits;
                    new |= if clones {
                        self.make(stype)
                    } else {
                        traits.is_resource && traits.value > 0 && self.hold(traits.resource, 1)
                    };
                }
            }
            if let EffectSummary::Change { resource, by, .. } = *effect {
                new |= by > 0 && self.hold(resource, by);
            }
        }
        new
    }

    /// Records that a sprite can hold the given amount of a resource, if the resource's limit allows it.
    /// Returns `true` if this was not known before.
    fn hold(&mut self, resource: SpriteType, amount: i32) -> bool {
        let fits = resource != SpriteType::NONE && self.is_within(resource, amount);
        let Some(held) = self.held.as_mut().filter(|_| fits) else { return false };
        !std::mem::replace(&mut held[resource.index()], true)
    }

    /// Returns `true` if a resource's limit allows this amount.
    pub(super) fn is_within(&self, resource: SpriteType, amount: i32) -> bool {
        self.is_unlimited(resource) || amount <= self.rules.types[resource.index()].resource_limit
    }

    /// Returns `true` if some rule gives a resource regardless of its limit.
    pub(super) fn is_unlimited(&self, resource: SpriteType) -> bool {
        self.unlimited[resource.index()]
    }

    /// Returns `true` if the condition of an interaction can ever hold.
    fn can_happen(&self, precondition: Precondition) -> bool {
        match (&self.held, precondition) {
            (Some(held), Precondition::Holds(_, resource, amount)) => {
                amount <= 0 || (held[resource.index()] && self.is_within(resource, amount))
            }
            (Some(_), Precondition::Chance(prob)) => prob > 0.0,
            _ => true,
        }
    }

    /// Returns `true` if `maker` can create sprites of the type at index `kind` in its list of types. Avatars
    /// need ammunition for their shots.
    pub(super) fn can_make(&self, maker: usize, kind: usize) -> bool {
        let info = &self.rules.types[maker];
        let Some(held) = &self.held else { return true };
        if info.class.is_some_and(|class| class.is_avatar()) {
            return self.ammo(maker, kind).is_none_or(|ammo| held[ammo.index()]);
        }
        info.class.is_some_and(|class| class.is_a(SpriteClass::Spreader)) || info.traits.prob > 0.0
    }

    /// Returns `true` if all sprites of a type except the first leave sprites of type 0 (`wall`) behind,
    /// regardless of the type's parameters.
    fn leaves_walls(&self, stype: usize) -> bool {
        self.rules.types[stype].class == Some(SpriteClass::OngoingTurningAvatar) && self.made[stype]
    }

    /// Returns the resource that an avatar needs to create sprites of the type at index `kind` in its list of types;
    /// `None` if it needs none, or if the resource is unknown.
    fn ammo(&self, maker: usize, kind: usize) -> Option<SpriteType> {
        let traits = &self.rules.types[maker].traits;
        // The type facts omit undeclared types. If the traits contain one, the list of created types and the
        // list of ammunition no longer correspond.
        let matched = !traits.stypes.contains(&SpriteType::NONE);
        traits.ammo.get(kind).copied().filter(|&ammo| matched && ammo != SpriteType::NONE)
    }

    /// Returns the types that sprites of a type can create on their own, each with the required ammunition.
    pub(super) fn makes(&self, maker: usize) -> Vec<(SpriteType, Option<SpriteType>)> {
        let avatar = self.rules.types[maker].class.is_some_and(|class| class.is_avatar());
        let made = self.facts[maker].makes.iter().enumerate();
        let made = made.filter(|(kind, _)| self.can_make(maker, *kind));
        let made = made.map(|(kind, &made)| (made, self.ammo(maker, kind).filter(|_| avatar)));
        made.chain(self.leaves_walls(maker).then_some((SpriteType(0), None))).collect()
    }

    /// Returns the interactions to which the entries of [`PossibleFutures::live`] refer.
    pub(super) fn encounters(&self) -> &'a [Encounter] {
        self.encounters
    }

    /// Returns `true` if some sprite can ever hold this amount of a resource.
    pub(super) fn can_hold(&self, resource: SpriteType, amount: i32) -> bool {
        self.can_happen(Precondition::Holds(Side::First, resource, amount))
    }
}

/// Returns, for each type, whether sprites can obtain it as a resource beyond its limit, either through a
/// rule or by shooting with it as ammunition.
pub(super) fn unlimited(rules: &Rules) -> Vec<bool> {
    let mut unlimited = vec![false; rules.types.len()];
    let mut mark =
        |stype: SpriteType| unlimited.get_mut(stype.index()).into_iter().for_each(|one| *one = true);
    rules.effects.iter().filter_map(|info| info.summary.overfills).for_each(&mut mark);
    for traits in rules.types.iter().map(|info| &info.traits).filter(|traits| traits.ammo_cost < 0) {
        traits.ammo.iter().for_each(|&ammo| mark(ammo));
    }
    unlimited
}
