//! Tests levels and their problems.

use engine::{Game, LevelMapping, MAX_LEVEL_TEXT};

const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gold > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    w > wall\n    g > gold\n    A > avatar\n  InteractionSet\n    avatar wall > stepBack\n    gold avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=gold win=True\n    Timeout limit=9 win=False\n";

fn check(text: &str, expect: Result<(usize, usize), &[&str]>) {
    let game = Game::from_source(GAME).unwrap();
    let got = game.level(text);
    let codes: Vec<&str> =
        got.as_ref().err().map_or(Vec::new(), |all| all.0.iter().map(|d| d.code).collect());
    match expect {
        Ok(size) => assert_eq!(got.map(|level| (level.columns(), level.rows())), Ok(size)),
        Err(expected) => assert_eq!(codes, expected, "{text:?}"),
    }
}

#[test]
fn levels_and_their_problems() {
    check("wAg\r\nwww\r\n", Ok((3, 2)));
    check("wAg\nw\n", Ok((3, 2)));
    check("wAg\n\n", Ok((3, 2)));
    check("w@g\n", Err(&["no-avatar", "undefined-character"]));
    check("wAG\n", Err(&["undefined-character"]));
    check("wgw\n", Err(&["no-avatar"]));
    check("\u{feff}\n", Err(&["empty-level"]));
    check("AgA\n", Err(&["extra-avatars"]));
    check("\u{feff}wAg\n", Ok((3, 1)));
    check("", Err(&["empty-level"]));
    check(&"w".repeat(600), Err(&["too-large"]));
    check(&"x".repeat(MAX_LEVEL_TEXT + 1), Err(&["too-large"]));
    check("Aé\u{0}\n", Err(&["undefined-character", "undefined-character"]));
    check("Axxx\nxxxx\n", Err(&["undefined-character"]));
}

#[test]
fn levels_of_a_faulty_game_are_checked_against_its_mapping() {
    let check = |replace: &str, with: &str, level: &str, expect: &[&str]| {
        let source = GAME.replace(replace, with);
        assert!(Game::from_source(&source).is_err(), "{source}");
        let mapping = LevelMapping::of_source(&source);
        let reported = mapping.map(|mapping| mapping.problems(level)).unwrap_or_default();
        assert_eq!(reported.iter().map(|problem| problem.code).collect::<Vec<_>>(), expect, "{source}");
    };
    let both = ["no-avatar", "undefined-character"];
    check("stepBack", "stepBakc", "wXg\n", &both);
    check("MovingAvatar", "MovnigAvatar", "wXg\n", &both);
    check("stepBack", "stepBakc", "wAg\n", &[]);
    check("stepBack", "stepBakc", "AgA\nw\n", &["extra-avatars", "ragged-level"]);
    // It is unknown which sprite the line should place, and whether that sprite is an avatar.
    check("A > avatar", "A avatar", "wXg\n", &[]);
    check("A > avatar", "A > avatr", "wXg\n", &["undefined-character"]);
    check("MovingAvatar", "Quux", "wXg\n", &["undefined-character"]);
    check("  LevelMapping\n    w > wall\n    g > gold\n    A > avatar\n", "", "wXg\n", &[]);
}

#[test]
fn places_split_no_character() {
    let game = Game::from_source(GAME).unwrap();
    for text in ["é\n", "\u{feff}é\n", "w\u{fffd}\n蟻蟻\n"] {
        for problem in game.level(text).unwrap_err().0 {
            assert!(text.get(problem.span.start..problem.span.end).is_some(), "{problem:?} in {text:?}");
        }
    }
}

#[test]
fn rows_of_another_length() {
    let game = Game::from_source(GAME).unwrap();
    let places = |text: &str| -> Vec<(usize, usize)> {
        let level = game.level(text).unwrap();
        let ragged = level.warnings().iter().filter(|warning| warning.code == "ragged-level");
        ragged.map(|warning| (warning.span.start, warning.span.end)).collect()
    };
    assert_eq!(places("wAg\nwwww\nw\n"), [(7, 8), (9, 10)]);
    // Only the first row differs.
    assert_eq!(places("wAg\nwwww\nwwww\n"), [(0, 3)]);
}

#[test]
fn the_canonical_text_is_rectangular() {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level("wAg\nw").unwrap();
    assert_eq!(level.to_string(), "wAg\nw  \n");
    assert_eq!(level.warnings()[0].code, "ragged-level");
    assert_eq!(game.level("wAg\nw  \n").unwrap().digest(), level.digest());
}

/// The engine looks for the avatar among sprites of leaf types and of the type `avatar`.
#[test]
fn levels_need_an_avatar_that_is_found() {
    let check = |sprites: &str, symbol: &str, level: &str, expected: &str| {
        let source = GAME.replace("avatar > MovingAvatar", sprites).replace("A > avatar", symbol);
        let source = source.replace("avatar wall", "hero wall").replace("gold avatar", "gold hero");
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}"));
        let problems = game.level(level).err().map_or(Vec::new(), |problems| problems.0);
        let told = problems.iter().map(|problem| {
            format!("{}: {}; {}", problem.code, problem.message, problem.help.as_deref().unwrap_or_default())
        });
        assert_eq!(told.collect::<Vec<_>>().join("\n"), expected);
        let game = Game::from_source_as_reference(&source).unwrap();
        assert!(game.level(level).is_ok());
    };
    let parent = "hero > MovingAvatar\n      young >\n      old >";
    let lost = "no-avatar: the level places no avatar that a player can control:";
    let below = format!("{lost} `hero` is a parent type; place one of its subtypes: young, old");
    check(parent, "H > hero", "wHg\n", &below);
    check(parent, "H > young", "wHg\n", "");
    check(&parent.replace("hero", "avatar").replace("young", "hero"), "p > hero", "wAg\n", "");
    check("hero > MovingAvatar", "H > hero", "wHg\n", "");
}
