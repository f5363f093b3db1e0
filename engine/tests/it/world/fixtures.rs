//! Tests fixtures, which are sprites that others meet and that nothing changes.

use base::Seed;
use engine::inspect::is_fixture;
use engine::{Action, Game, State};

const START: &str = "BasicGame square_size=10\n  SpriteSet\n    wall > Immovable\n    brick > Immovable\n    gem > \
                     Immovable\n    ball > Missile\n    hero > MovingAvatar\n  LevelMapping\n    w > wall\n    b > \
                     brick\n    g > gem\n    o > ball\n    A > hero\n  TerminationSet\n    Timeout limit=99\n  \
                     InteractionSet\n";

fn game(rules: &str) -> Game {
    Game::from_source(&format!("{START}    {rules}\n")).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn fixtures_are_met_and_never_touched() {
    let cases = [
        ("hero brick > stepBack", true),
        ("hero brick > killSprite scoreChange=1", true),
        ("ball brick > transformTo stype=gem", true),
        ("hero brick > undoAll", true),
        ("ball brick > wallBounce", true),
        ("brick hero > undoAll", false),
        ("brick hero > killSprite", false),
        ("brick EOS > stepBack", false),
        ("brick TIME > killSprite timer=3", false),
        ("hero brick > killBoth", false),
        ("hero brick > transformTo stype=gem killSecond=True", false),
        ("gem hero > transformTo stype=brick", false),
        ("gem hero > killAll stype=brick", false),
        ("gem hero > spawn stype=brick", false),
    ];
    for (rule, expected) in cases {
        let game = game(rule);
        assert_eq!(is_fixture(&game, game.sprite_type("brick").unwrap()), expected, "{rule}");
        assert!(!is_fixture(&game, game.sprite_type("hero").unwrap()));
    }
}

fn start(game: &Game, level: &str) -> State {
    game.start(&game.level(level).unwrap(), Seed::from_text("fixtures"))
}

#[test]
fn copies_share_fixtures() {
    let game = game("hero brick wall > stepBack");
    let size = |level: &str| start(&game, level).size_in_bytes();
    assert_eq!(size("Abbbb\nwwwww\n"), size("A    \n     \n"));
    let mut state = start(&game, "A b\n");
    let (copy, brick) = (state.clone(), game.sprite_type("brick").unwrap());
    for _ in 0..3 {
        game.step(&mut state, Action::Right);
    }
    assert_eq!((state.avatar_place(), state.places(brick).next()), (Some((10, 0)), Some((20, 0))));
    assert_eq!((copy.avatar_place(), copy.alive(brick)), (Some((0, 0)), 1));
    assert_eq!(state.state_hash(), state.state_hash_from_scratch());
    state.recount(&game).unwrap();
}

#[test]
fn fixtures_follow_all_others_in_a_cell() {
    let game = Game::from_source(&format!("{START}    hero brick > killSprite scoreChange=1\n").replace(
        "A > hero",
        "A > hero\n    x > hero brick\n    y > brick hero\n    z > brick gem brick hero",
    ))
    .unwrap();
    for level in ["x \n", "y \n", "z \n"] {
        let mut state = start(&game, level);
        state.recount(&game).unwrap();
        game.step(&mut state, Action::Nil);
        assert!(state.score() >= 1.0, "{level}");
        state.recount(&game).unwrap();
    }
}
