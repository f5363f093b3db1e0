//! Determines, from the rules alone, whether a termination can ever hold.

use super::goal::{Condition, Goal};
use super::requirement::MAX_GOALS;
use crate::analysis::Analysis;
use crate::analysis::futures::PossibleFutures;
use crate::analysis::interactions::encounter::{EffectSummary, Precondition, Side, timed_effects};
use crate::analysis::types::facts::Facts;
use crate::limits::MAX_TICKS;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Ending, Target};
use crate::rules::terminations::can_be_held_up;
use crate::rules::{Rules, SpriteType};
use serde::Serialize;

/// The conditions under which a termination can hold. All variants except [`Attainable::InPlay`] are proven;
/// `InPlay` only means that the rules alone do not exclude the termination.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Attainable {
    /// The termination holds at the end of the first tick in every level.
    AtOnce,
    /// The termination may come to hold while a level is played.
    InPlay,
    /// The termination holds from the start of a level or never, because nothing changes its sprite count in
    /// the required direction.
    FromStart,
    /// The termination never holds in any level.
    Never,
}

/// Possible changes in the numbers of sprites during an episode.
struct PopulationChanges {
    /// For each type, whether its sprites can exist.
    exists: Vec<bool>,
    /// For each type, whether a sprite can disappear without being replaced.
    disappears: Vec<bool>,
    /// For each type, whether a sprite can appear without replacing another sprite.
    appears: Vec<bool>,
    /// Pairs of types such that a sprite of the first type can turn into a sprite of the second type.
    turns: Vec<(SpriteType, SpriteType)>,
}

/// Determines how each goal can be attained. Cost: computing one [`PossibleFutures`], plus O(types × types)
/// for each of the first [`MAX_GOALS`] goals. Further goals are assumed to be [`Attainable::InPlay`].
pub(crate) fn find_attainable(
    rules: &Rules,
    facts: &[Facts],
    futures: &PossibleFutures<'_>,
    goals: &mut [Goal],
) {
    let changes = PopulationChanges::of(rules, facts, futures);
    let held_up = can_be_held_up(rules);
    for goal in goals.iter_mut().take(MAX_GOALS) {
        goal.attainable = match changes.attainability(&goal.condition, goal.kinds) {
            // A condition that holds from the start may end the game only later, once no StopCounter prevents
            // this.
            Attainable::AtOnce | Attainable::FromStart
                if held_up && !matches!(goal.condition, Condition::Tick(_)) =>
            {
                Attainable::InPlay
            }
            judged => judged,
        };
    }
}

impl PopulationChanges {
    fn of(rules: &Rules, facts: &[Facts], futures: &PossibleFutures<'_>) -> PopulationChanges {
        let none = vec![false; facts.len()];
        let exists = futures.exists.clone();
        let mut changes =
            PopulationChanges { exists, disappears: none.clone(), appears: none, turns: Vec::new() };
        for at in (0..facts.len()).filter(|&at| futures.exists[at]) {
            changes.disappears[at] = disappears_by_itself(rules, SpriteType(at as u16));
            for (kind, made) in facts[at].makes.iter().enumerate() {
                changes.appears[made.index()] |= futures.can_make(at, kind);
            }
        }
        let mut turns = vec![false; facts.len() * facts.len()];
        for (encounter, _) in futures.encounters().iter().zip(&futures.live).filter(|(_, live)| **live) {
            let sides = [Some(encounter.first), encounter.second];
            let sides = sides.map(|written| written.map_or(&[][..], |w| &*rules.types[w.index()].tree));
            changes.add(rules, sides, &encounter.effects, encounter.precondition, &mut turns);
        }
        for ((target, effects), _) in
            timed_effects(rules).iter().zip(&futures.timed).filter(|(_, live)| **live)
        {
            let tree = target.map_or(&[][..], |target| &*rules.types[target.index()].tree);
            changes.add(rules, [tree, &[]], effects, Precondition::Always, &mut turns);
        }
        let types = facts.len();
        let pairs = (0..turns.len()).filter(|&at| turns[at]);
        let pair = |at: usize| (SpriteType((at / types) as u16), SpriteType((at % types) as u16));
        changes.turns = pairs.map(pair).filter(|(from, _)| changes.exists[from.index()]).collect();
        changes
    }

    /// Records the population changes that the effects cause among the sprites on both sides.
    fn add(
        &mut self,
        rules: &Rules,
        sides: [&[SpriteType]; 2],
        effects: &[EffectSummary],
        precondition: Precondition,
        turns: &mut [bool],
    ) {
        let types = self.exists.len();
        let mut turn = |from: SpriteType, to: SpriteType| turns[from.index() * types + to.index()] = true;
        let is_avatar =
            |stype: SpriteType| rules.types[stype.index()].class.is_some_and(SpriteClass::is_avatar);
        let turns_dead = turns_dead(effects, precondition);
        let disappears = &mut self.disappears;
        let mut gone = |types: &[SpriteType]| types.iter().for_each(|stype| disappears[stype.index()] = true);
        for effect in effects {
            match effect.ending() {
                Some((Target::All(from), Ending::Turned)) => {
                    for &to in effect.makes() {
                        turn(from, to);
                        self.appears[to.index()] |= is_avatar(from);
                    }
                }
                Some((_, Ending::Turned)) => {
                    // A dead avatar stays on the board, where every such effect except `transformTo`
                    // transforms it again.
                    let again = matches!(effect, EffectSummary::BecomeAny(_)) || turns_dead;
                    for &from in sides[0] {
                        effect.makes().iter().for_each(|&to| turn(from, to));
                        if again && is_avatar(from) {
                            effect.makes().iter().for_each(|to| self.appears[to.index()] = true);
                        }
                    }
                }
                Some((_, Ending::Health { dies_at: i32::MIN, .. })) => {}
                // If the portal has no exit, the sprite is killed.
                Some((Target::Side(Side::First), _)) => gone(sides[0]),
                Some((Target::Side(Side::Second), _)) => gone(sides[1]),
                Some((Target::All(stype), _)) => gone(&[stype]),
                Some((Target::Tree(of), _)) => {
                    gone(&rules.types[of.index()].tree);
                    gone(sides[0]);
                }
                None if *effect == EffectSummary::Clone => {
                    sides[0].iter().for_each(|stype| self.appears[stype.index()] = true);
                }
                None => effect.makes().iter().for_each(|stype| self.appears[stype.index()] = true),
            }
        }
    }

