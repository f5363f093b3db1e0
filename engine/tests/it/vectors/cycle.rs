//! Tests the quirks of loading and of the cycle in the specification (`spec/01` §10), by number. Also tests
//! the terminations and counters that no public game uses.

use crate::board::{Board, setup};
use engine::{Action, Chance, Diagnostic, Game, Limit, Outcome, Severity};

const AVATAR: (&str, i32, i32) = ("avatar", 0, 50);
const PAIR: [(&str, i32, i32); 2] = [("a", 20, 20), ("avatar", 20, 20)];

/// K-5: an inherited class overrides the written class, but the grandchildren inherit the written class.
#[test]
fn inherited_classes() {
    let sprites = "a > Missile orientation=RIGHT\n  b > Bomber\n    c >\navatar > MovingAvatar";
    let board = setup(sprites, "").place(&[AVATAR]);
    let class = |name: &str| board.game.class(board.game.sprite_type(name).unwrap()).unwrap().name();
    assert_eq!(["a", "b", "c"].map(class), ["Missile", "Missile", "Bomber"]);
}

/// K-9: the search for the player's avatar starts at the second type of the drawing order, and `avatar` is drawn last.
#[test]
fn finding_the_avatar() {
    let sprites = "hero > MovingAvatar\nwall > Immovable\na > Immovable";
    let board = setup(sprites, "").place(&[("hero", 20, 20)]);
    assert_eq!(
        (board.state.avatar_id(), board.messages()),
        (None, 2),
        "once for the level, once for the run"
    );
    let board = setup(&format!("b > Immovable\n{sprites}"), "").place(&[("hero", 20, 20)]);
    assert_eq!((board.state.avatar_id(), board.messages()), (Some(0), 0));
    let order = |sprites: &str| {
        let board = setup(sprites, "").place(&[]);
        let name = |stype: &u16| board.game.name(engine::SpriteType(*stype)).to_owned();
        board.game.drawing_order().iter().map(name).collect::<Vec<String>>().join(" ")
    };
    assert_eq!(order("a > Immovable"), "wall a avatar");
    assert_eq!(
        order("b > Immovable\navatar > MovingAvatar\nwall > Immovable\nc > Immovable"),
        "b wall c avatar"
    );
    assert_eq!(order("x > Immovable\n  y >\n  wall >\nz > Immovable"), "y wall z avatar");
    assert_eq!(
        order("wall > Immovable\n  y >\nz > Immovable\ny > Immovable"),
        "wall z y avatar",
        "the last one counts"
    );
}

/// Without an avatar nothing can score, and the tick limit has no loser.
#[test]
fn playing_without_an_avatar() {
    let sprites = "a > Immovable\nb > Missile orientation=RIGHT";
    let placed = [("a", 20, 20), ("b", 10, 20)];
    let mut board = setup(sprites, "a b > killSprite").place(&placed);
    assert_eq!(board.play("RR").state.outcome(), Outcome::Stopped(Limit::NoAvatar));
    let mut board = setup(sprites, "a b > killSprite applyScore=False").ends("").place(&placed);
    board.play(&".".repeat(2000));
    assert_eq!((board.count("a"), board.state.outcome()), (0, Outcome::Ongoing));
    assert_eq!(board.wait().state.outcome(), Outcome::Stopped(Limit::NoAvatar));
}

/// K-11, Q3: counters take lists, and a single number is not a list. A missing entry equals the first entry.
#[test]
fn counters_take_lists() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    let counters = |header: &str, rules: &str| {
        setup(sprites, rules).header(header).place(&PAIR).play("..").state.counters().to_vec()
    };
    let rules = "a avatar > halfSpeed counter=1\na avatar > halfSpeed counter=1,0";
    assert_eq!(counters("no_counters=2", rules), [2, 0]);
    assert_eq!(counters("no_counters=3", "a avatar > halfSpeed counter=2,-1"), [4, -2, 4]);
    assert_eq!(counters("no_counters=1", "a avatar > halfSpeed counter=3,"), [6]);
    assert_eq!(
        counters("no_counters=1", "a avatar > halfSpeed counter=1,1 count=False counterElse=5,5"),
        [10]
    );
    assert_eq!(
        counters("no_counters=1", "a avatar > halfSpeed counter=1,1 counterElse=5,5 countElse=False"),
        [2]
    );
    assert_eq!(counters("", rules), [] as [i32; 0]);
    assert_eq!(setup(sprites, rules).header("no_counters=2").problems(&PAIR), ["wrong-type"]);
    // A text that is not a number causes a message at every execution, for each counter that it applies to.
    let board = |rule: &str| setup(sprites, rule).header("no_counters=2").place(&PAIR).play("..").messages();
    assert_eq!(board("a avatar > halfSpeed counter=x"), 4);
    assert_eq!(board("a avatar > halfSpeed counter=1,x counterElse=,"), 2 + 4);
    assert_eq!(board("a avatar > halfSpeed counter=x count=False"), 0);
}

