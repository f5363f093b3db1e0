//! Tests game spaces, which are games with named parameters.

use engine::syntax::{parse, print};
use engine::{Diagnostics, Game};

const GAME: &str = "GameSpace\n  ParameterSet\n    SPEED > values=0.1:0.3:1.0 value=0.4\n    LIMIT > values=2:3:9 value=5\n    WIN > values=True:False value=TRUE\n  SpriteSet\n    gold > Resource limit=LIMIT\n    avatar > MovingAvatar speed=SPEED\n  LevelMapping\n    g > gold\n  InteractionSet\n    gold avatar > collectResource scoreChange=LIMIT,1\n    avatar wall > addTimer timer=LIMIT ftype=killAll stype=gold scoreChange=LIMIT\n  TerminationSet\n    SpriteCounter stype=gold win=WIN\n    Timeout limit=LIMIT win=False\n";

#[test]
fn a_game_space_plays_and_prints() {
    let game = Game::from_source(GAME).unwrap_or_else(|problems| panic!("{problems}"));
    let text = print(&parse(GAME).0);
    assert!(text.contains("    ParameterSet\n        SPEED > values=0.1:0.3:1.0 value=0.4\n"), "{text}");
    assert_eq!(Game::from_source(&text).unwrap().digest(), game.digest());
    let again = print(game.description());
    assert_eq!(Game::from_source(&again).unwrap().digest(), game.digest());
}

#[test]
fn parameters_belong_to_game_spaces() {
    assert!(Game::from_source(&GAME.replace("GameSpace", "BasicGame")).is_err());
}

/// A game with a range of one value can be played. A step that leads nowhere is a fault, but the reference ignores it
/// if `value=` is given.
#[test]
fn a_range_of_one_value_plays() {
    let limit = |with: &str, load: fn(&str) -> Result<Game, Diagnostics>| {
        load(&GAME.replace("values=2:3:9 value=5", with)).map(|game| game.time_limit()).ok()
    };
    let (strict, reference) = (Game::from_source, Game::from_source_as_reference);
    for load in [strict, reference] {
        assert_eq!(limit("values=5:0:5 value=5", load), Some(6));
        assert_eq!(limit("values=5:5 value=5", load), None);
    }
    assert_eq!((limit("values=7:0:7", strict), limit("values=7:0:7", reference)), (None, Some(8)));
    assert_eq!(
        (limit("values=9:3:2 value=5", strict), limit("values=9:3:2 value=5", reference)),
        (None, Some(6))
    );
    assert_eq!((limit("values=9:3:2", strict), limit("values=9:3:2", reference)), (None, None));
}
