//! Tests of scenery.

use engine::{Analysis, Game};

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