    /// Returns how a condition can be attained. `kinds` is the required number of living types, if the
    /// termination has such a requirement.
    fn attainability(&self, condition: &Condition, kinds: Option<i32>) -> Attainable {
        let mut weights = vec![0u32; self.exists.len()];
        for stype in condition.types().iter().filter(|stype| self.exists[stype.index()]) {
            weights[stype.index()] += 1;
        }
        let counted = || (0..weights.len()).filter(|&at| weights[at] > 0);
        let turns = || self.turns.iter().map(|(from, to)| (weights[from.index()], weights[to.index()]));
        let empty = counted().next().is_none();
        let falls = counted().any(|at| self.disappears[at]) || turns().any(|(from, to)| from > to);
        let rises = counted().any(|at| self.appears[at]) || turns().any(|(from, to)| from < to);
        let when = |possible: bool| if possible { Attainable::InPlay } else { Attainable::FromStart };
        match (condition, kinds) {
            (Condition::Tick(limit), _) if *limit <= 0 => Attainable::AtOnce,
            (Condition::Tick(limit), _) if *limit > MAX_TICKS => Attainable::Never,
            (Condition::Tick(_), _) => Attainable::InPlay,
            (Condition::AtMost(_, limit) | Condition::Exactly(_, limit), _) if *limit < 0 => {
                Attainable::Never
            }
            (Condition::AtLeast(_, limit), _) if *limit <= 0 => Attainable::AtOnce,
            (Condition::AtLeast(..), _) if empty => Attainable::Never,
            (Condition::Exactly(_, 0), Some(0)) if empty => Attainable::AtOnce,
            (Condition::Exactly(..), Some(_)) if empty => Attainable::Never,
            (Condition::Exactly(_, limit), None) if empty && *limit > 0 => Attainable::Never,
            (Condition::AtMost(..) | Condition::Exactly(..), _) if empty => Attainable::AtOnce,
            (Condition::AtMost(..), _) => when(falls),
            (Condition::AtLeast(..), _) => when(rises),
            (Condition::Exactly(_, 0), None) => when(falls),
            // Sprites of one type may turn into another type while the total number stays the same.
            (Condition::Exactly(..), Some(_)) => {
                when(falls || rises || turns().any(|(from, to)| from > 0 || to > 0))
            }
            (Condition::Exactly(..), None) => when(falls || rises),
        }
    }
}

/// Returns `true` if the transforming effects among `effects` also transform a dead avatar again in every
/// tick. The only exception is `transformTo`, which is unconditional and transforms no other sprite.
pub(crate) fn turns_dead(effects: &[EffectSummary], precondition: Precondition) -> bool {
    precondition == Precondition::Movement
        || effects
            .iter()
            .any(|effect| matches!(effect, EffectSummary::BecomeAny(_) | EffectSummary::BecomeAll(..)))
}

/// Returns `true` if sprites of the type disappear on their own.
pub(crate) fn disappears_by_itself(rules: &Rules, stype: SpriteType) -> bool {
    let info = &rules.types[stype.index()];
    let is_a = |class: SpriteClass| info.class.is_some_and(|own| own.is_a(class));
    let spawner = is_a(SpriteClass::SpawnPoint) || is_a(SpriteClass::SpawnPointMultiSprite);
    is_a(SpriteClass::Flicker) || info.traits.time_to_live >= 0 || (spawner && info.traits.total > 0)
}

impl Analysis {
    /// Returns `false` only if it is proven that no level can be won by playing it. The proof requires one of
    /// the following for each winning termination:
    ///
    /// - The termination never holds.
    /// - The termination holds only from the start of a level.
    /// - The termination comes after a termination that ends every episode in its first tick.
    pub fn can_win(&self) -> bool {
        self.can_end(true, |_, goal| matches!(goal.attainable, Attainable::InPlay | Attainable::AtOnce))
    }

    /// Returns `false` only if it is proven that no level can be lost by playing it, disregarding the
    /// reference engine's own tick limit. See [`Analysis::can_win`].
    pub fn can_lose(&self) -> bool {
        self.can_end(false, |_, goal| matches!(goal.attainable, Attainable::InPlay | Attainable::AtOnce))
    }

    /// Returns `true` if a termination with this result can be the first to hold. `holds` receives a goal and
    /// its index, and returns whether the goal can hold.
    pub(crate) fn can_end(&self, win: bool, holds: impl Fn(usize, &Goal) -> bool) -> bool {
        for (at, goal) in self.goals.iter().enumerate() {
            let ends = if win { goal.win } else { goal.can_lose() };
            if holds(at, goal) && ends {
                return true;
            }
            if goal.attainable == Attainable::AtOnce {
                return false;
            }
        }
        false
    }
}
