//! Types that no rule mentions.

use super::Analysis;
use crate::rules::SpriteType;

impl Analysis {
    /// Returns `true` if only its own line, its parents' lines and the LevelMapping mention a type: its sprites stay
    /// where the level placed them, and make no difference to anything. `false` if in doubt: a value that merely has
    /// the same spelling as the type mentions it, too.
    pub fn is_scenery(&self, stype: SpriteType) -> bool {
        let moves = self.facts(stype).motion != super::Motion::Still || !self.facts(stype).makes.is_empty();
        !moves && !self.game.0.referenced[stype.index()]
    }
}

#[cfg(test)]
mod tests {
    use crate::{Analysis, Game};

    #[test]
    fn types_without_rules_are_scenery() {
        let game = Game::from_source(
            "BasicGame\n  SpriteSet\n    grass > Immovable\n    ground >\n      sand > Immovable\n      clay > Immovable\n    \
             asleep > Immovable\n    bird > RandomNPC\n    nest > SpawnPoint stype=bird\n    hero > MovingAvatar\n  LevelMapping\n    \
             g > grass\n    s > sand\n    c > clay\n    z > asleep\n    n > nest\n    A > grass hero\n  InteractionSet\n    \
             bird hero > transformTo stype=asleep\n    hero ground > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n",
        )
        .unwrap();
        let analysis = Analysis::of(&game);
        let scenery = |name: &str| analysis.is_scenery(game.sprite_type(name).unwrap());
        assert_eq!(
            ["grass", "sand", "clay", "asleep", "bird", "nest", "hero"].map(scenery),
            [true, false, false, false, false, false, false]
        );
    }
}