/// transformIfCount and spawnIfCounterSubTypes decide which counters count (`spec/03` §7.4, §8.5).
#[test]
fn effects_that_count() {
    let sprites = "a > Immovable\nb > Immovable\nc > Immovable\navatar > MovingAvatar";
    let outcome = |rule: &str, placed: &[(&str, i32, i32)]| {
        let mut board = setup(sprites, rule).header("no_counters=1").place(placed);
        board.wait();
        (board.count("b"), board.count("c"), board.score(), board.state.counters()[0])
    };
    let rule = "a avatar > transformIfCount stype=b estype=c stypeCount=a geq=2 scoreChange=1 counter=1,1 counterElse=10,10";
    let two = [("a", 20, 20), ("a", 50, 20), ("avatar", 20, 20)];
    assert_eq!(outcome(rule, &two), (1, 0, 1, 1));
    assert_eq!(outcome(rule, &PAIR), (0, 1, 0, 10));
    assert_eq!(outcome(&rule.replace("estype=c ", ""), &PAIR), (0, 0, 0, 0));
    let rule = "a avatar > spawnIfCounterSubTypes stype=b estype=c stypeCount=a limit=2 subTypesNum=0 scoreChange=1 counter=1,1 counterElse=10,10";
    assert_eq!(outcome(rule, &two), (1, 0, 1, 11), "one kind, halved, is none");
    assert_eq!(outcome(rule, &PAIR), (0, 1, 0, 10));
    assert_eq!(outcome(&rule.replace("subTypesNum=0", "subTypesNum=1"), &two), (0, 1, 0, 10));
}

/// K-12, K-13: values of the wrong type for a field are ignored, and constants are numbers.
#[test]
fn values_and_fields() {
    let sprites = "m > Missile orientation=RIGHT cooldown=2.0 speed=TYPE_AVATAR\nn > Missile orientation=RIGHT speed=0x1p-1\navatar > MovingAvatar";
    let mut board = setup(sprites, "").place(&[("m", 20, 20), ("n", 20, 30), AVATAR]);
    board.play("...");
    assert_eq!((board.one("m").speed, board.at("n")), (0.0, (30, 30)));
}

/// K-20: a pair runs at the position of its first line, even if that line is disabled.
#[test]
fn pairs_run_where_they_first_appear() {
    let sprites = "a > Immovable\nb > Immovable\nc > Immovable\navatar > MovingAvatar";
    let placed = [("a", 20, 20), ("b", 20, 20), ("c", 20, 20), AVATAR];
    for first in ["halfSpeed", "halfSpeed enabled=False", "halfSpeed repeat=0"] {
        let rules = format!("a b > {first}\na c > killSprite\na b > flipDirection scoreChange=1");
        assert_eq!(setup(sprites, &rules).place(&placed).wait().score(), 1, "{first}");
    }
    let rules = "a c > killSprite\na b > flipDirection scoreChange=1";
    assert_eq!(setup(sprites, rules).place(&placed).wait().score(), 0);
}

