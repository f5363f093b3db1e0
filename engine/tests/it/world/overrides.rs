//! Tests sprites with values that differ from the values of their type.

use base::Seed;
use engine::inspect::overrides;
use engine::{Action, Game};

const GAME: &str = "BasicGame square_size=10\n  SpriteSet\n    arrow > Missile orientation=LEFT speed=1\n    wall > Immovable\n    \
                    grave > Immovable\n    car > CarAvatar\n  LevelMapping\n    a > arrow\n    w > wall\n    g > grave\n    A > car\n  \
                    InteractionSet\n    arrow wall > reverseDirection\n    arrow wall > stepBack\n    arrow grave > killSprite\n    \
                    car EOS > stepBack\n  TerminationSet\n    Timeout limit=50 win=True\n";

#[test]
fn sprites_own_overrides_from_the_first_change_until_release() {
    let game = Game::from_source(GAME).unwrap();
    let mut state = game.start(&game.level("wa g\nga w\nA   \n").unwrap(), Seed::from_text("arrows"));
    let types = game.sprite_types().count();
    let mut own = Vec::new();
    for _ in 0..5 {
        own.push(overrides(&state) - types);
        game.step(&mut state, Action::Nil);
        state.recount(&game).unwrap();
        assert_eq!(state.state_hash(), state.state_hash_from_scratch());
    }
    // The first overrides are the car's. The next overrides belong to the arrow that turns back at the wall,
    // until it is killed. The other arrow is killed at once.
    assert_eq!(own, [0, 1, 2, 2, 1]);
}
