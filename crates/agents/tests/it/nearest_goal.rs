//! Tests of the nearest-goal player.

use agents::{Budget, Limits, NearestGoal, play};
use base::Seed;
use engine::{Game, Outcome};

const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    trap > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    t > trap\n  InteractionSet\n    avatar wall > stepBack\n    avatar trap > killSprite\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=30 win=False\n";

#[test]
fn plums_are_taken_one_after_the_other_by_the_shortest_way() {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level("wwwwwwww\nwA t  pw\nw    w w\nwp     w\nwwwwwwww\n").unwrap();
    let seed = Seed::from_text("nearest");
    let played = play(&game, &level, &mut NearestGoal::new(0.0, seed), Budget(0), seed, Limits::default());
    assert_eq!((played.episode.outcome, played.episode.actions.len()), (Outcome::Won, 9));
}