/// K-27: there are at most 2001 ticks, and a Timeout ends the game in the tick of its limit.
#[test]
fn time_limits() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    let mut board = setup(sprites, "").ends("Timeout limit=3 win=True").place(&PAIR);
    assert_eq!(board.game.time_limit(), 4);
    assert_eq!(board.play("...").state.outcome(), Outcome::Ongoing);
    assert_eq!((board.wait().state.outcome(), board.state.tick()), (Outcome::Won, 3));
    let mut board = setup(sprites, "").ends("Timeout limit=500.0").place(&PAIR);
    assert_eq!(board.wait().state.outcome(), Outcome::Lost, "a number with a point is no limit");
    let mut board = setup(sprites, "").ends("").place(&PAIR);
    assert_eq!(board.game.time_limit(), 2001);
    assert_eq!(board.play(&".".repeat(2000)).state.outcome(), Outcome::Ongoing);
    assert_eq!((board.wait().state.outcome(), board.state.tick()), (Outcome::Lost, 2000));
}

/// K-29: a sprite that is made in a tick is updated in the same tick if its type is declared earlier.
/// Spawning into the updated type stops the game.
#[test]
fn updates_of_the_newborn() {
    let flies = |sprites: &str| {
        let mut board = setup(sprites, "").place(&[("s", 20, 20), AVATAR]);
        board.play("..");
        board.at("m").0
    };
    assert_eq!(
        flies("m > Missile orientation=RIGHT\ns > SpawnPoint stype=m total=1\navatar > MovingAvatar"),
        30
    );
    assert_eq!(
        flies("s > SpawnPoint stype=m total=1\nm > Missile orientation=RIGHT\navatar > MovingAvatar"),
        20
    );
    let mut board =
        setup("s > SpawnPoint stype=s\navatar > MovingAvatar", "").place(&[("s", 20, 20), AVATAR]);
    assert_eq!(board.wait().state.outcome(), Outcome::Stopped(Limit::SpawnIntoUpdatedType));
}

/// K-37: a step of less than a pixel falls back to the speed, truncated to a whole number.
#[test]
fn steps_of_less_than_a_pixel() {
    let sprites = "m > Missile orientation=RIGHT speed=S\navatar > MovingAvatar";
    for (speed, moved) in [("0.05", 0), ("0.25", 2), ("1.05", 10), ("-0.25", -2)] {
        let sprites = sprites.replace("speed=S", &format!("speed={speed}"));
        let mut board = setup(&sprites, "").place(&[("m", 20, 20), AVATAR]);
        assert_eq!(board.play("..").at("m").0, 20 + moved, "{speed}");
    }
}

/// A type declared below itself counts twice, and is met twice (`spec/01` §1.6.3).
#[test]
fn a_type_below_itself() {
    let sprites = "a >\n  a > Immovable\navatar > MovingAvatar";
    let mut board = setup(sprites, "avatar a > halfSpeed scoreChange=1\na avatar > halfSpeed scoreChange=10")
        .ends("SpriteCounterMore stype=a limit=2 win=True")
        .place(&PAIR);
    assert_eq!((board.wait().score(), board.state.outcome()), (22, Outcome::Won));
}

fn ends(rules: &str, ends: &str, placed: &[(&str, i32, i32)]) -> Vec<Outcome> {
    let sprites = "all >\n  a > Immovable\n  b > Immovable\nc > Immovable\navatar > MovingAvatar";
    let mut board = setup(sprites, rules).header("no_counters=1").ends(ends).place(placed);
    (0..3).map(|_| board.wait().state.outcome()).collect()
}

