//! When a game ends (`spec/01` §4.8).

use crate::game::{Rules, SpriteType};
use crate::state::State;
use smallvec::SmallVec;

/// A termination: the first one that holds ends the game.
#[derive(Debug)]
pub(crate) struct Termination {
    pub(crate) condition: Condition,
    /// Whether the player wins by it.
    pub(crate) win: bool,
}

#[derive(Debug)]
pub(crate) enum Condition {
    /// At most so many are left.
    SpriteCounter { stype: SpriteType, limit: i32 },
    /// At least so many are there.
    SpriteCounterMore { stype: SpriteType, limit: i32 },
    /// Exactly so many of several types together; `min`: that many or more.
    MultiSpriteCounter { stypes: SmallVec<[SpriteType; 3]>, limit: i32, min: bool },
    /// The tick is reached.
    Timeout { limit: i32 },
}

/// The termination classes that the engine plays.
pub(crate) const NAMES: &[&str] = &["SpriteCounter", "SpriteCounterMore", "MultiSpriteCounter", "Timeout"];
/// Those of the reference that it does not play yet.
pub(crate) const LATER: &[&str] = &["MultiSpriteCounterSubTypes", "StopCounter"];

impl Termination {
    pub(crate) fn holds(&self, rules: &Rules, state: &State) -> bool {
        match &self.condition {
            Condition::SpriteCounter { stype, limit } => state.count_live(rules, *stype) <= *limit,
            Condition::SpriteCounterMore { stype, limit } => state.count_live(rules, *stype) >= *limit,
            Condition::MultiSpriteCounter { stypes, limit, min } => {
                let sum: i32 = stypes.iter().map(|&stype| state.count_live(rules, stype)).sum();
                sum == *limit || (*min && sum > *limit)
            }
            Condition::Timeout { limit } => state.tick >= *limit,
        }
    }
}
