//! Tests the first steps of paths (`spec/01` §8).

use engine::inspect::first_step;
use engine::{Chance, Direction, Game};

/// Checks the golden example of `spec/01` §8: the first step from (2, 4) to every cell.
#[test]
fn the_vector_of_the_specification() {
    let source = "BasicGame obs=rock square_size=10\n  SpriteSet\n    rock > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    r > rock\n  InteractionSet\n    avatar rock > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n";
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"));
    let level = game.level("A     \n      \n  r   \n      \n      \n").unwrap();
    let state = game.start_with(&level, Chance::from_java(1));
    let first = |column: i32, row: i32| match first_step(&state, (20, 40), (10 * column, 10 * row)) {
        Some(Direction::UP) => 'U',
        Some(Direction::LEFT) => 'L',
        Some(Direction::RIGHT) => 'R',
        Some(_) => 'D',
        None => '.',
    };
    let rows = (0..5).map(|row| (0..6).map(|column| first(column, row)).collect::<String>());
    assert_eq!(rows.collect::<Vec<String>>(), ["UUUUUU", "UUUUUU", "UU.UUU", "LUUURR", "LL.RRR"]);
}

/// K-41: with the reciprocal, a cell of 49 pixels starts at 50.
#[test]
fn cells_by_the_reciprocal() {
    let source = "BasicGame obs=rock square_size=49\n  SpriteSet\n    rock > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    r > rock\n  InteractionSet\n    avatar rock > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n";
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"));
    let state = game.start_with(&game.level("A r\n").unwrap(), Chance::from_java(1));
    assert_eq!(first_step(&state, (0, 0), (49, 0)), None, "the same cell");
    assert_eq!(first_step(&state, (0, 0), (50, 0)), Some(Direction::RIGHT));
}

#[test]
fn positions_off_the_board_have_no_path() {
    let source = "BasicGame obs=wall square_size=1\n  SpriteSet\n    avatar > MovingAvatar\n  LevelMapping\n  InteractionSet\n    avatar wall > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n";
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"));
    let state = game.start_with(&game.level("A  \n").unwrap(), Chance::from_java(1));
    for far in [(i32::MAX, i32::MAX), (i32::MIN, 0), (0, i32::MAX)] {
        assert_eq!((first_step(&state, far, (1, 0)), first_step(&state, (0, 0), far)), (None, None));
    }
}
