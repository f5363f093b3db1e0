//! Tests which differences between two states change the search key, and which differences do not.
//! `tests/tests/it/robustness.rs` checks that equal keys have equal futures in any game.

use base::Seed;
use engine::{Action, Game, Level, State};

/// Plays two sequences of keys on the same board, and returns the game and the two states.
#[track_caller]
fn after(source: &str, level: &str, one: &str, two: &str) -> (Game, State, State) {
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
    let level: Level = game.level(level).unwrap_or_else(|problems| panic!("{problems}"));
    let play = |keys: &str| {
        let mut state = game.start(&level, Seed::from_text("key"));
        for key in keys.chars() {
            let action = match key {
                'U' => Action::Up,
                'L' => Action::Left,
                'D' => Action::Down,
                'R' => Action::Right,
                'X' => Action::Use,
                _ => Action::Nil,
            };
            game.step(&mut state, action);
        }
        state
    };
    let (one, two) = (play(one), play(two));
    (game, one, two)
}

#[track_caller]
fn differ(source: &str, level: &str, one: &str, two: &str) {
    let (game, one, two) = after(source, level, one, two);
    assert_ne!(one.search_key(&game), two.search_key(&game));
}

#[track_caller]
fn agree(source: &str, level: &str, one: &str, two: &str) {
    let (game, one, two) = after(source, level, one, two);
    assert_ne!(one.state_hash(), two.state_hash(), "the states are different ones");
    assert_eq!(one.search_key(&game), two.search_key(&game));
}

fn game(sprites: &str, rules: &str) -> String {
    format!(
        "BasicGame square_size=10\n  SpriteSet\n    wall > Immovable solid=True\n{sprites}\n  LevelMapping\n    w > wall\n    a > a\n    A > me\n  InteractionSet\n    me wall > stepBack\n{rules}\n  TerminationSet\n    SpriteCounter stype=me win=False\n"
    )
}

#[test]
fn waiting_changes_nothing_that_matters() {
    let still = game("    a > Immovable\n    me > MovingAvatar", "    a me > killSprite");
    agree(&still, "A a\n", "N", "NNNN");
    agree(&still, "A a\n", "RL", "NNNN");
    differ(&still, "A a\n", "R", "N");
}

#[test]
fn a_cooldown_that_is_not_over() {
    let slow = game("    a > Immovable\n    me > MovingAvatar cooldown=3", "    a me > killSprite");
    differ(&slow, "A   a\n", "NNR", "NRN");
    agree(&slow, "A   a\n", "NRNNNN", "NRNNN");
}

/// A spawner that is made later fires at ticks that are multiples of its cooldown.
#[test]
fn spawners_still_to_be_made() {
    let later = game(
        "    a > SpawnPoint stype=wall cooldown=5\n    me > FlakAvatar stype=a",
        "    a wall > stepBack",
    );
    differ(&later, "A \n", "N", "NN");
    agree(&later, "A \n", "N", "NNNNNN");
}
