//! Tests states that are constructed instead of played.

use base::Seed;
use engine::{Action, Direction, Game};

const GAME: &str = "BasicGame\n  SpriteSet\n    gate > Door\n    key > Resource limit=3\n    dart > Missile\n    avatar > ShootAvatar stype=dart ammo=key\n  LevelMapping\n    g > gate\n    k > key\n  InteractionSet\n    gate dart > killBoth\n    dart EOS > killSprite\n    avatar EOS > stepBack\n    key avatar > collectResource\n  TerminationSet\n    SpriteCounter stype=gate win=True\n";

#[test]
fn a_position_plays_on_like_one_that_was_played() {
    let game = Game::from_source(GAME).unwrap();
    let level = |text: &str| game.level(text).unwrap();
    let mut played = game.start(&level("kA  g"), Seed::from_text("a"));
    for action in [Action::Left, Action::Left, Action::Right] {
        game.step(&mut played, action);
    }
    let key = game.sprite_type("key").unwrap();
    let arranged = |facing| game.start_as(&level("A   g"), Seed::from_text("a"), facing, &[(key, 1)]);
    let mut right = arranged(Some(Direction::RIGHT));
    let mut left = arranged(Some(Direction::LEFT));
    assert_eq!(game.observe(&right).resources, game.observe(&played).resources);
    assert_eq!(game.observe(&right).avatar, game.observe(&played).avatar);
    assert_ne!(right.state_hash(), left.state_hash());
    for state in [&mut played, &mut right, &mut left] {
        game.step(state, Action::Use);
        (0..5).for_each(|_| {
            game.step(state, Action::Nil);
        });
    }
    assert_eq!((played.is_over(), right.is_over(), left.is_over()), (true, true, false));
    assert_eq!(game.observe(&right).resources, game.observe(&played).resources);
}
