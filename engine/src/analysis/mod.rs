//! Static analysis of a game's rules, derived once from the compiled rules and shared by all generators,
//! validators and text writers.
//!
//! The analysis never runs the game. It covers:
//!
//! - the winning and losing terminations
//! - the types that block, harm, open, transform, create or push other types, and the types that can be
//!   collected
//! - the resources, and the amounts that the rules require
//! - the [`Role`] of every type
//!
//! A rule on a parent type also applies to all its subtypes. Every result of the analysis takes this into
//! account.

mod abstraction;
mod chance;
mod futures;
mod goals;
mod interactions;
mod outlook;
mod reach;
mod symmetry;
mod taxonomy;
mod types;

pub use abstraction::StateAbstraction;
pub use goals::attain::Attainable;
pub use goals::goal::{Aims, Condition, Goal};
pub use goals::requirement::{MAX_GOALS, Reason, Requirement};
pub use goals::win_methods::WinMethod;
pub use interactions::encounter::{EffectSummary, Encounter, Precondition, Side};
pub use interactions::lock::{Fate, Key, Lock, Pushable, Resource, Sink};
pub use interactions::pairs::MAX_RULES_PER_PAIR;
pub use interactions::touch::{Harm, Removal, Touch};
pub use reach::{
    Blocker, Cause, Chain, ImpossibleGoal, Missing, Obstacle, Reach, Shortage, Source, Unpaid, Unreachable,
};
pub use taxonomy::{Genre, Spatiality, Taxonomy, Time};
pub use types::facts::{Avatar, Facts, Motion, Steering};
pub use types::role::Role;

use crate::game::Game;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::effects::{Displacement, Turn};
use futures::{PossibleFutures, Start};
use interactions::lock::Touches;
use interactions::pairs::Pairs;
use std::collections::BTreeSet;

/// The static analysis of one game. An analysis is immutable, and the same game always gives the same
/// analysis.
#[derive(Clone, Debug)]
pub struct Analysis {
    game: Game,
    encounters: Vec<Encounter>,
    facts: Vec<Facts>,
    goals: Vec<Goal>,
    aims: Aims,
    avatars: Vec<Avatar>,
    touches: Touches,
    harm: Vec<Harm>,
    source: Vec<bool>,
    pushables: Vec<Pushable>,
    resources: Vec<Resource>,
    locks: Vec<Lock>,
    roles: Vec<Role>,
    requirements: Vec<Requirement>,
    is_stochastic: bool,
    unseen: Vec<SpriteType>,
    /// For each type, the result of [`Analysis::can_exist`].
    exists: Vec<bool>,
}

