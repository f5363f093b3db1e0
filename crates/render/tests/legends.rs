//! Tests of the wording of legends, with a small game for each kind of note.

use engine::{Analysis, Game};
use infinite_arcade_render::{Glyph, Looks};

/// Returns a game with the given sprite lines, rules and terminations. Each sprite line has its own level character,
/// from `a` on, which places one of the line's sprites on floor.
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

const TAKE: &str = "door hero > killSprite";

#[test]
fn what_a_resource_is_spent_on_does_not_need_it() {
    let sprites =
        ["gong > Immovable", "key > Resource limit=9", "rung > Immovable", "bear > PathChaser stype=hero"];
    let rules = [
        "hero gong > spawnIfHasMore resource=key limit=1 spend=1 stype=bear",
        "gong hero > transformTo stype=rung",
        "key hero > collectResource",
        "hero bear > killSprite",
    ];
    let ends = ["SpriteCounter stype=gong limit=0 win=True"];
    let gong = game(&sprites, &rules, &ends);
    check(&gong, &[("gong", "take it to win"), ("key", "spent at gong: makes bear")]);

    // A toll takes something, and gives nothing.
    let sprites = ["toll > Immovable", "coin > Resource limit=9", "door > Door"];
    let rules = ["coin hero > collectResource", "hero toll > changeResource resource=coin value=-1", TAKE];
    check(&game(&sprites, &rules, WIN), &[("coin", "spent at toll"), ("toll", "takes your coin")]);

    // A wall that takes something and gives something else.
    let sprites = ["oven > Immovable", "straw > Resource limit=9", "bun > Resource limit=9", "door > Door"];
    let rules = [
        "hero oven > spawnIfHasMore resource=straw limit=1 spend=1 stype=bun",
        "hero oven > stepBack",
        "straw hero > collectResource",
        "bun hero > collectResource",
        "door hero > killIfOtherHasMore resource=bun limit=2",
    ];
    let oven = game(&sprites, &rules, WIN);
    let expected = [
        ("straw", "spent at oven: makes bun"),
        ("oven", "straw here makes bun, solid"),
        ("bun", "needed for door"),
        ("door", "the way to win, needs 2 bun"),
    ];
    check(&oven, &expected);
}

#[test]
fn a_key_is_needed_only_if_it_is_the_only_means() {
    let sprites = ["gate > Immovable", "key > Resource limit=1", "door > Door", "goat > RandomNPC"];
    let rules = [
        "gate hero > killIfOtherHasMore resource=key limit=1",
        "hero gate > stepBack",
        "key hero > collectResource",
        TAKE,
        "gate goat > killSprite",
    ];
    check(&game(&sprites, &rules[..4], WIN), &[("key", "needed for gate"), ("gate", "needs key")]);
    check(&game(&sprites, &rules, WIN), &[("key", "opens gate")]);
    // A chest that bars nothing and wins nothing.
    let chest = [rules[0], rules[2], TAKE];
    check(&game(&sprites, &chest, WIN), &[("key", "removes gate")]);
    // The loss of what the key removes loses the game.
    let ends = [WIN[0], "SpriteCounter stype=gate limit=0 win=False"];
    check(&game(&sprites, &rules[..4], &ends), &[("key", "opens gate")]);
}

#[test]
fn resources_that_protect_or_weigh_say_so() {
    let sprites = ["ice > Immovable", "sack > Resource limit=9", "door > Door"];
    let collect = "sack hero > collectResource";
    let rules = [collect, "hero ice > killIfHasMore resource=sack limit=2", TAKE];
    let ice = game(&sprites, &rules, WIN);
    check(&ice, &[("ice", "deadly with 2 sack"), ("sack", "2 are deadly at ice")]);
    let rules = [collect, "hero ice > killIfHasLess resource=sack limit=1", TAKE];
    let ice = game(&sprites, &rules, WIN);
    check(&ice, &[("ice", "deadly without 2 sack"), ("sack", "protects from ice")]);
    // A second rule kills in any case.
    let rules = [rules[0], rules[1], rules[2], "hero ice > killSprite"];
    check(&game(&sprites, &rules, WIN), &[("ice", "deadly")]);
}

