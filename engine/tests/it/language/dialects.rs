//! Tests games in other dialects, and words that people and language models write although they do not exist
//! in VGDL.

use engine::dialect::{Conversion, convert};
use engine::{Diagnostic, Game, LevelMapping};
use std::fs;
use std::path::Path;

const PY_VGDL: &str = "BasicGame frame_rate=30 block_size=20\n\tInteractionSet\n\t\tgem avatar > killSprite\n\t\tgem avatar > changeScore value=2\n\t\twall avatar > nothing\n\t\tavatar wall > stepBack\n\t\tball wall > bounceDirection friction=0\n\tLevelMapping\n\t\tG > gem\n\t\tb > ball\n\tTerminationSet\n\t\tSpriteCounter stype=gem limit=0 win=True bonus=0\n\t\tSpriteCounter stype=avatar limit=0 win=False bonus=10\n\tSpriteSet\n\t\tgem > Immovable color=PURPLE\n\t\tavatar > RotatingAvatar alternate_keys=True\n\t\tball > Missile physicstype=GridPhysics\n\t\twall > Immovable\n";

fn problems(source: &str) -> Vec<Diagnostic> {
    Game::from_source(source).err().map_or(Vec::new(), |problems| problems.0)
}

/// Returns the help of the problem about a word of a small game.
#[track_caller]
fn help(word: &str, replaced: &str) -> String {
    let game = "BasicGame\n    SpriteSet\n        crate > Passive speed=0\n        hero > MovingAvatar\n    LevelMapping\n        c > crate\n        H > hero\n    InteractionSet\n        crate hero > bounceForward scoreChange=1\n    TerminationSet\n        Timeout limit=30 win=True\n";
    assert!(game.contains(replaced), "{replaced}");
    let source = game.replacen(replaced, word, 1);
    let found = problems(&source);
    let told = found.iter().find(|problem| problem.message.contains(&format!("`{word}`")));
    let told = told.unwrap_or_else(|| panic!("`{word}`: {found:?}"));
    told.help.clone().unwrap_or_default()
}

#[test]
fn invented_words_are_told_by_their_meaning() {
    for (word, replaced, meant) in [
        ("Movable", "Passive", "`Passive`"),
        ("Collectible", "Passive", "`Resource`"),
        ("Enemy", "Passive", "`Chaser`"),
        ("Wall", "Passive", "`Immovable`"),
        ("PlayerAvatar", "MovingAvatar", "`MovingAvatar`"),
        ("MarioAvatar", "MovingAvatar", "`PlatformerAvatar`"),
        ("InertialAvatar", "MovingAvatar", "`SpaceshipAvatar`"),
        ("SwimmingAvatar", "MovingAvatar", "`MovingAvatar`"),
        ("kill", "bounceForward", "`killSprite`"),
        ("push", "bounceForward", "`bounceForward`"),
        ("block", "bounceForward", "`stepBack`"),
        ("addScore", "bounceForward", "`scoreChange=1`"),
        ("nothing", "bounceForward", "remove this line"),
        ("teleport", "bounceForward", "`teleportToExit`"),
        ("win", "bounceForward", "`SpriteCounter stype=goal limit=0 win=True`"),
        ("points", "scoreChange", "`scoreChange`"),
        ("velocity", "speed", "`speed`"),
        ("speeed", "speed", "`speed`"),
        ("colour", "speed", "`color`"),
        ("Timer", "Timeout", "`Timeout`"),
        ("Win", "Timeout", "`SpriteCounter stype=goal limit=0 win=True`"),
        ("time", "limit", "`limit`"),
        ("Interactions", "InteractionSet", "`InteractionSet`"),
        ("SimpleGame", "BasicGame", "`BasicGame`"),
    ] {
        let help = help(word, replaced);
        assert!(help.contains(meant), "{word}: {help}");
        for wrong in ["`LanderAvatar`", "`CarAvatar`", "`VerticalAvatar`"] {
            assert!(!help.contains(wrong), "{word}: {help}");
        }
    }
    assert!(!help("Movable", "Passive").contains("Immovable"));
}

#[test]
fn dialects_are_named_once_by_their_words() {
    let told = |source: &str| -> Vec<String> {
        let found = problems(source).into_iter().filter(|problem| problem.code == "other-dialect");
        found.map(|problem| format!("{}: {}", problem.message, problem.help.unwrap_or_default())).collect()
    };
    let py_vgdl = PY_VGDL.replace("bonus=10", "");
    let py_vgdl = py_vgdl.replace("gem avatar > changeScore value=2", "ball avatar > killSprite");
    let [message] = &told(&py_vgdl)[..] else { panic!("{:?}", told(&py_vgdl)) };
    assert!(message.contains("EMPA") || message.contains("py-vgdl"), "{message}");
    let [message] = &told(PY_VGDL)[..] else { panic!() };
    assert!(message.contains("EMPA") && message.contains("`changeScore`"), "{message}");
    let plain = py_vgdl.replace("wall avatar > nothing", "").replace(" bonus=0", "");
    let [message] = &told(&plain)[..] else { panic!() };
    assert!(message.contains("py-vgdl") && message.contains("`block_size`"), "{message}");
    let python = format!("import vgdl\n\ngame = \"\"\"\n{PY_VGDL}\"\"\"\n");
    let found = problems(&python);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].message.contains("line 3"), "{}", found[0].message);
}

