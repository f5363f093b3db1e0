//! Goals with a sign: what wins, what loses, in terms of counts of sprite types.

use super::Analysis;
use super::attain::Attainable;
use crate::game::{Rules, SpriteType};
use crate::ontology::terminations::Condition as Written;
use crate::state::State;

/// What must hold for a termination to end the game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Condition {
    /// At most so many sprites of these types live.
    AtMost(Vec<SpriteType>, i32),
    /// At least so many sprites of these types live.
    AtLeast(Vec<SpriteType>, i32),
    /// Exactly so many sprites of these types live.
    Exactly(Vec<SpriteType>, i32),
    /// This tick is reached.
    Tick(i32),
}

impl Condition {
    /// The types that are counted: those that can have sprites, relatives included. A type that a
    /// `MultiSpriteCounter` counts twice stands twice.
    pub fn types(&self) -> &[SpriteType] {
        match self {
            Condition::AtMost(types, _) | Condition::AtLeast(types, _) | Condition::Exactly(types, _) => {
                types
            }
            Condition::Tick(_) => &[],
        }
    }

    /// Whether it holds with these counts, given by type, at this tick.
    pub fn holds(&self, count: impl Fn(SpriteType) -> i32, tick: i32) -> bool {
        let sum = || self.types().iter().map(|&stype| count(stype)).sum::<i32>();
        match self {
            Condition::AtMost(_, limit) => sum() <= *limit,
            Condition::AtLeast(_, limit) => sum() >= *limit,
            Condition::Exactly(_, limit) => sum() == *limit,
            Condition::Tick(limit) => tick >= *limit,
        }
    }

    /// How far it is from holding with these counts at this tick: sprites that must go or come, or ticks that must pass.
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

/// A termination, in order of priority: the first one that holds at the end of a tick ends the game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Goal {
    /// Whether the player wins by it.
    pub win: bool,
    /// When.
    pub condition: Condition,
    /// Index of the line in [`Description::terminations`](crate::Description).
    pub line: usize,
    /// Whether the rules can bring it about.
    pub attainable: Attainable,
}

/// What the terminations ask of the player, sorted by type.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Aims {
    /// Types of which few or none may be left for a win.
    pub remove: Vec<SpriteType>,
    /// Types of which more have to appear for a win.
    pub create: Vec<SpriteType>,
    /// Types, avatars apart, whose loss loses.
    pub protect: Vec<SpriteType>,
    /// Types whose appearance loses.
    pub prevent: Vec<SpriteType>,
    /// The tick at which mere survival wins.
    pub survive: Option<i32>,
    /// The tick at which the player has lost at the latest, the reference's own limit apart.
    pub deadline: Option<i32>,
    /// Whether the loss of the avatar loses.
    pub avatar_must_live: bool,
}

pub(super) fn goals(rules: &Rules) -> Vec<Goal> {
    let goal = |(line, termination): (usize, &crate::ontology::terminations::Termination)| {
        let condition = match &termination.condition {
            Written::SpriteCounter { stype, limit } => Condition::AtMost(counted(rules, *stype), *limit),
            Written::SpriteCounterMore { stype, limit } => Condition::AtLeast(counted(rules, *stype), *limit),
            Written::MultiSpriteCounter { stypes, limit, min } => {
                let types = stypes.iter().flat_map(|&stype| counted(rules, stype)).collect();
                if *min { Condition::AtLeast(types, *limit) } else { Condition::Exactly(types, *limit) }
            }
            Written::MultiSpriteCounterSubTypes { stype, limit, .. } => {
                Condition::Exactly(counted(rules, *stype), *limit)
            }
            Written::StopCounter { .. } => return None,
            Written::Timeout { limit } => Condition::Tick(*limit),
        };
        // `attain::judge` says more.
        Some(Goal { win: termination.win, condition, line, attainable: Attainable::InPlay })
    };
    rules.terminations.iter().enumerate().filter_map(goal).collect()
}

fn counted(rules: &Rules, stype: SpriteType) -> Vec<SpriteType> {
    let tree = rules.types[stype.index()].tree.iter().copied();
    tree.filter(|stype| rules.types[stype.index()].class.is_some()).collect()
}

pub(super) fn aims(rules: &Rules, goals: &[Goal]) -> Aims {
    let is_avatar = |stype: &SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
    let mut aims = Aims::default();
    for goal in goals {
        // "Exactly 0" is "none left"; "exactly 3" is "so many appear", because levels start with fewer.
        let fewer = match &goal.condition {
            Condition::AtMost(..) => true,
            Condition::Exactly(_, limit) => *limit <= 0,
            Condition::AtLeast(..) => false,
            Condition::Tick(limit) => {
                let earliest = |known: Option<i32>| Some(known.map_or(*limit, |tick| tick.min(*limit)));
                if goal.win {
                    aims.survive = earliest(aims.survive);
                } else {
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
    /// The terminations, in order of priority.
    pub fn goals(&self) -> &[Goal] {
        &self.goals
    }

    /// What the terminations ask of the player.
    pub fn aims(&self) -> &Aims {
        &self.aims
    }

    /// The termination that would end the game if this state were the end of a tick. Cost: O(goals × types).
    pub fn goal_met(&self, state: &State) -> Option<&Goal> {
        let rules = &*self.game.0;
        self.goals.iter().find(|goal| rules.terminations[goal.line].holds(rules, state))
    }

    /// How far a goal is from being met in this state: see [`Condition::missing`]. Cost: O(types).
    pub fn missing(&self, goal: &Goal, state: &State) -> u32 {
        let live = |stype: SpriteType| {
            let group = state.group(stype);
            i32::from(group.count - group.disabled)
        };
        goal.condition.missing(live, state.tick())
    }
}
