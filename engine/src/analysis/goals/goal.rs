//! Goals: the winning and losing terminations, expressed as sprite counts.

use super::attain::{Attainable, turns_dead};
use crate::analysis::Analysis;
use crate::analysis::interactions::encounter::{EffectSummary, Precondition, timed_effects};
use crate::rules::class::SpriteClass;
use crate::rules::terminations::{Condition as Written, Decision};
use crate::rules::{Rules, SpriteType};
use crate::state::State;

/// The condition under which a termination ends the game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Condition {
    /// At most this many sprites of these types exist.
    AtMost(Vec<SpriteType>, i32),
    /// At least this many sprites of these types are alive.
    AtLeast(Vec<SpriteType>, i32),
    /// Exactly this many sprites of these types are alive.
    Exactly(Vec<SpriteType>, i32),
    /// The episode reaches this tick.
    Tick(i32),
}

impl Condition {
    /// Returns the counted types: all types that can have sprites, including types related to them in the SpriteSet. A
    /// type counted twice by a `MultiSpriteCounter` occurs twice.
    pub fn types(&self) -> &[SpriteType] {
        match self {
            Condition::AtMost(types, _) | Condition::AtLeast(types, _) | Condition::Exactly(types, _) => {
                types
            }
            Condition::Tick(_) => &[],
        }
    }

    /// Returns `true` if the condition holds at this tick with these counts. `count` returns a type's sprite
    /// count.
    pub fn holds(&self, count: impl Fn(SpriteType) -> i32, tick: i32) -> bool {
        let sum = || self.types().iter().map(|&stype| count(stype)).sum::<i32>();
        match self {
            Condition::AtMost(_, limit) => sum() <= *limit,
            Condition::AtLeast(_, limit) => sum() >= *limit,
            Condition::Exactly(_, limit) => sum() == *limit,
            Condition::Tick(limit) => tick >= *limit,
        }
    }

    /// Returns how far the condition is from holding: the number of sprites to remove or add, or the number
    /// of ticks to wait.
    pub fn missing(&self, count: impl Fn(SpriteType) -> i32, tick: i32) -> u32 {
        let sum = || self.types().iter().map(|&stype| i64::from(count(stype))).sum::<i64>();
        let missing = match self {
            Condition::AtMost(_, limit) => sum() - i64::from(*limit),
            Condition::AtLeast(_, limit) => i64::from(*limit) - sum(),
            Condition::Exactly(_, limit) => (sum() - i64::from(*limit)).abs(),
            Condition::Tick(limit) => i64::from(*limit) - i64::from(tick),
        };
        u32::try_from(missing.max(0)).unwrap_or(u32::MAX)
    }
}

/// A termination. Terminations are ordered by priority: the first termination that holds at the end of a tick
/// ends the game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Goal {
    /// `true` if the termination wins the game, or may win it: see [`Goal::is_open`].
    pub win: bool,
    /// `true` if the score or the counters decide whether the termination wins or loses.
    open: bool,
    /// The condition under which the termination holds.
    pub condition: Condition,
    /// The required number of distinct types among the counted sprites, if the termination has such a
    /// requirement.
    pub kinds: Option<i32>,
    /// The index of the termination's line in [`Description::terminations`](crate::Description).
    pub line: usize,
    /// The conditions under which the termination can hold.
    pub attainable: Attainable,
}

impl Goal {
    /// Returns `true` if the score or the counters decide whether the termination wins or loses the game.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Returns `true` if the termination loses the game, or may lose it.
    pub fn can_lose(&self) -> bool {
        self.open || !self.win
    }
}

/// The requirements that the terminations impose on the player. Each list is sorted by type.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Aims {
    /// Types whose sprites must be removed for a win, either entirely or down to a small number.
    pub remove: Vec<SpriteType>,
    /// Types whose number of sprites must increase for a win.
    pub create: Vec<SpriteType>,
    /// Non-avatar types whose disappearance loses the game.
    pub protect: Vec<SpriteType>,
    /// Types whose appearance loses the game.
    pub prevent: Vec<SpriteType>,
    /// The tick at which the game is won if the player survives until then; `None` if survival does not win.
    pub survive: Option<i32>,
    /// The first tick at which a Timeout loses, or may lose, the game, disregarding the reference engine's own tick
    /// limit. `None` if no Timeout loses.
    pub deadline: Option<i32>,
    /// `true` if losing the avatar loses the game.
    pub avatar_must_live: bool,
}

pub(crate) fn goals(rules: &Rules) -> Vec<Goal> {
    let goal = |(line, termination): (usize, &crate::rules::terminations::Termination)| {
        let tree = |stype: &SpriteType| rules.types[stype.index()].tree.iter().copied();
        let types = termination.counts().iter().flat_map(tree);
        let types = types.filter(|stype| rules.types[stype.index()].class.is_some()).collect();
        let condition = match termination.condition {
            Written::SpriteCounter { limit, .. } => Condition::AtMost(types, limit),
            Written::SpriteCounterMore { limit, .. }
            | Written::MultiSpriteCounter { limit, min: true, .. } => Condition::AtLeast(types, limit),
            Written::MultiSpriteCounter { limit, .. } | Written::MultiSpriteCounterSubTypes { limit, .. } => {
                Condition::Exactly(types, limit)
            }
            Written::StopCounter { .. } => return None,
            Written::Timeout { limit } => Condition::Tick(limit),
        };
        let kinds = match termination.condition {
            Written::MultiSpriteCounterSubTypes { kinds, .. } => Some(kinds),
            Written::SpriteCounter { .. }
            | Written::SpriteCounterMore { .. }
            | Written::MultiSpriteCounter { .. }
            | Written::StopCounter { .. }
            | Written::Timeout { .. } => None,
        };
        let (win, open) = (termination.win, termination.decided_by != Decision::Line);
        // `attain::find_attainable` determines `attainable` later.
        Some(Goal { win, open, condition, kinds, line, attainable: Attainable::InPlay })
    };
    rules.terminations.iter().enumerate().filter_map(goal).collect()
}