#[test]
fn faulty_games_of_this_dialect_are_not_taken_for_others() {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpora");
    let mut games = 0;
    for folder in fs::read_dir(corpora).unwrap().flatten() {
        let Ok(source) = fs::read_to_string(folder.path().join("game.vgdl")) else { continue };
        games += 1;
        for (word, wrong) in [
            ("killSprite", "kill"),
            ("scoreChange", "changeScore"),
            ("Immovable", "Movable"),
            ("TerminationSet", "Terminations"),
        ] {
            let found = problems(&source.replace(word, wrong));
            assert!(
                found.iter().all(|problem| problem.code != "other-dialect"),
                "{folder:?} {wrong}: {found:?}"
            );
        }
    }
    assert!(games > 20);
}

#[test]
fn games_of_several_players_are_refused_in_one_sentence() {
    let source = "BasicGame no_players=2 key_handler=Pulse\n    SpriteSet\n        gem > Immovable\n        avatar >\n            one > ShootAvatar stype=shot1,shot2\n            two > MovingAvatar\n    LevelMapping\n        g > gem\n        1 > one\n        2 > two\n    InteractionSet\n        gem one > killSprite scoreChange=1,1\n        gem two > destroy scoreChange=-1,1\n    TerminationSet\n        SpriteCounter stype=gem win=True,False\n        Blah\n";
    let found = problems(source);
    assert_eq!(found.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["unsupported"], "{found:?}");
    assert!(found[0].message.contains("several players are not supported"), "{}", found[0].message);
    assert!(LevelMapping::of_source(source).is_none(), "its levels have several avatars");
    let reference = Game::from_source_as_reference(source).unwrap_err();
    assert_eq!(reference.0.len(), 1, "{reference:?}");
}

#[test]
fn what_has_an_exact_equivalent_is_converted_and_the_rest_is_listed() {
    let Conversion { text, source, changes, problems, .. } = convert(PY_VGDL);
    for line in [
        "BasicGame square_size=20\n    SpriteSet\n",
        "        gem avatar > killSprite scoreChange=2\n",
        "        ball wall > bounceDirection\n",
        "        SpriteCounter stype=gem limit=0 win=True\n",
        "        ball > Missile physicstype=GRID\n",
        "        gem > Immovable\n",
    ] {
        assert!(text.contains(line), "no `{line}` in\n{text}");
    }
    assert!(!text.contains("nothing") && !text.contains("alternate_keys"), "{text}");
    let left: Vec<(usize, &str)> = problems
        .iter()
        .map(|problem| (engine::line_and_column(&source, problem.span.start).0, problem.code))
        .collect();
    assert_eq!(left, [(13, "unknown-parameter"), (16, "unknown-class")], "{problems:?}");
    assert!(
        changes.iter().any(|change| change.line == 4 && change.to.contains("scoreChange=2")),
        "{changes:?}"
    );
    // Converted text is left unchanged.
    let repaired = text.replace(" bonus=10", "").replace("RotatingAvatar", "MovingAvatar");
    let again = convert(&repaired);
    assert_eq!((again.text.as_str(), again.changes.len(), again.problems.len()), (repaired.as_str(), 0, 0));
    assert!(Game::from_source(&again.text).is_ok());
}

#[test]
fn points_without_a_rule_to_carry_them_are_listed() {
    let source = PY_VGDL.replace("gem avatar > killSprite", "ball avatar > killSprite");
    let converted = convert(&source);
    assert!(
        converted.problems.iter().any(|problem| problem.message.contains("`changeScore`")),
        "{:?}",
        converted.problems
    );
}

#[test]
fn any_text_is_converted() {
    for source in [
        "",
        "\"\"\"",
        "\t\t",
        "x = '''\nSpriteSet\nLevelMapping\n'''",
        "\u{feff}BasicGame\r\n",
        "BasicGame\u{0}",
    ] {
        let converted = convert(source);
        let again = convert(&converted.text);
        assert!(again.changes.is_empty(), "{source:?}: {:?}", again.changes);
    }
}

#[test]
fn unmapped_letters_are_told_by_what_nothing_places() {
    let source = "BasicGame\n    SpriteSet\n        parcel > Immovable\n        wall > Immovable\n        hero > MovingAvatar\n    LevelMapping\n        H > hero\n    InteractionSet\n        parcel hero > killSprite\n    TerminationSet\n        SpriteCounter stype=parcel win=True\n";
    let game = Game::from_source(source).unwrap();
    let help = |level: &str| {
        let found = game.level(level).unwrap_err().0;
        found
            .into_iter()
            .find(|problem| problem.code == "undefined-character")
            .and_then(|problem| problem.help)
            .unwrap()
    };
    assert!(help("wwwww\nwHp.w\nwwwww\n").contains("`p > parcel`"));
    assert!(!help("wwwww\nwHX w\nwwwww\n").contains("`w`"));
    assert!(help("wwwww\nwH w\n\twwww\n").contains("tab"));
}
