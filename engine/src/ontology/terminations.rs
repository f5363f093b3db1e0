//! When a game ends (`spec/01` §4.8).

use crate::game::{Rules, SpriteType};
use crate::state::State;
use smallvec::SmallVec;

/// A termination: the first one that holds ends the game.
#[derive(Clone, Debug)]
pub(crate) struct Termination {
    pub(crate) condition: Condition,
    /// Whether the player wins by it, or may.
    pub(crate) win: bool,
    /// What else decides.
    pub(crate) decided_by: Decision,
}

/// What decides whether the player wins by a termination (`spec/01` §4.8, with one player).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decision {
    /// `win`.
    Line,
    /// `count_score`: any score but 0 is the highest one.
    Score,
    /// `use_counter` and `compare`: counters that are not all equal.
    Difference,
    /// `use_counter`: the one counter has this value.
    Value(i32),
}

#[derive(Clone, Debug)]
pub(crate) enum Condition {
    /// At most so many are left.
    SpriteCounter { stype: SpriteType, limit: i32 },
    /// At least so many are there.
    SpriteCounterMore { stype: SpriteType, limit: i32 },
    /// Exactly so many of several types together; `min`: that many or more.
    MultiSpriteCounter { stypes: SmallVec<[SpriteType; 3]>, limit: i32, min: bool },
    /// Exactly so many of a type, of so many kinds.
    MultiSpriteCounterSubTypes { stype: SpriteType, limit: i32, kinds: i32 },
    /// Never holds, and keeps counters from ending the game while the sum is the limit (`min`: is above it).
    StopCounter { stypes: SmallVec<[SpriteType; 3]>, limit: i32, min: bool },
    /// The tick is reached.
    Timeout { limit: i32 },
}

/// The termination classes of VGDL (`spec/01` §4.8).
pub const NAMES: &[&str] = &[
    "SpriteCounter",
    "SpriteCounterMore",
    "MultiSpriteCounter",
    "MultiSpriteCounterSubTypes",
    "StopCounter",
    "Timeout",
];

/// Whether something can keep counting terminations that hold from ending the game.
pub(crate) fn can_be_held_up(rules: &Rules) -> bool {
    !rules.can_end
        || rules.terminations.iter().any(|end| matches!(end.condition, Condition::StopCounter { .. }))
}

impl Termination {
    /// The tick from which on it holds, of those that hold by the tick.
    pub(crate) fn timeout(&self) -> Option<i32> {
        match self.condition {
            Condition::Timeout { limit } => Some(limit),
            _ => None,
        }
    }

    /// The types whose families it counts.
    pub(crate) fn counts(&self) -> &[SpriteType] {
        match &self.condition {
            Condition::SpriteCounter { stype, .. }
            | Condition::SpriteCounterMore { stype, .. }
            | Condition::MultiSpriteCounterSubTypes { stype, .. } => std::slice::from_ref(stype),
            Condition::MultiSpriteCounter { stypes, .. } | Condition::StopCounter { stypes, .. } => stypes,
            Condition::Timeout { .. } => &[],
        }
    }

    /// Whether the game ends by it now.
    pub(crate) fn holds(&self, rules: &Rules, state: &State) -> bool {
        let sum =
            |stypes: &[SpriteType]| stypes.iter().map(|&stype| state.count_live(rules, stype)).sum::<i32>();
        let counted = match &self.condition {
            Condition::SpriteCounter { stype, limit } => state.count_live(rules, *stype) <= *limit,
            Condition::SpriteCounterMore { stype, limit } => state.count_live(rules, *stype) >= *limit,
            Condition::MultiSpriteCounter { stypes, limit, min } => {
                let sum = sum(stypes);
                sum == *limit || (*min && sum > *limit)
            }
            Condition::MultiSpriteCounterSubTypes { stype, limit, kinds } => {
                let tree = &rules.types[stype.index()].tree;
                let alive = |&&stype: &&SpriteType| {
                    state.group(stype).count > 0 && state.count_live(rules, stype) > 0
                };
                state.count_live(rules, *stype) == *limit
                    && tree.iter().filter(alive).count() as i32 == *kinds
            }
            Condition::StopCounter { .. } => false,
            Condition::Timeout { limit } => return state.tick >= *limit,
        };
        counted && state.can_end
    }

    /// Whether the player wins by it, now that it holds.
    pub(crate) fn wins(&self, state: &State) -> bool {
        match self.decided_by {
            Decision::Line => self.win,
            Decision::Score => state.score != 0,
            Decision::Difference => state.counters.windows(2).any(|pair| pair[0] != pair[1]),
            Decision::Value(value) => state.counters.first() == Some(&value),
        }
    }

    /// Whether counters may end the game from here on, if this termination is one that says so.
    pub(crate) fn permits(&self, rules: &Rules, state: &State) -> Option<bool> {
        let Condition::StopCounter { stypes, limit, min } = &self.condition else { return None };
        let sum: i32 = stypes.iter().map(|&stype| state.count_live(rules, stype)).sum();
        Some(if *min { sum <= *limit } else { sum != *limit })
    }
}