impl Analysis {
    /// Analyses a game. Cost: O(types × types + interactions × relatives), times at most
    /// [`MAX_RULES_PER_PAIR`]. Typical games take well under a millisecond, and the largest games that
    /// compile take a few tenths of a second.
    pub fn of(game: &Game) -> Analysis {
        let rules = &*game.0;
        let encounters = interactions::encounter::encounters(rules);
        let facts = types::facts::facts(rules, &encounters);
        let mut goals = goals::goal::goals(rules);
        let futures = PossibleFutures::of(rules, &facts, &encounters, Start::of_any_level(rules));
        goals::attain::find_attainable(rules, &facts, &futures, &mut goals);
        let aims = goals::goal::aims(rules, &goals);
        let avatars = types::facts::avatars(rules, &facts);
        let types = || game.sprite_types();
        let pairs = Pairs::of(rules, &encounters);
        let row = |avatar: &Avatar| interactions::touch::touches(rules, &pairs, &aims, avatar.stype);
        let touches: Touches = avatars.iter().map(row).collect();
        let worst = |stype: SpriteType| {
            touches.iter().map(|row: &Vec<Touch>| row[stype.index()].harm).max().unwrap_or_default()
        };
        let harm: Vec<Harm> = types().map(worst).collect();
        let givers = interactions::lock::givers(&facts, &touches);
        let pushables = interactions::lock::pushables(&pairs, &facts, &avatars, &touches);
        let resources =
            interactions::lock::resources(rules, &encounters, &facts, &avatars, &touches, &givers, &futures);
        let locks = interactions::lock::locks(&facts, &avatars, &touches, &pushables, &givers);
        let threat = types::marks::threats(rules, &encounters, &facts, &aims);
        let bad = |stype: SpriteType| {
            harm[stype.index()] != Harm::None
                || threat[stype.index()]
                || aims.prevent.binary_search(&stype).is_ok()
        };
        let source = sources(game, &encounters, &facts, &types().map(bad).collect::<Vec<bool>>());
        let harms = types::marks::Harms { harm: &harm, threat: &threat, source: &source };
        let marks = types::marks::marks(rules, &encounters, &facts, &avatars, &aims, &harms);
        let is_stochastic = chance::draws(rules, &futures, None);
        let unseen = outlook::unseen(rules, &facts, &futures, &goals);
        let mut analysis = Analysis {
            game: game.clone(),
            is_stochastic,
            unseen,
            exists: futures.exists.clone(),
            encounters,
            facts,
            goals,
            aims,
            avatars,
            touches,
            harm,
            source,
            pushables,
            resources,
            locks,
            roles: Vec::new(),
            requirements: Vec::new(),
        };
        analysis.roles = types().zip(marks).map(|(stype, marks)| analysis.role_with(stype, marks)).collect();
        analysis.requirements = goals::requirement::requirements(&analysis);
        analysis
    }

    /// Returns the analysed game.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// Returns all interactions, in the order in which a tick processes them.
    pub fn encounters(&self) -> &[Encounter] {
        &self.encounters
    }

    /// Returns `true` if a rule on `written` applies to sprites of `stype`, because the two types are related
    /// in the SpriteSet.
    pub fn applies(&self, written: SpriteType, stype: SpriteType) -> bool {
        self.game.0.types[written.index()].in_tree(stype)
    }

    /// Returns the interactions in which a sprite of `second` acts on a sprite of `first`. Cost:
    /// O(encounters).
    pub fn between(&self, first: SpriteType, second: SpriteType) -> impl Iterator<Item = &Encounter> {
        self.encounters.iter().filter(move |encounter| {
            self.applies(encounter.first, first)
                && encounter.second.is_some_and(|written| self.applies(written, second))
        })
    }

    /// Returns a sign's direction as a unit vector; `None` if the type is not a sign. A sign is a motionless, oriented
    /// type that turns the sprites that touch it, for example into its own direction. Rules may also turn the sign
    /// itself. Cost: O(encounters).
    pub fn sign(&self, stype: SpriteType) -> Option<Direction> {
        let traits = &self.game.0.types[stype.index()].traits;
        let faces = traits.is_oriented && traits.orientation != Direction::NONE;
        let turns = |encounter: &Encounter| {
            let is_other = encounter.second.is_some_and(|written| self.applies(written, stype));
            let takes_its_way = || {
                let effect = &self.game.0.effects[usize::from(encounter.effect)];
                effect.summary.turn == Some(Turn::OfPartner)
            };
            is_other && (encounter.does(|effect| *effect == EffectSummary::Turn) || takes_its_way())
        };
        let is_sign = faces && self.facts(stype).motion == Motion::Still && self.encounters.iter().any(turns);
        is_sign.then_some(traits.orientation)
    }

    /// Returns `true` if sprites of the type stand still until a rule sets their speed. Cost: O(1).
    pub(crate) fn is_set_off(&self, stype: SpriteType) -> bool {
        let info = &self.game.0.types[stype.index()];
        let traits = &info.traits;
        let drifts = !traits.is_static && !traits.only_active && (traits.is_oriented || traits.continuous);
        let is_updated = info.order.is_some() && info.class.is_some_and(|class| !class.is_avatar());
        info.given_speed && drifts && is_updated && self.facts(stype).motion == Motion::Still
    }

