//! Tests of the measures and the similarity of levels. Small levels show one measure each, and the levels of games are
//! also used.

use crate::corpora::{self, game_in, levels_in};
use engine::{Analysis, Game, Level};
use generators::levels::{LevelMeasure, LevelMeasures, LevelSimilarity};
use std::path::PathBuf;

/// Returns a game with gems to take, chasing rats, still thorns, and walls with two characters.
pub(super) fn cellar() -> Game {
    Game::from_source(
        "
BasicGame
    SpriteSet
        wall > Immovable
        gem > Immovable
        thorn > Immovable
        rat > Chaser stype=avatar
        avatar > MovingAvatar
    LevelMapping
        w > wall
        v > wall
        g > gem
        t > thorn
        r > rat
        A > avatar
    InteractionSet
        avatar wall > stepBack
        rat wall > stepBack
        gem avatar > killSprite scoreChange=1
        avatar rat > killSprite
        avatar thorn > killSprite
    TerminationSet
        SpriteCounter stype=gem win=True
        SpriteCounter stype=avatar win=False
",
    )
    .expect("a game")
}

/// Makes a level from its rows, separated by `/`, with dots for empty cells.
pub(super) fn level(game: &Game, rows: &str) -> Level {
    game.level(&rows.replace('/', "\n").replace('.', " ")).expect("a level")
}

#[track_caller]
fn check(rows: &str, expect: &[(LevelMeasure, f64)]) {
    let game = cellar();
    let measures = LevelMeasures::new(&Analysis::of(&game)).expect("an avatar can be placed");
    let all = measures.of(&level(&game, rows));
    assert!(all.iter().all(|measure| (0.0..=1.0).contains(measure) && measure.is_sign_positive()), "{all:?}");
    for (measure, value) in expect {
        let found = all[*measure as usize];
        assert!((found - value).abs() < 1e-12, "{}: {found}, not {value}", measure.name());
    }
}

#[test]
fn a_corridor_is_linear_and_narrow() {
    use LevelMeasure::*;
    check(
        "wwwwww/wA..gw/wwwwww",
        &[
            (Cover, 16.0 / 18.0),
            (Walls, 14.0 / 18.0),
            (Openness, 6.0 / 16.0),
            (Linearity, 1.0),
            (Goals, 1.0 / 5.0),
            (Pressure, 0.0),
            (Sprinkle, 0.0),
            (UpDown, 1.0),
            (LeftRight, 0.0),
        ],
    );
}

#[test]
fn a_hall_is_open() {
    use LevelMeasure::*;
    check(
        "A../.../..g",
        &[(Openness, 24.0 / 36.0), (Linearity, 4.0 / 8.0), (Cover, 2.0 / 9.0), (Walls, 0.0)],
    );
}

#[test]
fn unreachable_cells_have_no_shape() {
    use LevelMeasure::*;
    check("A.wg./..w..", &[(Openness, 8.0 / 16.0), (Linearity, 2.0 / 3.0)]);
    check("A.tg./..t..", &[(Openness, 8.0 / 16.0), (Linearity, 2.0 / 3.0)]);
}

#[test]
fn pressure_grows_with_near_harm() {
    use LevelMeasure::Pressure;
    let near = |steps: f64| 4.0 / (4.0 + steps);
    let one = (near(1.0) + near(4.0)) / 2.0;
    check("Ar...g", &[(Pressure, one / (one + 4.0))]);
    check("At...g", &[(Pressure, one / (one + 8.0))]);
    let two = one + (near(2.0) + near(3.0)) / 2.0;
    check("Arr..g", &[(Pressure, two / (two + 4.0))]);
    check("A..r.", &[(Pressure, near(3.0) / (near(3.0) + 4.0))]);
}

#[test]
fn isolated_walls_are_scattered() {
    use LevelMeasure::Sprinkle;
    check("A...../.w..w./....w./.....g", &[(Sprinkle, 1.0 / 3.0)]);
    check("wwwwww/wA...w/w.w.ww/wwwwww", &[(Sprinkle, 0.0)]);
}

#[test]
fn the_order_of_measures_is_their_number() {
    for (at, measure) in LevelMeasure::ALL.into_iter().enumerate() {
        assert_eq!(measure as usize, at);
    }
}

/// Returns a level rotated by 90 degrees.
fn turned(game: &Game, level: &Level) -> Option<Level> {
    let row = |x: usize| {
        (0..level.rows()).map(move |y| level.cells()[(level.rows() - 1 - y) * level.columns() + x])
    };
    let rows: Vec<String> = (0..level.columns()).map(|x| row(x).map(char::from).collect()).collect();
    game.level(&rows.join("\n")).ok()
}

fn check_all(folders: Vec<PathBuf>) {
    for folder in folders {
        let Some(game) = game_in(&folder) else { continue };
        let levels = levels_in(&folder, &game);
        let analysis = Analysis::of(&game);
        let likeness = LevelSimilarity::of(&analysis);
        let name = folder.display();
        for level in &levels {
            if let Some(measures) = LevelMeasures::new(&analysis) {
                let measures = measures.of(level);
                assert!(measures.iter().all(|measure| (0.0..=1.0).contains(measure)), "{name}: {measures:?}");
            }
            if let Some(turned) = turned(&game, level) {
                assert_eq!(likeness.digest(level), likeness.digest(&turned), "{name}");
                assert_eq!(likeness.distance(level, &turned), 0.0, "{name}");
            }
        }
        for (at, one) in levels.iter().enumerate() {
            for two in &levels[..at] {
                let distance = likeness.distance(one, two);
                assert!((0.0..=1.0).contains(&distance), "{name}: {distance}");
                assert_eq!(distance, likeness.distance(two, one), "{name}");
                if likeness.digest(one) == likeness.digest(two) {
                    assert_eq!(distance, 0.0, "{name}");
                }
            }
        }
    }
}

#[test]
fn levels_of_our_own_games() {
    check_all(corpora::own());
}

#[test]
fn levels_of_public_games() {
    check_all(corpora::public());
}
