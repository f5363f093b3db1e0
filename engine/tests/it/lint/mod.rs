//! Tests warnings about rules that cannot do what they seem to do.

mod refuted;
mod swapped;
mod terminations;

use engine::Game;

pub(super) const GAME: &str = "\
BasicGame
    SpriteSet
        grass > Immovable
        nest > SpawnPoint stype=chick prob=0.5 total=9
        chick > RandomNPC
        stone > Immovable
        fence > Immovable
        egg > Resource limit=3
        avatar > MovingAvatar
    LevelMapping
        . > grass
        n > nest
        s > grass stone
        f > grass fence
        e > grass egg
        A > grass avatar
    InteractionSet
        egg avatar > collectResource
        avatar stone fence nest > stepBack
        chick stone fence > stepBack
        chick avatar > killIfOtherHasMore resource=egg limit=2 scoreChange=1
    TerminationSet
        SpriteCounter stype=nest win=False
        Timeout limit=300 win=True
";

/// Checks the codes and lines of the warnings about the game after some text is replaced.
#[track_caller]
pub(super) fn check(replace: &str, with: &str, expect: &[(&str, usize)]) {
    assert!(GAME.contains(replace), "{replace}");
    let source = GAME.replace(replace, with);
    let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}"));
    let line = |start| engine::line_and_column(&source, start).0;
    let reported = game.warnings().iter().map(|warning| (warning.code, line(warning.span.start)));
    assert_eq!(reported.collect::<Vec<_>>(), expect, "{:?}", game.warnings());
}

#[test]
fn a_sound_game_has_no_warnings() {
    check("", "", &[]);
}

#[test]
fn rules_that_never_fire() {
    let rule = "avatar stone fence nest > stepBack\n";
    check(rule, &format!("{rule}        stone fence > killSprite\n"), &[("never-fires", 20)]);
    // Two stones are in one cell.
    let both = &GAME.replace("s > grass stone", "s > grass stone stone");
    assert!(
        Game::from_source(&both.replace(rule, &format!("{rule}        stone stone > killSprite\n")))
            .unwrap()
            .warnings()
            .is_empty()
    );
    // Pushed sprites move.
    let pushed = format!("{rule}        stone avatar > bounceForward\n        stone fence > undoAll\n");
    check(rule, &pushed, &[]);
    check("egg avatar > collectResource", "egg avatar > killSprite", &[("never-fires", 21)]);
}

#[test]
fn swapped_barriers_are_reported() {
    let rule = "avatar stone fence nest > stepBack";
    check(rule, "stone avatar fence nest > stepBack", &[("swapped-rule", 19)]);
    check(rule, &format!("{rule}\n        stone avatar > stepBack"), &[]);
    check(rule, "stone avatar > stepBack\n        avatar stone > killSprite", &[]);
}

#[test]
fn sprites_under_scenery() {
    let late = GAME
        .replace("        grass > Immovable\n", "")
        .replace("        avatar > Mov", "        grass > Immovable\n        avatar > Mov");
    let game = Game::from_source(&late).unwrap();
    let codes: Vec<&str> = game.warnings().iter().map(|warning| warning.code).collect();
    assert_eq!(codes, ["hidden-sprite"; 3], "{:?}", game.warnings());
}

#[test]
fn parameters_of_the_other_physics() {
    check("chick > RandomNPC", "chick > RandomNPC gravity=1", &[("ignored-parameter", 5)]);
    check("chick > RandomNPC", "chick > RandomNPC gravity=1 physicstype=CONT", &[]);
    check("avatar > MovingAvatar", "avatar > MovingAvatar jump_strength=5", &[("ignored-parameter", 9)]);
}

#[test]
fn avatars_drawn_first_are_reported() {
    let first = GAME.replace(
        "        grass > Immovable\n",
        "        hen > MovingAvatar\n        wall > Immovable\n        grass > Immovable\n",
    );
    let game = Game::from_source(&first.replace("A > grass avatar", "A > grass hen")).unwrap();
    assert!(game.warnings().iter().any(|warning| warning.code == "lost-avatar"), "{:?}", game.warnings());
    let mut state = game.start(&game.level("A.n\n").unwrap(), base::Seed::from_text("any"));
    game.step(&mut state, engine::Action::Right);
    assert_eq!(game.actions(&state), [engine::Action::Nil], "the warning is wrong: the player finds it");
}

#[test]
fn walls_that_stop_nobody_are_reported() {
    let walled = |name: &str, rule: &str| {
        let source = GAME.replace("fence", name).replace(&format!("avatar stone {name}"), rule);
        Game::from_source(&source).unwrap()
    };
    let codes = |game: &Game| game.warnings().iter().map(|warning| warning.code).collect::<Vec<_>>();
    assert!(codes(&walled("highWall", "avatar stone highWall")).is_empty());
    let open = walled("highWall", "avatar stone");
    assert_eq!(codes(&open), ["open-wall"]);
    assert!(open.warnings()[0].help.as_ref().unwrap().contains("`avatar highWall > stepBack`"));
    // Any rule about the two types counts as intended, and so does a rule about a sprite that is placed
    // together with the wall.
    assert!(codes(&walled("highWall", "highWall avatar > killSprite\n        avatar stone")).is_empty());
    let both = GAME.replace("f > grass fence", "f > fence highWall\n        g > grass");
    let both = both.replace("        fence >", "        highWall > Immovable\n        fence >");
    assert!(codes(&Game::from_source(&both).unwrap()).is_empty());
    // A type that surrounds a level is a wall, whatever its name, unless it is ground.
    let unnamed = walled("hedge", "avatar stone");
    assert!(codes(&unnamed).is_empty());
    let of_level = |text: &str| codes_of(&unnamed, text);
    assert_eq!(of_level("fffff\nfA.nf\nf...f\nfffff\n"), ["open-wall"]);
    assert!(of_level("fffff\nfA.nf\nf...f\nffff.\n").is_empty());
    assert!(of_level("fffff\nfAfff\nfffnf\nfffff\n").is_empty());
    assert!(of_level(".....\n.A.n.\n.....\n.....\n").is_empty());
}

/// Returns the codes of the warnings about a level.
fn codes_of(game: &Game, text: &str) -> Vec<&'static str> {
    game.level(text).unwrap().warnings().iter().map(|warning| warning.code).collect()
}
