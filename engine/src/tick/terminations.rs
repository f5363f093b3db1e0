//! Checks terminations at the end of a tick (`spec/01` §4.8).

use crate::rules::terminations::{Condition, Decision, Termination};
use crate::rules::{Rules, SpriteType};
use crate::world::World;

impl Termination {
    /// Returns `true` if the termination ends the game now.
    pub(crate) fn holds(&self, rules: &Rules, world: &World) -> bool {
        let sum =
            |stypes: &[SpriteType]| stypes.iter().map(|&stype| world.count_live(rules, stype)).sum::<i32>();
        let counted = match &self.condition {
            Condition::SpriteCounter { stype, limit } => world.count_live(rules, *stype) <= *limit,
            Condition::SpriteCounterMore { stype, limit } => world.count_live(rules, *stype) >= *limit,
            Condition::MultiSpriteCounter { stypes, limit, min } => {
                let sum = sum(stypes);
                sum == *limit || (*min && sum > *limit)
            }
            Condition::MultiSpriteCounterSubTypes { stype, limit, kinds } => {
                let tree = &rules.types[stype.index()].tree;
                let alive = |&&stype: &&SpriteType| {
                    world.group(stype).count > 0 && world.count_live(rules, stype) > 0
                };
                world.count_live(rules, *stype) == *limit
                    && tree.iter().filter(alive).count() as i32 == *kinds
            }
            Condition::StopCounter { .. } => false,
            Condition::Timeout { limit } => return world.tick() >= *limit,
        };
        counted && world.can_end()
    }

    /// Returns `true` if the player wins when the termination holds.
    pub(crate) fn wins(&self, world: &World) -> bool {
        match self.decided_by {
            Decision::Line => self.win,
            Decision::Score => world.score() != 0,
            Decision::Difference => world.counters().windows(2).any(|pair| pair[0] != pair[1]),
            Decision::Value(value) => world.counters().first() == Some(&value),
        }
    }

    /// Returns `Some(true)` if counters can end the game from now on, and `Some(false)` if they cannot.
    /// Returns `None` if the termination does not affect this setting.
    pub(crate) fn permits(&self, rules: &Rules, world: &World) -> Option<bool> {
        let Condition::StopCounter { stypes, limit, min } = &self.condition else { return None };
        let sum: i32 = stypes.iter().map(|&stype| world.count_live(rules, stype)).sum();
        Some(if *min { sum <= *limit } else { sum != *limit })
    }
}
