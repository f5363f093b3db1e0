//! Tests faulty files that are loaded in reference mode (`spec/01` §1, §10): dropped, ignored and counted
//! faults.

use base::Seed;
use engine::{Action, Game, Level, Outcome, State};

const GAME: &str = "\
BasicGame
    SpriteSet
        wall > Immovable
        gold > Immovable
        avatar > MovingAvatar
    LevelMapping
        g > gold
    InteractionSet
        avatar wall > stepBack
        gold avatar > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=gold win=True
        Timeout limit=5 win=False
";

fn load(source: &str, level: &str) -> (Game, Level, State) {
    let game = Game::from_source_as_reference(source).unwrap_or_else(|problems| panic!("{problems}"));
    let level = game.level(level).unwrap_or_else(|problems| panic!("{problems}"));
    let state = game.start(&level, Seed::from_text("any"));
    (game, level, state)
}

/// Loads a game that strict loading rejects, moves right onto the gold, and returns the score, the outcome and the
/// number of messages.
#[track_caller]
fn play(source: &str) -> (f64, Outcome, u32) {
    assert!(Game::from_source(source).is_err(), "strict loading must refuse this");
    let (game, _, mut state) = load(source, "Ag \n");
    let messages = state.messages();
    game.step(&mut state, Action::Right);
    (state.score(), state.outcome(), messages)
}

#[test]
fn a_game_without_faults_is_the_same_game() {
    let (game, _, mut state) = load(GAME, "Ag \n");
    assert_eq!(game.digest(), Game::from_source(GAME).unwrap().digest());
    assert_eq!(game.step(&mut state, Action::Right), Outcome::Won);
}

#[test]
fn an_unknown_effect_ends_the_reading() {
    // The fault is before the gold's rule, so there is no score and no termination.
    let early = GAME.replace("avatar wall > stepBack", "avatar wall > stepBackwards");
    assert_eq!(play(&early), (0.0, Outcome::Ongoing, 1));
    // The fault is after the gold's rule, so the rule counts, but the terminations are missing.
    let late = GAME.replace("scoreChange=1\n", "scoreChange=1\n        avatar gold > vanish\n");
    assert_eq!(play(&late), (1.0, Outcome::Ongoing, 1));
}

#[test]
fn an_unknown_sprite_ends_the_reading_after_its_left_neighbours() {
    let partner = GAME.replace("gold avatar > kill", "gold avatar ghost > kill");
    assert_eq!(play(&partner), (1.0, Outcome::Ongoing, 1));
    let counted = GAME.replace("SpriteCounter stype=gold", "SpriteCounter stype=silver");
    assert_eq!(play(&counted), (1.0, Outcome::Ongoing, 1));
}

#[test]
fn an_unknown_parameter_is_a_message_and_a_wrong_type_is_none() {
    assert_eq!(play(&GAME.replace("scoreChange=1", "scoreChange=1 bonus=3")), (1.0, Outcome::Won, 1));
    assert_eq!(play(&GAME.replace("gold > Immovable", "gold > Immovable shine=3")), (1.0, Outcome::Won, 1));
    assert_eq!(
        play(&GAME.replace("gold > Immovable", "gold > Immovable cooldown=2.0")),
        (1.0, Outcome::Won, 0)
    );
}

#[test]
fn of_two_declarations_the_last_one_counts() {
    let twice =
        GAME.replace("gold > Immovable\n", "gold > Immovable\n        gold > Missile orientation=RIGHT\n");
    let (game, _, mut state) = load(&twice, "Ag  \n");
    game.step(&mut state, Action::Nil);
    game.step(&mut state, Action::Nil);
    let gold = game.sprite_type("gold").unwrap();
    let place = game.records(&state).into_iter().find(|record| record.stype == gold.0).unwrap().rect.x;
    assert_eq!(place / state.block(), 2);
}

#[test]
fn a_line_indented_deeper_is_ignored() {
    assert_eq!(
        play(&GAME.replace("        gold avatar", "          gold avatar")),
        (0.0, Outcome::Ongoing, 0)
    );
}

