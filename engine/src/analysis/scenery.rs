//! Which types no rule is about.

use super::Analysis;
use crate::game::SpriteType;
use crate::syntax::Param;

impl Analysis {
    /// Whether nothing but its own line, its parents' and the LevelMapping speaks of a type: its sprites are where the level
    /// has put them, and make no difference to anything. False where in doubt: a value that is only spelled like the type
    /// speaks of it, too. Cost: O(words of the game).
    pub fn is_scenery(&self, stype: SpriteType) -> bool {
        let rules = &self.game.0;
        let relatives: Vec<&str> =
            rules.types[stype.index()].tree.iter().map(|&other| self.game.name(other)).collect();
        let names = |text: &str| text.split(',').any(|part| relatives.contains(&part));
        let speak = |params: &[Param]| params.iter().any(|param| names(&param.value.text));
        let game = &rules.description;
        let interactions = game.interactions.iter().any(|line| {
            let partners = line.second.iter().any(|second| names(&second.text));
            names(&line.first.text) || partners || speak(&line.params)
        });
        let others = game.sprite_lines().iter().any(|(_, line)| speak(&line.params));
        let endings = game.terminations.iter().any(|line| speak(&line.params));
        let moves = self.facts(stype).motion != super::Motion::Still || !self.facts(stype).makes.is_empty();
        !(interactions || others || endings || moves || speak(&game.header.params))
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