/// `spec/01` §4.8: the conditions that end a game.
#[test]
fn terminations() {
    use Outcome::{Lost, Ongoing, Won};
    let placed = [("a", 20, 20), ("b", 30, 20), ("c", 40, 20), AVATAR];
    let now = |line: &str| ends("", line, &placed)[0];
    for (line, expected) in [
        ("SpriteCounter stype=all limit=2 win=True", Won),
        ("SpriteCounter stype=all limit=1 win=True", Ongoing),
        ("SpriteCounter stype=avatar win=True", Ongoing),
        ("SpriteCounterMore stype=all limit=2 win=TRUE", Won),
        ("SpriteCounterMore stype=all limit=3", Ongoing),
        ("SpriteCounterMore stype=all limit=2 win=1", Lost),
        ("SpriteCounterMore stype=all limit=2 win=false,True", Lost),
        ("SpriteCounterMore stype=all limit=2 win=,", Lost),
        ("MultiSpriteCounter stype1=a stype2=b stype3=c limit=3 win=True", Won),
        ("MultiSpriteCounter stype1=a stype2=all limit=3 win=True", Won),
        ("MultiSpriteCounter stype1=all limit=1 win=True", Ongoing),
        ("MultiSpriteCounter stype1=all limit=1 min=True win=True", Won),
        ("MultiSpriteCounter stype2=c limit=1 win=True", Won),
        ("MultiSpriteCounter win=True", Won),
        ("MultiSpriteCounterSubTypes stype1=all limit=2 subTypesNum=2 win=True", Won),
        ("MultiSpriteCounterSubTypes stype1=all limit=2 subTypesNum=1 win=True", Ongoing),
        ("MultiSpriteCounterSubTypes stype1=a limit=1 subTypesNum=1 win=True", Won),
    ] {
        assert_eq!(now(line), expected, "{line}");
    }
    for unread in [
        "SpriteCounter win=True",
        "SpriteCounter stype=a,b",
        "SpriteCounter stype=7",
        "Deadline limit=0",
        "MultiSpriteCounter stype1=x",
    ] {
        assert_eq!(now(&format!("{unread}\nTimeout limit=0")), Ongoing, "{unread}");
    }
    // A killed avatar no longer counts.
    let here = [("c", 20, 20), ("avatar", 20, 20)];
    assert_eq!(ends("avatar c > killSprite", "SpriteCounter stype=avatar win=False", &here)[0], Lost);
}

/// K-26: StopCounter and `canEnd` prevent counters from ending the game, but not Timeouts.
#[test]
fn counters_that_may_not_end_the_game() {
    use Outcome::{Ongoing, Won};
    let placed = [("a", 20, 20), ("a", 30, 20), ("c", 40, 20), AVATAR];
    let rules = "a TIME > killAll stype=c timer=1 nextExecution=0";
    let counter = "SpriteCounter stype=b win=True";
    assert_eq!(
        ends(rules, &format!("StopCounter stype1=c limit=1\n{counter}"), &placed),
        [Ongoing, Won, Won]
    );
    assert_eq!(ends(rules, &format!("{counter}\nStopCounter stype1=c limit=1"), &placed)[0], Won, "too late");
    // In the first tick the sum is 3, then 2.
    let stop = "StopCounter stype1=c stype2=a limit=2 min=True";
    assert_eq!(ends(rules, &format!("{stop}\n{counter}"), &placed), [Ongoing, Won, Won]);
    assert_eq!(
        ends(rules, &format!("Timeout limit=1 canEnd=False win=True\n{counter}"), &placed),
        [Ongoing, Won, Won]
    );
    assert_eq!(ends(rules, &format!("{counter} canEnd=False\nTimeout limit=9 canEnd=True"), &placed)[0], Won);
}

/// `count_score` with one player: any score except 0 wins, whatever `win` says.
#[test]
fn the_score_decides() {
    use Outcome::{Lost, Won};
    let here = [("c", 20, 20), ("avatar", 20, 20)];
    for (score, expected) in [("5", Won), ("-1", Won), ("0", Lost)] {
        let rule = format!("avatar c > halfSpeed scoreChange={score}");
        assert_eq!(ends(&rule, "Timeout limit=0 win=True count_score=True", &here)[0], expected, "{score}");
        assert_eq!(ends(&rule, "SpriteCounter stype=a count_score=True", &here)[0], expected, "{score}");
    }
}

/// K-25 with one player: Timeouts that examine counters.
#[test]
fn counters_decide() {
    use Outcome::{Lost, Won};
    let here = [("c", 20, 20), ("avatar", 20, 20)];
    let rule = "avatar c > halfSpeed counter=2,2 scoreChange=1";
    let after = |line: &str| ends(rule, &format!("Timeout limit=0 {line}"), &here)[0];
    assert_eq!(after("use_counter=True limits=2,"), Won);
    assert_eq!(after("use_counter=True limits=1,2 win=True"), Lost);
    assert_eq!(
        after("use_counter=True limits=2 win=True count_score=True"),
        Lost,
        "a single number is no list"
    );
    assert_eq!(after("use_counter=True compare=True win=True"), Lost, "one counter equals itself");
    assert_eq!(after("use_counter=False win=True"), Won);
    let sprites = "c > Immovable\navatar > MovingAvatar";
    let two = |rule: &str, end: &str| {
        let mut board = setup(sprites, rule).header("no_counters=2").ends(end).place(&here);
        board.wait().state.outcome()
    };
    assert_eq!(two("avatar c > halfSpeed counter=2,0", "Timeout use_counter=True compare=True"), Won);
    assert_eq!(
        two("avatar c > halfSpeed counter=2,2", "Timeout use_counter=True compare=True win=True"),
        Lost
    );
    assert_eq!(two("avatar c > halfSpeed counter=2,2", "Timeout use_counter=True limits=2,2 win=True"), Lost);
}

