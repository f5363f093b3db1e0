//! Which types no rule is about.

use super::Analysis;
use crate::game::SpriteType;

impl Analysis {
    /// Whether nothing but its own line, its parents' and the LevelMapping speaks of a type: its sprites are where the level
    /// has put them, and make no difference to anything. False where in doubt: a value that is only spelled like the type
    /// speaks of it, too.
    pub fn is_scenery(&self, stype: SpriteType) -> bool {
        let moves = self.facts(stype).motion != super::Motion::Still || !self.facts(stype).makes.is_empty();
        !moves && !self.game.0.spoken_of[stype.index()]
    }
}

#[cfg(test)]
mod tests {
    use crate::{Analysis, Game};

    #[test]
    fn what_no_rule_is_about() {
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