#[test]
fn undefined_characters_are_messages_and_too_many_end_the_game() {
    let (game, _, mut state) = load(GAME, "A??g\n");
    assert_eq!(state.messages(), 2);
    assert_eq!(game.step(&mut state, Action::Nil), Outcome::Ongoing);
    let (game, _, mut state) = load(GAME, &format!("A{}g\n", "?".repeat(26)));
    assert_eq!(game.step(&mut state, Action::Nil), Outcome::Ended);
}

#[test]
fn surplus_avatars_are_removed_with_a_message() {
    let (game, _, mut state) = load(GAME, "A gA\n");
    assert_eq!((state.messages(), state.avatar_id()), (1, Some(0)));
    assert_eq!(game.records(&state).len(), 2);
    game.step(&mut state, Action::Right);
    assert_eq!(state.state_hash(), state.state_hash_from_scratch());
}

#[test]
fn crashes_of_the_reference_stop_the_episode() {
    let classless = GAME.replace("gold > Immovable", "gold >");
    let (_, _, state) = load(&classless, "Ag \n");
    assert!(matches!(state.outcome(), Outcome::Stopped(_)));
    assert!(Game::from_source_as_reference("Game\n").is_err());
    assert!(Game::from_source_as_reference("").is_err());
}

/// `start` is internal to spawners (`spec/02` §8). Neither strict mode nor reference mode lets a game set it.
#[test]
fn the_start_of_a_spawner_is_no_parameter() {
    let plain = GAME.replace(
        "    LevelMapping",
        "        hive > SpawnPoint stype=gold cooldown=3\n    LevelMapping\n        h > hive",
    );
    for class in ["SpawnPoint stype=gold", "Bomber stype=gold", "SpawnPointMultiSprite stypes=gold"] {
        let plain = plain.replace("SpawnPoint stype=gold", class);
        let started = plain.replace("cooldown=3", "cooldown=3 start=1");
        let problems = Game::from_source(&started).map(drop).unwrap_err().0;
        assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["unknown-parameter"]);
        let (game, _, mut state) = load(&started, "Ah \n");
        let (same, _, mut expected) = load(&plain, "Ah \n");
        assert_eq!((state.messages(), expected.messages()), (1, 0));
        for _ in 0..4 {
            assert_eq!(game.step(&mut state, Action::Nil), same.step(&mut expected, Action::Nil));
            assert_eq!(game.records(&state), same.records(&expected));
        }
    }
}

/// Returns a game whose avatar is `hero` in levels.
fn named_by(hero: &str) -> String {
    GAME.replace("    LevelMapping\n", &format!("    LevelMapping\n        {hero} > avatar\n"))
}

/// The reference looks up UTF-16 code units: all units of a level's rows, and the first unit in a line of the
/// LevelMapping.
#[test]
fn characters_beyond_ascii_are_code_units() {
    for hero in ["ö", "中", "\u{a0}", "ﬀ"] {
        let source = named_by(hero);
        assert!(Game::from_source(&source).is_err());
        let text = format!("{hero}  g\n");
        let (game, level, mut state) = load(&source, &text);
        assert_eq!((level.columns(), state.messages()), (4, 0), "{hero}");
        assert_eq!(level.to_string(), text);
        assert!(level.cells().is_ascii());
        let symbol = level.cells()[0];
        assert_eq!((game.character(symbol).to_string().as_str(), game.character(b'g')), (hero, 'g'));
        for _ in 0..3 {
            game.step(&mut state, Action::Right);
        }
        assert_eq!(state.outcome(), Outcome::Won, "{hero}");
        let guide = engine::describe::Guide::of(&game);
        assert!(guide.legend.contains(&format!("{hero}  avatar")), "{:?}", guide.legend);
        // The code that stands for the character is not an alternative spelling of it.
        let (_, _, state) = load(&source, &format!("{}  g\n", char::from(symbol)));
        assert_eq!((state.avatar_id(), state.messages()), (None, 3));
    }
    // A character that is not mapped causes a message, even if it is in Latin-1.
    let (_, level, state) = load(&named_by("ö"), "öé g\n");
    assert_eq!((level.columns(), state.messages()), (4, 1));
}