pub(crate) fn aims(rules: &Rules, goals: &[Goal]) -> Aims {
    let is_avatar = |stype: &SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
    let mut aims = Aims::default();
    for goal in goals {
        // "Exactly 0" means that all sprites must disappear. "Exactly 3" means that more sprites must appear,
        // because levels start with fewer.
        let fewer = match &goal.condition {
            Condition::AtMost(..) => true,
            Condition::Exactly(_, limit) => *limit <= 0,
            Condition::AtLeast(..) => false,
            Condition::Tick(limit) => {
                let earliest = |known: Option<i32>| Some(known.map_or(*limit, |tick| tick.min(*limit)));
                if goal.win {
                    aims.survive = earliest(aims.survive);
                }
                if goal.can_lose() {
                    aims.deadline = earliest(aims.deadline);
                }
                continue;
            }
        };
        let types = goal.condition.types().iter().copied();
        match (goal.win, fewer) {
            (true, true) => aims.remove.extend(types.filter(|stype| !is_avatar(stype))),
            (true, false) => aims.create.extend(types),
            (false, true) => {
                aims.avatar_must_live |= types.clone().any(|stype| is_avatar(&stype));
                aims.protect.extend(types.filter(|stype| !is_avatar(stype)));
            }
            (false, false) => aims.prevent.extend(types),
        }
    }
    for list in [&mut aims.remove, &mut aims.create, &mut aims.protect, &mut aims.prevent] {
        list.sort_unstable();
        list.dedup();
    }
    aims
}

impl Analysis {
    /// Returns the terminations in order of priority.
    pub fn goals(&self) -> &[Goal] {
        &self.goals
    }

    /// Returns the requirements that the terminations impose on the player.
    pub fn aims(&self) -> &Aims {
        &self.aims
    }

    /// Returns `true` if the total number of sprites of these types never exceeds the number at the start of
    /// a level: every effect that creates such a sprite uses up another one. Effects that transform a dead
    /// avatar again in every tick do not meet this condition. Cost: O(encounters × types).
    pub fn only_falls(&self, types: &[SpriteType]) -> bool {
        let game = &self.game;
        let one_of = |stype: &SpriteType| types.contains(stype);
        // A type may be counted more than once.
        let weight = |stype: SpriteType| types.iter().filter(|counted| **counted == stype).count();
        let least_weight = |written: SpriteType| {
            game.sprite_types().filter(|stype| self.applies(written, *stype)).map(weight).min()
        };
        let is_made = |maker: SpriteType| self.can_exist(maker) && self.facts(maker).makes.iter().any(one_of);
        let adds = |effect: &EffectSummary, first: Option<SpriteType>, turns_dead: bool| {
            if *effect == EffectSummary::Clone {
                return first
                    .is_none_or(|first| game.sprite_types().any(|s| one_of(&s) && self.applies(first, s)));
            }
            let is_avatar = |written: SpriteType| {
                let tree = game.sprite_types().filter(|stype| self.applies(written, *stype));
                tree.into_iter().any(|stype| game.class(stype).is_some_and(SpriteClass::is_avatar))
            };
            // A second `transformToAll` in the same tick also transforms the sprites that the first one has
            // already transformed.
            let takes_one = !matches!(effect, EffectSummary::Make(_) | EffectSummary::BecomeAll(..))
                && first.is_some_and(|first| {
                    let most = effect.makes().iter().map(|made| weight(*made)).max();
                    least_weight(first).is_some_and(|least| least > 0 && most <= Some(least))
                        && !(turns_dead && is_avatar(first))
                });
            effect.makes().iter().any(one_of) && !takes_one
        };
        let timed = timed_effects(&game.0);
        !game.sprite_types().any(is_made)
            && !self.encounters.iter().any(|met| {
                met.does(|effect| adds(effect, Some(met.first), turns_dead(&met.effects, met.precondition)))
            })
            && !timed.iter().any(|(target, effects)| {
                effects.iter().any(|effect| adds(effect, *target, turns_dead(effects, Precondition::Always)))
            })
    }

    /// Returns the termination that would end the game if a tick ended in this state; `None` if no termination would.
    /// Cost: O(goals × types).
    pub fn goal_met(&self, state: &State) -> Option<&Goal> {
        let rules = &*self.game.0;
        self.goals.iter().find(|goal| rules.terminations[goal.line].holds(rules, &state.world))
    }

    /// Returns how far a goal is from holding in this state: see [`Condition::missing`]. Cost: O(types).
    pub fn missing(&self, goal: &Goal, state: &State) -> u32 {
        let live = |stype: SpriteType| {
            let group = state.world.group(stype);
            i32::from(group.count - group.disabled)
        };
        goal.condition.missing(live, state.tick())
    }
}