/// The first line: an unknown parameter causes two messages, and more than one player is not supported
/// (`spec/01` §1.5).
#[test]
fn the_first_line() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    let messages = |header: &str| setup(sprites, "").header(header).place(&PAIR).messages();
    assert_eq!(messages("key_handler=Pulse no_players=1 no_counters=0 obs=a square_size=20.5"), 0);
    assert_eq!(messages("no_players=x key_handler=5 obs=7"), 0);
    assert_eq!(messages("bogus=1 other=2 bogus=3 word"), 4);
    let size = |header: &str| setup(sprites, "").header(header).place(&PAIR).state.block();
    assert_eq!(
        [size(""), size("square_size=25"), size("square_size=2.5"), size("square_size=TYPE_MOVABLE")],
        [10, 25, 10, 6]
    );
    for (header, code) in [
        ("no_players=2", "unsupported"),
        ("no_players=0", "unsupported"),
        ("square_size=0", "unsupported"),
        ("no_counters=-1", "unsupported"),
        ("no_counters=1000", "unsupported"),
    ] {
        let (source, _) = setup(sprites, "").header(header).texts(&PAIR);
        for problems in
            [Game::from_source(&source).unwrap_err(), Game::from_source_as_reference(&source).unwrap_err()]
        {
            // `square_size` is set before `header`, so strict loading warns about the second value.
            let is_error = |problem: &&Diagnostic| problem.severity == Severity::Error;
            let errors: Vec<&Diagnostic> = problems.0.iter().filter(is_error).collect();
            let codes: Vec<_> = errors.iter().map(|problem| problem.code).collect();
            assert_eq!(codes, [code], "{header}");
            assert!(errors[0].help.is_some(), "{header}");
        }
    }
    assert_eq!(setup(sprites, "").header("no_players=x").problems(&PAIR), ["wrong-type"]);
}

/// `obs=` enables path finding, even if it names nothing that exists. The directions of paths are fixed at the start.
#[test]
fn path_finding_is_switched_on() {
    let sprites = "a > Immovable\nc > PathChaser stype=a\nhero > AimedAvatar stype=a\navatar > MovingAvatar";
    let rules = "hero a > transformTo stype=avatar";
    let placed = [("a", 20, 20), ("c", 40, 40), AVATAR];
    let end = |header: &str| setup(sprites, rules).header(header).place(&placed).wait().state.outcome();
    assert_eq!(end(""), Outcome::Stopped(Limit::NoPaths));
    assert_eq!(end("obs=5"), Outcome::Stopped(Limit::NoPaths), "a number is no list");
    assert_eq!(end("obs=nothing"), Outcome::Ongoing);
    // If the avatar has three actions at the start, paths go left and right only, whatever the avatar
    // becomes.
    let placed = [("a", 20, 20), ("hero", 20, 20), ("c", 40, 40)];
    let mut board = setup(sprites, rules).header("obs=wall").place(&placed);
    board.play("...");
    assert_eq!((board.count("avatar"), board.at("c")), (1, (40, 40)));
}

