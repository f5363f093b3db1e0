//! The terminations: conditions that end a game (`spec/01` §4.8).

use super::{Rules, SpriteType};
use smallvec::SmallVec;

/// A termination. The first termination that holds ends the game.
#[derive(Clone, Debug)]
pub(crate) struct Termination {
    pub(crate) condition: Condition,
    /// `true` if the termination wins the game, or may win it.
    pub(crate) win: bool,
    /// The way in which the termination decides between a win and a loss.
    pub(crate) decided_by: Decision,
}

/// The way in which a termination decides between a win and a loss (`spec/01` §4.8, for one player).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decision {
    /// The line's `win` parameter decides.
    Line,
    /// `count_score`: any score other than 0 wins.
    Score,
    /// `use_counter` and `compare`: the player wins if the counters are not all equal.
    Difference,
    /// `use_counter`: the player wins if the only counter has this value.
    Value(i32),
}

#[derive(Clone, Debug)]
pub(crate) enum Condition {
    /// Holds while at most `limit` sprites exist.
    SpriteCounter { stype: SpriteType, limit: i32 },
    /// Holds while at least `limit` sprites exist.
    SpriteCounterMore { stype: SpriteType, limit: i32 },
    /// Holds while several types have a total of exactly `limit` sprites, or at least `limit` sprites if
    /// `min` is `true`.
    MultiSpriteCounter { stypes: SmallVec<[SpriteType; 3]>, limit: i32, min: bool },
    /// Holds while a type has exactly `limit` sprites of exactly `kinds` distinct subtypes.
    MultiSpriteCounterSubTypes { stype: SpriteType, limit: i32, kinds: i32 },
    /// Never holds, but prevents counters from ending the game while the sum equals the limit, or exceeds
    /// the limit if `min` is `true`.
    StopCounter { stypes: SmallVec<[SpriteType; 3]>, limit: i32, min: bool },
    /// Holds from the tick `limit` on.
    Timeout { limit: i32 },
}

/// Returns `true` if anything can prevent a sprite-counting termination from ending the game while it holds.
pub(crate) fn can_be_held_up(rules: &Rules) -> bool {
    !rules.can_end
        || rules.terminations.iter().any(|end| matches!(end.condition, Condition::StopCounter { .. }))
}

impl Termination {
    /// Returns the first tick at which the termination holds, if it depends on the tick.
    pub(crate) fn timeout(&self) -> Option<i32> {
        match self.condition {
            Condition::Timeout { limit } => Some(limit),
            Condition::SpriteCounter { .. }
            | Condition::SpriteCounterMore { .. }
            | Condition::MultiSpriteCounter { .. }
            | Condition::MultiSpriteCounterSubTypes { .. }
            | Condition::StopCounter { .. } => None,
        }
    }

    /// Returns the types that the termination counts. Related types in the SpriteSet are counted, too.
    pub(crate) fn counts(&self) -> &[SpriteType] {
        match &self.condition {
            Condition::SpriteCounter { stype, .. }
            | Condition::SpriteCounterMore { stype, .. }
            | Condition::MultiSpriteCounterSubTypes { stype, .. } => std::slice::from_ref(stype),
            Condition::MultiSpriteCounter { stypes, .. } | Condition::StopCounter { stypes, .. } => stypes,
            Condition::Timeout { .. } => &[],
        }
    }
}