#[test]
fn what_loses_is_not_the_way_to_win() {
    let sprites = ["door > Door"];
    let lose = "SpriteCounter stype=door limit=0 win=False";
    check(&game(&sprites, &[TAKE], &[lose, WIN[0]]), &[("door", "too few left, and you lose")]);
    check(&game(&sprites, &[TAKE], &[WIN[0], lose]), &[("door", "the way to win")]);
    let early = "SpriteCounter stype=door limit=1 win=False";
    check(&game(&sprites, &[TAKE], &[WIN[0], early]), &[("door", "too few left, and you lose")]);

    let glyph = |ends: &[&str]| {
        let game = game(&sprites, &[TAKE], ends);
        Looks::of(&Analysis::of(&game)).look(game.sprite_type("door").unwrap()).glyph
    };
    assert_eq!([glyph(&[lose, WIN[0]]), glyph(&[WIN[0], lose])], [Glyph::Ward, Glyph::Exit]);

    // The touch that wins also makes what loses.
    let sprites = ["door > Door", "alarm > Immovable"];
    let rules = ["door hero > spawn stype=alarm", TAKE];
    let ends = ["SpriteCounterMore stype=alarm limit=1 win=False", WIN[0]];
    check(&game(&sprites, &rules, &ends), &[("door", "must go for the win"), ("alarm", "one, and you lose")]);

    // A touch that kills the player is no way to win.
    let sprites = ["door > Door"];
    check(&game(&sprites, &["door hero > killBoth"], WIN), &[("door", "must go for the win, deadly")]);

    // Some wins and more loses.
    let sprites = ["egg > Immovable", "nest > Immovable"];
    let rules = ["egg hero > transformTo stype=nest"];
    let ends =
        ["SpriteCounterMore stype=nest limit=2 win=True", "SpriteCounterMore stype=nest limit=5 win=False"];
    check(&game(&sprites, &rules, &ends), &[("nest", "2 win; 5, and you lose")]);
    let ends =
        ["SpriteCounterMore stype=nest limit=5 win=True", "SpriteCounterMore stype=nest limit=2 win=False"];
    check(&game(&sprites, &rules, &ends), &[("nest", "2, and you lose")]);
}

#[test]
fn the_score_may_decide_between_winning_and_losing() {
    let ends = ["SpriteCounter stype=door limit=0 win=True count_score=True"];
    check(&game(&["door > Door"], &[TAKE], &ends), &[("door", "may win or lose the game")]);
}

#[test]
fn conditions_of_winning_touches_are_told() {
    let sprites = ["cave > Immovable", "vine > Immovable", "open > Immovable"];
    let cave = |count: &str| format!("cave hero > transformIfCount stypeCount=vine {count} stype=open");
    let ends = ["SpriteCounter stype=cave limit=0 win=True"];
    let vine = "vine hero > killSprite";
    let check_with = |count: &str, expected: &str| {
        check(&game(&sprites, &[&cave(count), vine], &ends), &[("cave", expected)]);
    };
    check_with("leq=0", "take it to win, once no vine is left");
    check_with("leq=2", "take it to win, with at most 2 vine left");
    check_with("geq=2", "take it to win, needs 2 vine");
    check_with("geq=0 leq=0", "take it to win, once no vine is left");
    check_with("geq=1 leq=2", "take it to win, but not always");

    // The touch loses the game unless the condition holds.
    let sprites = ["cave > Immovable", "vine > Immovable", "open > Immovable", "shut > Immovable"];
    let cave = "cave hero > transformIfCount stypeCount=vine leq=0 stype=open estype=shut";
    let lose = "SpriteCounterMore stype=shut limit=1 win=False";
    let expected = "take it to win, once no vine is left, or lose";
    check(&game(&sprites, &[cave, vine], &[lose, ends[0]]), &[("cave", expected)]);

    // Two resources open the same door.
    let sprites = ["axe > Resource limit=1", "key > Resource limit=1", "door > Door"];
    let rules = [
        "axe hero > collectResource",
        "key hero > collectResource",
        "door hero > killIfOtherHasMore resource=axe limit=1",
        "door hero > killIfOtherHasMore resource=key limit=1",
        "hero door > stepBack",
    ];
    let either = [("door", "the way to win, needs axe or key"), ("axe", "opens door"), ("key", "opens door")];
    check(&game(&sprites, &rules, WIN), &either);

    let sprites = ["door > Door", "latch > Door"];
    let rules = ["door hero > killSprite", "latch hero > killSprite"];
    let ends = ["MultiSpriteCounter stype1=door stype2=latch limit=0 win=True"];
    check(&game(&sprites, &rules, &ends), &[("door", "part of the win"), ("latch", "part of the win")]);
}

#[test]
fn others_are_brought_only_where_they_win() {
    let rules = ["hen coop > spawn stype=lost", "hen coop > killSprite", "hen hero > killSprite"];
    let sprites = ["hen > PathChaser stype=hero", "coop > Immovable", "lost > Immovable"];
    let ends = ["SpriteCounterMore stype=lost limit=1 win=False", "SpriteCounter stype=hen limit=0 win=True"];
    check(&game(&sprites, &rules, &ends), &[("coop", "keep hen away")]);

    let push = "tub hero > bounceForward";
    let sprites = ["drain > Immovable", "tub > Passive", "door > Door"];
    let drain = game(&sprites, &[push, "tub drain > killSprite", TAKE], WIN);
    check(&drain, &[("drain", "swallows tub"), ("tub", "can be pushed, lost at drain")]);
    let ends = [WIN[0], "SpriteCounter stype=tub limit=0 win=False"];
    let drain = game(&sprites, &[push, "drain tub > killBoth", TAKE], &ends);
    check(&drain, &[("drain", "swallows tub"), ("tub", "can be pushed, lost at drain")]);
}

