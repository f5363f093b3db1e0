//! Tests the words of legends with small games, one for each kind of note.

use engine::{Analysis, Game};
use infinite_arcade_render::Looks;

/// Returns a game with these sprite lines, rules and terminations. A level character places the sprites of
/// each line.
fn game(sprites: &[&str], rules: &[&str], ends: &[&str]) -> Game {
    let mut source = String::from("BasicGame\n  SpriteSet\n    floor > Immovable\n    wall > Immovable\n");
    sprites.iter().for_each(|line| source += &format!("    {line}\n"));
    source += "    hero > MovingAvatar\n  LevelMapping\n    h > floor hero\n    w > wall\n";
    for (line, letter) in sprites.iter().zip('a'..'h') {
        source += &format!("    {letter} > floor {}\n", line.split(" > ").next().unwrap());
    }
    source += "  InteractionSet\n    hero wall > stepBack\n";
    rules.iter().for_each(|line| source += &format!("    {line}\n"));
    source += "  TerminationSet\n    SpriteCounter stype=hero limit=0 win=False\n";
    ends.iter().for_each(|line| source += &format!("    {line}\n"));
    Game::from_source(&source).unwrap()
}

#[track_caller]
fn check(game: &Game, expected: &[(&str, &str)]) {
    let looks = Looks::of(&Analysis::of(game));
    for (name, meaning) in expected {
        assert_eq!(looks.meaning(game.sprite_type(name).unwrap()), *meaning, "{name}");
    }
}

const WIN: &[&str] = &["SpriteCounter stype=door limit=0 win=True"];

#[test]
fn what_something_clears_does_not_block_for_good() {
    let rules = ["hero bush > stepBack", "bush goat > killSprite", "door hero > killSprite"];
    let sprites = ["bush > Immovable", "goat > RandomNPC", "door > Door"];
    let cleared = game(&sprites, &rules, WIN);
    check(&cleared, &[("bush", "solid, cleared by goat"), ("wall", "blocks the way for good")]);
    let kept = game(&sprites, &[rules[0], rules[2]], WIN);
    check(&kept, &[("bush", "blocks the way for good")]);
}

#[test]
fn harm_is_told_beside_the_use() {
    let sprites = ["pond > Immovable", "tub > Passive", "door > Door"];
    let rules = [
        "tub hero > bounceForward",
        "pond tub > killBoth",
        "hero pond > killSprite",
        "door hero > killSprite",
    ];
    check(&game(&sprites, &rules, WIN), &[("pond", "push tub here, deadly"), ("tub", "push it onto pond")]);

    let sprites = ["pond > Immovable", "lever > Immovable", "door > Door"];
    let rules = ["lever hero > killAll stype=pond", "hero pond > killSprite", "door hero > killSprite"];
    check(&game(&sprites, &rules, WIN), &[("pond", "opened by lever, deadly")]);
}

#[test]
fn what_protects_from_harm_is_told() {
    let sprites = ["thistle > Immovable", "coat > Immovable", "clad > MovingAvatar", "door > Door"];
    let rules =
        ["hero coat > transformTo stype=clad", "hero thistle > killSprite", "door hero clad > killSprite"];
    check(
        &game(&sprites, &rules, WIN),
        &[("thistle", "deadly unless you are clad"), ("coat", "makes you clad")],
    );

    let sprites = ["thistle > Immovable", "salve > Resource limit=2", "door > Door"];
    let rules = [
        "salve hero > collectResource",
        "hero thistle > killIfHasLess resource=salve limit=0",
        "door hero > killSprite",
    ];
    check(&game(&sprites, &rules, WIN), &[("thistle", "deadly without salve")]);
}

#[test]
fn entries_that_swallow_others_say_so() {
    let sprites = ["shaft > Portal stype=mouth", "mouth > Immovable", "bull > RandomNPC", "door > Door"];
    let rules = ["hero shaft > teleportToExit", "bull shaft > killSprite", "door hero > killSprite"];
    check(&game(&sprites, &rules, WIN), &[("shaft", "takes you elsewhere, swallows bull")]);
}

#[test]
fn all_that_is_chased_is_named() {
    let chase = |class: &str| {
        let source = format!(
            "BasicGame\n  SpriteSet\n    wolf > {class}\n    herd >\n      lamb > Immovable\n      hero > MovingAvatar\n    door > Door\n  \
             LevelMapping\n    w > wolf\n    l > lamb\n    h > hero\n    d > door\n  InteractionSet\n    hero wolf > killSprite\n    \
             door hero > killSprite\n  TerminationSet\n    SpriteCounter stype=door limit=0 win=True\n"
        );
        Game::from_source(&source).unwrap()
    };
    check(&chase("PathChaser stype=herd"), &[("wolf", "chases the nearest of you, lamb, deadly")]);
    check(&chase("PathChaser stype=hero"), &[("wolf", "chases you, deadly")]);
    check(&chase("AlternateChaser stype1=hero,lamb stype2=door"), &[("wolf", "chases you or lamb, deadly")]);
}

