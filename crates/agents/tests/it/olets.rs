//! Tests OLETS in a corridor.

use agents::{Budget, Limits, Olets, OletsConfig, play};
use base::Seed;
use engine::{Game, Outcome};

const GAME: &str = "BasicGame\n  SpriteSet\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=500 win=False\n";

/// Remembered positions push the avatar along a corridor in which no score shows the way.
#[test]
fn long_corridors_are_walked() {
    let game = Game::from_source(GAME).unwrap();
    let level = game
        .level("wwwwwwwwwwwwwwwwwwwwwwwww\nwA                     gw\nwwwwwwwwwwwwwwwwwwwwwwwww\n")
        .unwrap();
    for fixed_refresh in [false, true] {
        let config = OletsConfig { fixed_refresh, ..OletsConfig::default() };
        let mut planner = Olets::new(config, Seed::from_text("olets"));
        let seed = Seed::from_text("chance");
        let played = play(&game, &level, &mut planner, Budget(100), seed, Limits::default());
        assert_eq!(played.episode.outcome, Outcome::Won);
    }
}