/// K-44, K-45: the first row sets the width of a level, and each character without a mapping causes a
/// message.
#[test]
fn rows_and_characters() {
    let source = "BasicGame\n  SpriteSet\n    a > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    abc > a\n    x b\n    y b ghost\n    z > a\n    z > a a\n";
    let game = Game::from_source_as_reference(source).unwrap();
    let load = |text: &str| {
        let level = game.level(text).unwrap();
        let state = game.start_with(&level, Chance::from_java(1));
        (level.columns(), level.rows(), game.records(&state).len(), state.messages())
    };
    assert_eq!(load("A a\naaaaa\n\n"), (3, 3, 5, 0));
    assert_eq!(load("Axz\nb\tA\n"), (3, 2, 3, 2 + 1));
    assert_eq!(load("A\r\nw\ra"), (1, 3, 3, 0));
    let problems = game.level("Ay\n").unwrap_err();
    assert_eq!(problems.0[0].code, "unknown-sprite", "the reference crashes on it");
    let mut board = Board { state: game.start_with(&game.level("A").unwrap(), Chance::from_java(1)), game };
    assert_eq!(board.game.step(&mut board.state, Action::Nil), Outcome::Ongoing);
}

/// Sections may come in a different order, and may be repeated (`spec/01` §1.4).
#[test]
fn the_order_of_sections() {
    let head = "BasicGame\n";
    let sprites = "  SpriteSet\n    a > Immovable\n    avatar > MovingAvatar\n";
    let rules = "  InteractionSet\n    avatar a > halfSpeed scoreChange=1\n";
    let fault = "  InteractionSet\n    avatar a > explode\n";
    let mapping = "  LevelMapping\n    a > a avatar\n";
    let end = "  TerminationSet\n    Timeout limit=0 win=True\n";
    let play = |parts: &[&str]| {
        let game = Game::from_source_as_reference(&parts.concat()).map_err(|problems| problems.0[0].code)?;
        let level = game.level("a\n").map_err(|problems| problems.0[0].code)?;
        let mut state = game.start_with(&level, Chance::from_java(1));
        game.step(&mut state, Action::Nil);
        Ok::<_, &str>((state.score(), state.outcome(), state.messages()))
    };
    use Outcome::{Ongoing, Won};
    assert_eq!(play(&[head, mapping, end, sprites, rules]), Ok((1.0, Won, 0)));
    assert_eq!(play(&[head, sprites, mapping, rules, rules, end, end]), Ok((2.0, Won, 0)));
    assert_eq!(play(&[head, sprites, mapping, rules, fault, end]), Ok((1.0, Ongoing, 1)));
    assert_eq!(play(&[head, rules, sprites, mapping]), Err("missing-section"));
    assert_eq!(play(&[head, "  InteractionSet\n", sprites, mapping, end]), Ok((0.0, Won, 0)));
    let count = "  TerminationSet\n    SpriteCounter stype=a win=True\n";
    assert_eq!(play(&[head, count, sprites, mapping, rules]), Err("missing-section"));
    // The built-in types are known from the start and, without a mapping, so are their characters.
    let count = "  TerminationSet\n    SpriteCounter stype=wall win=True\n";
    assert_eq!(play(&[head, count, sprites, mapping, rules]), Ok((1.0, Won, 0)));
    assert_eq!(
        play(&[head, sprites, fault, mapping, end]),
        Ok((0.0, Ongoing, 2 + 1 + 1)),
        "no avatar, and an `a` unknown"
    );
}

/// The player's avatar is updated whatever its type. Other sprites of avatar classes are not updated.
#[test]
fn avatars_made_in_play() {
    let sprites = "hero > MovingAvatar\n  knight > MovingAvatar\na > Immovable\nlog > Missile orientation=RIGHT\navatar > MovingAvatar";
    let rules = "avatar a > transformTo stype=hero\nhero wall > stepBack";
    let placed = [("a", 20, 20), ("avatar", 20, 20), ("wall", 50, 20)];
    let mut board = setup(sprites, rules).place(&placed);
    let places: Vec<i32> = ".RRRR"
        .chars()
        .map(|key| board.play(&key.to_string()).state.avatar_id().map_or(0, |_| board.at("hero").0))
        .collect();
    assert_eq!(places, [20, 30, 40, 40, 40], "back to where it was a tick ago, not where it came about");
    // A second avatar does not age, so nothing carries it.
    let rules = "a avatar > spawn stype=knight\na avatar > killSprite\nknight log > pullWithIt scoreChange=1";
    let mut board = setup(sprites, rules).place(&[("a", 20, 20), ("avatar", 20, 20), ("log", 0, 20)]);
    board.play("...U");
    assert_eq!((board.one("knight").rect.x, board.score()), (20, 1), "the log came and went");
}