#[test]
fn a_follower_that_must_be_led_is_not_to_be_caught() {
    let sprites = ["hen > PathChaser stype=hero", "coop > Immovable"];
    let ends = ["SpriteCounter stype=hen limit=0 win=True"];
    let led = game(&sprites, &["hen coop > killSprite"], &ends);
    check(&led, &[("hen", "lead it to coop to win, chases you"), ("coop", "bring hen here to win")]);
    let caught = game(&sprites, &["hen hero > killSprite"], &ends);
    check(&caught, &[("hen", "catch it to win, chases you")]);
    // If a meeting loses the game, the legend does not suggest it.
    let rules = ["hen coop > spawn stype=lost", "hen coop > killSprite", "hen hero > killSprite"];
    let sprites = ["hen > PathChaser stype=hero", "coop > Immovable", "lost > Immovable"];
    let ends = ["SpriteCounterMore stype=lost limit=1 win=False", ends[0]];
    check(&game(&sprites, &rules, &ends), &[("hen", "catch it to win, chases you")]);
}

#[test]
fn what_must_be_collected_is_not_only_to_be_kept() {
    let sprites = ["crystal > Immovable", "taken > Immovable", "imp > RandomNPC"];
    let rules = ["crystal hero > transformTo stype=taken", "crystal imp > killSprite"];
    let ends = [
        "SpriteCounterMore stype=taken limit=1 win=True",
        "MultiSpriteCounter stype1=crystal stype2=taken limit=0 win=False",
    ];
    let game = game(&sprites, &rules, &ends);
    let looks = Looks::of(&Analysis::of(&game));
    let meaning = looks.meaning(game.sprite_type("crystal").unwrap());
    assert!(meaning.contains("win"), "{meaning}");
}

#[test]
fn what_cannot_come_is_not_said_to_change_anything() {
    let sprites = ["lamp > Immovable", "hawk > Immovable", "lured > RandomNPC", "door > Door"];
    let rules = ["lamp wall > transformToAll stype=hawk stypeTo=lured", "door hero > killSprite"];
    check(&game(&sprites, &rules, WIN), &[("lamp", "harmless")]);
    let sprites =
        ["lamp > Immovable", "hawk > Immovable", "moth > RandomNPC", "door > Door", "lured > RandomNPC"];
    let rules = ["lamp moth > transformToAll stype=hawk stypeTo=lured", "door hero > killSprite"];
    check(&game(&sprites, &rules, WIN), &[("lamp", "moth here changes hawk")]);
}

#[test]
fn what_must_be_filled_is_said_to_be_a_goal() {
    let ends = ["SpriteCounter stype=nest limit=0 win=True"];
    let egg = game(
        &["nest > Immovable", "egg > Passive"],
        &["egg hero > bounceForward", "nest egg > killBoth"],
        &ends,
    );
    check(&egg, &[("nest", "push egg here to win")]);
    let bird = game(&["nest > Immovable", "bird > RandomNPC"], &["nest bird > killBoth"], &ends);
    check(&bird, &[("nest", "bring bird here to win")]);
}

#[test]
fn exits_name_what_they_need() {
    let sprites = ["gem > Resource limit=3", "door > Door"];
    let rules = ["gem hero > collectResource", "door hero > killIfOtherHasMore resource=gem limit=3"];
    check(
        &game(&sprites, &rules, WIN),
        &[("door", "the way to win, needs 3 gem"), ("gem", "needed for door")],
    );
}

#[test]
fn thieves_and_brittle_ground_name_what_changes() {
    let sprites = [
        "thief > Chaser stype=egg",
        "egg > Immovable",
        "plank > Immovable",
        "gap > Immovable",
        "door > Door",
    ];
    let rules = [
        "egg thief > killSprite",
        "plank hero > transformTo stype=gap",
        "hero gap > stepBack",
        "door hero > killSprite",
    ];
    let ends = [WIN[0], "SpriteCounter stype=egg limit=0 win=False"];
    let expected = [("thief", "chases egg, takes egg"), ("plank", "becomes gap when touched")];
    check(&game(&sprites, &rules, &ends), &expected);
}
