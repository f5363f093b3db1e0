//! Types that no rule mentions.

use crate::analysis::Analysis;
use crate::rules::SpriteType;

impl Analysis {
    /// Returns `true` if only the type's own line, its parents' lines and the LevelMapping mention the
    /// type. The type's sprites stay where the level placed them, and affect nothing. Returns `false` if
    /// in doubt: a value that merely has the same spelling as the type counts as a mention, too.
    pub fn is_scenery(&self, stype: SpriteType) -> bool {
        let moves =
            self.facts(stype).motion != crate::analysis::Motion::Still || !self.facts(stype).makes.is_empty();
        !moves && !self.game.0.referenced[stype.index()]
    }
}