    /// Returns a type's interactions with the edge of the screen. Cost: O(encounters).
    pub fn at_edge(&self, stype: SpriteType) -> impl Iterator<Item = &Encounter> {
        self.encounters
            .iter()
            .filter(move |encounter| encounter.second.is_none() && self.applies(encounter.first, stype))
    }

    /// Returns the properties of a type that do not depend on other types.
    pub fn facts(&self, stype: SpriteType) -> &Facts {
        &self.facts[stype.index()]
    }

    /// Returns a type's role in a level.
    pub fn role(&self, stype: SpriteType) -> Role {
        self.roles[stype.index()]
    }

    /// Returns the types that can occur in play and have the given role, in registry order.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = SpriteType> + '_ {
        self.game.sprite_types().filter(move |&stype| self.role(stype) == role && self.facts(stype).possible)
    }

    /// Returns `false` only if the rules prove that no level can ever contain a sprite of the type. Unlike
    /// [`Facts::possible`], the result also covers levels that use `w` or `A` even if the game does not use
    /// that character.
    pub fn can_exist(&self, stype: SpriteType) -> bool {
        self.exists[stype.index()]
    }

    /// Returns the possible types of the player's avatar, starting with the types that levels can place. If
    /// the list is empty, the engine finds no avatar when a level starts, and pressing keys has no effect.
    pub fn avatars(&self) -> &[Avatar] {
        &self.avatars
    }

    /// Returns the avatar at the start of an episode, or `None` if no level contains an avatar. If levels can
    /// place several avatar types, returns the first type.
    pub fn start_avatar(&self) -> Option<&Avatar> {
        self.avatars.first().filter(|avatar| avatar.starts)
    }

    /// Returns the result when an avatar of type `avatar` touches a sprite of type `other`.
    ///
    /// # Panics
    /// Panics if `avatar` is not among [`Analysis::avatars`].
    pub fn touch(&self, avatar: SpriteType, other: SpriteType) -> &Touch {
        let at = self.avatars.iter().position(|known| known.stype == avatar);
        &self.touches[at.expect("the type is an avatar type")][other.index()]
    }

    /// Returns the worst harm that contact with a type does to an avatar of any type.
    pub fn harm(&self, stype: SpriteType) -> Harm {
        self.harm[stype.index()]
    }

    /// Returns `true` if sprites of the type spawn, directly or in several steps, sprites that harm the avatar or
    /// a goal. Such a type kills at a distance.
    pub fn makes_harm(&self, stype: SpriteType) -> bool {
        self.source[stype.index()]
    }

    /// Returns `true` if a sprite of `obstacle` blocks a sprite of `mover`, by moving back either the blocked
    /// sprite or every sprite. Cost: O(encounters).
    pub fn blocks(&self, obstacle: SpriteType, mover: SpriteType) -> bool {
        let undone = |encounter: &Encounter| {
            encounter.does(|effect| matches!(effect, EffectSummary::Undo(spare) if !spare.contains(&mover)))
        };
        self.between(mover, obstacle).any(Encounter::blocks) || self.between(obstacle, mover).any(undone)
    }

    /// Returns the types that a type turns into, each with the partner that causes the change. Changes at the
    /// edge are omitted. Cost: O(encounters).
    pub fn turns(&self, stype: SpriteType) -> Vec<(SpriteType, SpriteType)> {
        let mut list = Vec::new();
        for encounter in self.encounters.iter().filter(|encounter| self.applies(encounter.first, stype)) {
            for effect in &encounter.effects {
                if let (EffectSummary::Become(to), Some(by)) = (effect, encounter.second) {
                    list.push((*to, by));
                }
            }
        }
        list
    }

    /// Returns the type to which a portal of this type leads; `None` if it leads to no type.
    pub fn leads_to(&self, stype: SpriteType) -> Option<SpriteType> {
        self.game.0.types[stype.index()].leads_to().filter(|&exit| exit != SpriteType::NONE)
    }

    /// Returns the type and direction of the sprites that `maker` launches. Returns `None` if it launches none, if they
    /// do not move in a straight line, or if their direction is unknown.
    pub fn launches(&self, maker: SpriteType) -> Option<(SpriteType, Direction)> {
        let made = *self.facts(maker).makes.first()?;
        let Motion::Straight(own) = self.facts(made).motion else { return None };
        let traits = &self.game.0.types[maker.index()].traits;
        let unset = |direction: Direction| direction == Direction::NONE || direction == Direction::NIL;
        let direction = if traits.spawn_orientation != Direction::NONE {
            traits.spawn_orientation
        } else if unset(own) {
            traits.orientation
        } else {
            own
        };
        (!unset(direction)).then_some((made, direction))
    }

    /// Returns the types that avatars can push.
    pub fn pushables(&self) -> &[Pushable] {
        &self.pushables
    }

    /// Returns the resources that occur in rules or can be gained.
    pub fn resources(&self) -> &[Resource] {
        &self.resources
    }

    /// Returns `true` if `wanted` accepts an effect from an interaction or a timed effect. Cost:
    /// O(interactions).
    pub(crate) fn any_effect(&self, wanted: impl Fn(&EffectSummary) -> bool) -> bool {
        let timed = interactions::encounter::timed_effects(&self.game.0);
        self.encounters.iter().any(|encounter| encounter.does(&wanted))
            || timed.iter().any(|(_, effects)| effects.iter().any(&wanted))
    }

    /// Returns `true` if sprites can obtain a resource beyond its limit, either through a rule or by shooting
    /// with it as ammunition. Cost: O(interactions).
    pub fn can_exceed_limit(&self, resource: SpriteType) -> bool {
        futures::unlimited(&self.game.0)[resource.index()]
    }

    /// Returns the types that start locked, sorted by type.
    pub fn locks(&self) -> &[Lock] {
        &self.locks
    }

    /// Returns the requirements on the numbers of sprites in a level.
    pub fn requirements(&self) -> &[Requirement] {
        &self.requirements
    }

    /// Returns `true` if any effect is timed, whether it is scheduled from the start or by an interaction.
    pub fn has_timed_effects(&self) -> bool {
        !self.game.0.timed.is_empty()
    }

    /// Returns `true` if the arrow keys move sprites of an avatar type from cell to cell, either in four
    /// directions or along a line. The type must have grid physics and move by one whole cell per step.
    pub fn moves_by_whole_cells(&self, avatar: SpriteType) -> bool {
        let traits = &self.game.0.types[avatar.index()].traits;
        let avatar = self.avatars.iter().find(|known| known.stype == avatar);
        let steps = avatar.is_some_and(|avatar| avatar.steering.waits_for_keys());
        steps && !traits.continuous && (traits.speed <= 0.0 || traits.speed == 1.0)
    }

    /// Returns `true` if nothing moves unless the player acts, apart from the effects of the player's own
    /// shots.
    pub fn is_turn_based(&self) -> bool {
        let idle = |stype: SpriteType| {
            let facts = self.facts(stype);
            !facts.possible
                // Sprites of a type that levels can place are not always shots.
                || self.role(stype) == Role::Shot && facts.symbols.is_empty()
                || match facts.motion {
                    Motion::Still => facts.makes.is_empty() && !self.is_set_off(stype),
                    Motion::Steered => {
                        let avatar = self.avatars.iter().find(|avatar| avatar.stype == stype);
                        avatar.is_none_or(|avatar| avatar.steering.waits_for_keys())
                    }
                    _ => false,
                }
        };
        if self.changes_at_rest() {
            return false;
        }
        // Timed effects that are scheduled from the start also change things without player action.
        let clock = self.game.0.timed.iter().any(|timed| timed.first_due.is_some());
        !clock && self.game.sprite_types().all(idle)
    }

    /// Returns `true` if sprites may change after the first tick although no sprite moves, because they
    /// overlap when a level starts or extend into a neighbouring cell.
    fn changes_at_rest(&self) -> bool {
        let on = |written: SpriteType, stype: SpriteType| self.applies(written, stype);
        let lie_together = |encounter: &Encounter, stack: &[SpriteType]| {
            let Some(second) = encounter.second else { return false };
            (0..stack.len()).any(|one| {
                let other = |two: usize| two != one && on(second, stack[two]);
                on(encounter.first, stack[one]) && (0..stack.len()).any(other)
            })
        };
        let is_large = |written: SpriteType| {
            self.game.sprite_types().any(|stype| {
                let traits = &self.game.0.types[stype.index()].traits;
                on(written, stype) && self.facts(stype).possible && traits.span() != (1, 1)
            })
        };
        // The interaction creates or moves something repeatedly, or happens after the first tick.
        let repeats = |encounter: &Encounter| {
            let summary = &self.game.0.effects[usize::from(encounter.effect)].summary;
            let again = |effect: &EffectSummary| {
                use EffectSummary as E;
                matches!(effect, E::Make(_) | E::Clone | E::Health { .. })
            };
            encounter.precondition != Precondition::Always
                || matches!(summary.displacement, Some(Displacement::BackAndDown | Displacement::Exit))
                || summary.schedules.is_some()
                || encounter.does(again)
        };
        let becomes = |encounter: &Encounter| -> Vec<SpriteType> {
            encounter.effects.iter().flat_map(EffectSummary::makes).copied().collect()
        };
        let beside = |encounter: &Encounter| {
            let is_near = is_large(encounter.first) || encounter.second.is_some_and(is_large);
            is_near && (repeats(encounter) || !becomes(encounter).is_empty())
        };
        // Sprites created in the first tick take part in further rules.
        let within = |stack: &[SpriteType]| {
            let first = || self.encounters.iter().filter(|encounter| lie_together(encounter, stack));
            let next = [stack.to_vec(), first().flat_map(becomes).collect()].concat();
            first().any(repeats)
                || next.len() > stack.len()
                    && self.encounters.iter().any(|encounter| {
                        let is_new = lie_together(encounter, &next) && !lie_together(encounter, stack);
                        is_new && !encounter.effects.is_empty()
                    })
        };
        self.encounters.iter().any(beside) || self.game.0.mapping.iter().any(|stack| within(stack))
    }
}

/// Returns, for each type, whether it creates harmful sprites, directly or in several steps. The result is a
/// fixed point over the types that each type creates, starting from the harmful types in `bad`.
fn sources(game: &Game, encounters: &[Encounter], facts: &[Facts], bad: &[bool]) -> Vec<bool> {
    let types = &game.0.types;
    let mut makes: Vec<BTreeSet<SpriteType>> = vec![BTreeSet::new(); facts.len()];
    for (at, fact) in facts.iter().enumerate() {
        makes[at].extend(&fact.makes);
    }
    for encounter in encounters {
        for effect in &encounter.effects {
            let EffectSummary::Make(to) = effect else { continue };
            for stype in &types[encounter.first.index()].tree {
                makes[stype.index()].insert(*to);
            }
        }
    }
    let mut source = vec![false; facts.len()];
    loop {
        let mut changed = false;
        for (at, made) in makes.iter().enumerate().filter(|(at, _)| facts[*at].motion != Motion::Steered) {
            let makes = made.iter().any(|to| bad[to.index()] || source[to.index()]);
            changed |= makes && !source[at];
            source[at] |= makes;
        }
        if !changed {
            return source;
        }
    }
}