#[test]
fn what_must_be_kept_is_not_to_be_taken() {
    let sprites = ["egg > Immovable", "door > Door"];
    let ends = [WIN[0], "SpriteCounter stype=egg limit=0 win=False"];
    let rules = ["egg hero > killSprite", TAKE];
    check(&game(&sprites, &rules, &ends), &[("egg", "too few left, and you lose")]);
}

#[test]
fn obstacles_that_something_removes_do_not_block_for_good() {
    let sprites =
        ["vine > Immovable", "bell > Immovable", "goat > RandomNPC", "door > Door", "hedge > Immovable"];
    let stop = "hero vine hedge > stepBack";
    let rung = game(&sprites, &[stop, "bell goat > killAll stype=vine", TAKE], WIN);
    check(&rung, &[("vine", "opened by bell"), ("bell", "goat here removes vine")]);
    let grown = game(&sprites, &[stop, "bell goat > transformToAll stype=vine stypeTo=hedge", TAKE], WIN);
    check(&grown, &[("vine", "changed by bell")]);
    let grown = game(&sprites, &[stop, "vine goat > transformTo stype=hedge", TAKE], WIN);
    check(&grown, &[("vine", "solid, changed by goat")]);
    let timed = game(&sprites, &[stop, "vine TIME > killSprite timer=9", TAKE], WIN);
    check(&timed, &[("vine", "solid"), ("wall", "blocks the way for good")]);
    // Nothing brings the bell to the vine.
    let apart = game(&sprites, &[stop, "vine bell > killSprite", TAKE], WIN);
    check(&apart, &[("vine", "solid")]);
}

#[test]
fn health_is_about_the_player() {
    let sprites = ["pond > Immovable", "goat > RandomNPC", "door > Door"];
    let goat = game(&sprites, &["goat pond > addHealthPoints value=1", TAKE], WIN);
    check(&goat, &[("pond", "harmless")]);
    let hero = game(&sprites, &["hero pond > addHealthPoints value=1", TAKE], WIN);
    check(&hero, &[("pond", "heals you")]);
}

#[test]
fn movers_that_take_something_are_not_harmless() {
    let sprites = ["goat > RandomNPC", "key > Resource limit=1", "door > Door"];
    let unlock = "door hero > killIfOtherHasMore resource=key limit=1";
    let rules = ["key hero > collectResource", unlock, "key goat > killSprite"];
    check(&game(&sprites, &rules, WIN), &[("goat", "wanders, takes key")]);
    let rules = [rules[0], unlock, "hero goat > changeResource resource=key value=-1"];
    check(&game(&sprites, &rules, WIN), &[("goat", "wanders, takes your key")]);
    let rules = [rules[0], unlock, "goat hero > killSprite scoreChange=1"];
    check(&game(&sprites, &rules, WIN), &[("goat", "wanders, take it for points")]);
    let sprites = ["goat > RandomNPC", "tub > Passive", "door > Door"];
    let rules = ["tub hero > bounceForward", "tub goat > killSprite", TAKE];
    check(&game(&sprites, &rules, WIN), &[("goat", "wanders, takes tub")]);
}

#[test]
fn prey_that_no_known_way_removes_is_not_to_be_caught() {
    let sprites = ["moth > RandomNPC", "lamp > Immovable"];
    let ends = ["SpriteCounter stype=moth limit=0 win=True"];
    let lit = game(&sprites, &["lamp hero > killAll stype=moth"], &ends);
    check(&lit, &[("moth", "touch lamp to win, wanders"), ("lamp", "touch it to change moth")]);
    let timed = game(&sprites, &["moth EOS > killSprite"], &ends);
    check(&timed, &[("moth", "must go for the win, wanders")]);
}

#[test]
fn what_only_exists_within_a_swap_is_not_listed() {
    let sprites = ["lever > Immovable", "bolt > Immovable", "slot > Immovable", "door > Door"];
    let rules = [
        "lever hero > transformToAll stype=bolt stypeTo=turning",
        "lever hero > transformToAll stype=slot stypeTo=bolt",
        "lever hero > transformToAll stype=turning stypeTo=slot",
        "door hero > killSprite",
    ];
    let source = game(&sprites, &[], WIN).description().clone();
    let source = engine::syntax::print(&source)
        .replace("SpriteSet\n", "SpriteSet\n        turning > Flicker limit=0\n")
        .replace("InteractionSet\n", &format!("InteractionSet\n        {}\n", rules.join("\n        ")));
    let game = Game::from_source(&source).unwrap();
    let looks = Looks::of(&Analysis::of(&game));
    let shown: Vec<&str> = looks.shown().map(|stype| game.name(stype)).collect();
    assert!(shown.contains(&"bolt") && !shown.contains(&"turning"), "{shown:?}");
}

#[test]
fn what_heals_is_not_called_merely_solid() {
    let sprites = ["oven > Immovable", "snow > Immovable", "door > Door"];
    let rules = [
        "hero oven > addHealthPointsToMax value=99",
        "hero oven > stepBack",
        "hero snow > subtractHealthPoints",
        "door hero > killSprite",
    ];
    check(&game(&sprites, &rules, WIN), &[("oven", "heals you, solid")]);
}