/// A character beyond the first plane is two code units, and the LevelMapping maps the first unit.
#[test]
fn characters_of_two_code_units_are_two_cells() {
    let (game, level, state) = load(&named_by("😀"), "😀g\n");
    assert_eq!((level.columns(), state.messages(), state.avatar_id()), (3, 1, Some(0)));
    assert!(game.places(level.cells()[1]).is_empty());
    // The reference cannot distinguish characters with the same first unit.
    assert_eq!(load(&named_by("😀"), "😁g\n").2.avatar_id(), Some(0));
    // The width of a level is the number of units in its first row.
    let (_, level, _) = load(&named_by("😀"), "ab\n😀g\n");
    assert_eq!((level.columns(), level.rows()), (2, 2));
    assert_eq!(level.digest(), load(&named_by("😀"), "ab\n😀\n").1.digest());
}

/// A line that maps nothing still uses up its character, and the last of two lines counts.
#[test]
fn lines_of_characters_beyond_ascii_follow_the_rules_of_others() {
    let nothing = "é b\n        ö > gold\n        ö";
    let (game, level, state) = load(&named_by(nothing), "öé g\n");
    assert_eq!((state.messages(), game.places(level.cells()[0]).len()), (0, 1));
    assert_eq!(state.avatar_id(), Some(0));
    // An undeclared sprite is fatal to the levels that use it.
    let unknown = named_by("ö > ghost\n        é");
    let game = Game::from_source_as_reference(&unknown).unwrap();
    assert!(game.level("é g\n").is_ok());
    assert_eq!(game.level("éög\n").unwrap_err().0[0].code, "unknown-sprite");
    // More characters than there are free codes are rejected.
    let many: String =
        (0..140u32).map(|at| format!("        {} > gold\n", char::from_u32(0x400 + at).unwrap())).collect();
    let crowded = GAME.replace("        g > gold\n", &many);
    assert_eq!(Game::from_source_as_reference(&crowded).unwrap_err().0[0].code, "too-large");
}

/// The reference chooses among the images of a tiled sprite after it has built a level.
#[test]
fn tiling_without_an_image_is_fatal() {
    for (params, is_fatal) in [
        ("autotiling=True", true),
        ("autotiling=true img=5", true),
        ("autotiling=False", false),
        ("autotiling=True img=bush", false),
        ("autotiling=1", false),
        ("randomtiling=0.9", true),
        ("randomtiling=0", true),
        ("randomtiling=-1", false),
        ("randomtiling=0.5 img=bush", false),
    ] {
        let source = GAME.replace("gold > Immovable", &format!("gold > Immovable {params}"));
        let game = Game::from_source_as_reference(&source).unwrap();
        let codes = |level: &str| {
            game.level(level).err().map_or(Vec::new(), |problems| problems.0.iter().map(|p| p.code).collect())
        };
        let expected = if is_fatal { vec!["missing-image"] } else { Vec::new() };
        assert_eq!(codes("Ag \n"), expected, "{params}");
        assert!(codes("A  \n").is_empty(), "{params}");
        let strict = Game::from_source(&source).err().map_or(Vec::new(), |all| all.0);
        assert_eq!(strict.iter().any(|problem| problem.code == "missing-image"), is_fatal, "{params}");
    }
    // Parents pass both parameters on, and need no image themselves.
    let family = "gold > Immovable autotiling=True\n            coin > img=coin\n            bar >";
    let family = GAME.replace("gold > Immovable", family);
    assert!(Game::from_source(&family.replace("g > gold", "g > coin")).is_ok());
    assert!(Game::from_source(&family.replace("g > gold", "g > bar")).is_err());
}
