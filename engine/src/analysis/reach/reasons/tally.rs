//! The minimum and maximum numbers of sprites in a level, and their consequences for the level's
//! terminations.

use super::cause::Cause;
use crate::analysis::goals::attain::disappears_by_itself;
use crate::analysis::goals::goal::Condition;
use crate::analysis::reach::cells::Cells;
use crate::analysis::reach::events::Placed;
use crate::analysis::reach::model::Model;
use crate::rules::{Rules, SpriteType};

/// The results of the completed fixed point.
pub(crate) struct Tally<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) model: &'a Model<'a>,
    pub(crate) placed: &'a Placed,
    /// For each type, the cells where a sprite can be removed.
    pub(crate) removable: &'a [Cells],
    /// For each type, whether its sprites can appear during an episode.
    pub(crate) made: &'a [bool],
}

impl Tally<'_> {
    /// Returns the reason why a termination with this condition can never hold, or `None` if nothing is
    /// proven.
    pub(crate) fn hinders(&self, condition: &Condition) -> Option<Cause> {
        let types = condition.types();
        let stay = |limit: i32| {
            let stay: Vec<_> = types.iter().flat_map(|&stype| self.staying(stype)).collect();
            (stay.len() as i64 > i64::from(limit)).then_some(Cause::Permanent(stay))
        };
        let few = |limit: i32| {
            let most: Option<i64> = types.iter().map(|&stype| self.most(stype)).sum();
            most.filter(|most| *most < i64::from(limit)).map(Cause::AtMost)
        };
        match condition {
            Condition::AtMost(_, limit) => stay(*limit),
            Condition::AtLeast(_, limit) => few(*limit),
            Condition::Exactly(_, limit) => stay(*limit).or_else(|| few(*limit)),
            Condition::Tick(_) => None,
        }
    }

    /// Returns the type's sprites that nothing ever removes, with the cells in which the level places them.
    fn staying(&self, stype: SpriteType) -> Vec<(SpriteType, usize)> {
        let info = &self.rules.types[stype.index()];
        let removable = &self.removable[stype.index()];
        let single = info.path.iter().any(|&stype| self.rules.types[stype.index()].singleton);
        let fixed = self.model.of_type(stype).fixed;
        if single
            || self.is_surplus(stype)
            || disappears_by_itself(self.rules, stype)
            || !(fixed || removable.is_empty())
        {
            return Vec::new();
        }
        let stays = self.placed[stype.index()].iter().filter(|(cell, _)| !removable.contains(*cell));
        let sprites = stays.flat_map(|&(cell, count)| std::iter::repeat_n((stype, cell), count as usize));
        sprites.map(|(stype, cell)| (stype, self.model.board.on_level(cell))).collect()
    }

    /// Returns `true` if sprites of the type may be surplus avatars, which are removed when a level starts.
    fn is_surplus(&self, stype: SpriteType) -> bool {
        let passes = |stype: &SpriteType| self.model.info(*stype).is_like_avatar();
        let count = || self.model.types().filter(passes).map(|stype| self.count(stype)).sum::<i64>();
        passes(&stype) && count() > 1
    }

    fn count(&self, stype: SpriteType) -> i64 {
        self.placed[stype.index()].iter().map(|(_, count)| i64::from(*count)).sum()
    }

    /// Returns the maximum number of sprites of the type that can exist at the same time, or `None` if the
    /// maximum is unknown.
    fn most(&self, stype: SpriteType) -> Option<i64> {
        (!self.made[stype.index()]).then(|| self.count(stype))
    }
}
