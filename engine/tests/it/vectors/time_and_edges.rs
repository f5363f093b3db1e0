//! Tests timed effects, effects at the edge, and the messages that they cause (`spec/03` §4.4, §4.6, §6,
//! §14).

use crate::board::setup;
use engine::{Limit, Outcome};

const AVATAR: (&str, i32, i32) = ("avatar", 0, 50);

/// Q1, K-17: the effect runs at tick 0, whatever the timer says. After that, the effect never runs again, or
/// runs periodically.
#[test]
fn lines_with_time_run_at_tick_0() {
    let sprites = "box > Immovable\nball > Immovable\navatar > MovingAvatar";
    let mut board =
        setup(sprites, "box TIME > transformTo stype=ball timer=3").place(&[("box", 20, 20), AVATAR]);
    board.wait();
    assert_eq!((board.count("box"), board.count("ball")), (0, 1));

    let mut board = setup(sprites, "box TIME > flipDirection timer=3 repeating=True scoreChange=1")
        .place(&[("box", 20, 20), AVATAR]);
    let scores: Vec<i32> = (0..8).map(|_| board.wait().score()).collect();
    assert_eq!(scores, [1, 1, 1, 2, 2, 2, 3, 3]);

    let mut board = setup(sprites, "box TIME > flipDirection timer=2 scoreChange=1 nextExecution=2.0")
        .place(&[("box", 20, 20), AVATAR]);
    assert_eq!(board.play("....").score(), 1, "a number with a point is no number of ticks");
}

/// Q2: `nextExecution` only means that the first run comes after the timer.
#[test]
fn a_first_run_later() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    for next in ["7", "0", "-2"] {
        let rule = format!("a TIME > killAll stype=a timer=2 nextExecution={next}");
        let mut board = setup(sprites, &rule).place(&[("a", 20, 20), AVATAR]);
        let there: Vec<usize> = (0..4).map(|_| board.wait().count("a")).collect();
        assert_eq!(there, [1, 1, 0, 0], "{next}");
    }
}

/// Q4: among the effects due in the same tick, the effect scheduled last runs first, so the order reverses
/// each time.
#[test]
fn equal_times_alternate() {
    let sprites = "a > Immovable\nx > Immovable\ny > Immovable\nz > Immovable\navatar > MovingAvatar";
    let rules = "a TIME > spawn stype=x timer=2 repeating=True\na TIME > spawn stype=y timer=2 repeating=True\na TIME > spawn stype=z timer=2 repeating=True";
    let mut board = setup(sprites, rules).place(&[("a", 20, 20), AVATAR]);
    board.play(".....");
    let ids = ["x", "y", "z"].map(|name| board.ids(name));
    assert_eq!(ids, [[4, 5, 10], [3, 6, 9], [2, 7, 8]]);
}

/// Q5: the reference never returns from such a timer, which is an error in strict mode.
#[test]
fn timers_without_end() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    for rule in ["a TIME > flipDirection repeating=True", "b TIME > killAll stype=b repeating=True timer=0"] {
        let setting = setup(sprites, rule);
        assert_eq!(setting.problems(&[("a", 20, 20), AVATAR]), ["endless-timer"]);
        let mut board = setting.place(&[("a", 20, 20), AVATAR]);
        assert_eq!(board.wait().state.outcome(), Outcome::Stopped(Limit::Work), "{rule}");
    }
}

/// Q6: addTimer scores when it schedules the effect and when the effect runs, but counts once.
#[test]
fn add_timer_scores_twice() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    let rule = "a avatar > addTimer timer=2 ftype=killAll stype=b scoreChange=5 counter=1,1";
    let mut board = setup(sprites, rule).header("no_counters=1").place(&[
        ("a", 20, 20),
        ("b", 50, 20),
        ("avatar", 10, 20),
    ]);
    board.play("RR");
    assert_eq!((board.score(), board.state.counters(), board.count("b")), (5, &[1][..], 1));
    board.wait();
    assert_eq!((board.score(), board.state.counters(), board.count("b")), (10, &[1][..], 0));
}

/// `spec/03` §6.4: each meeting schedules the effect again. If the timer is below 1, the effect is scheduled
/// for the next tick.
#[test]
fn add_timer_plans_at_every_meeting() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    let rule = "a avatar > addTimer ftype=setSpeedForAll stype=a value=3 scoreChange=1";
    let mut board = setup(sprites, rule).place(&[("a", 20, 20), ("avatar", 20, 20)]);
    let scores: Vec<i32> = (0..3).map(|_| board.wait().score()).collect();
    assert_eq!((scores, board.one("a").speed), (vec![1, 3, 5], 3.0));
}

/// `spec/03` §6.4: an effect that needs sprites only logs a message, or crashes the reference.
#[test]
fn planned_effects_that_need_sprites() {
    let sprites = "a > Immovable\nb > Immovable healthPoints=5\nspawner > SpawnPoint stype=b\nnone > Immovable\navatar > MovingAvatar";
    let planned = |ftype: &str| {
        let rule = format!("a avatar > addTimer timer=1 ftype={ftype} scoreChange=1");
        let mut board = setup(sprites, &rule).place(&[
            ("a", 20, 20),
            ("b", 50, 20),
            ("avatar", 10, 20),
            ("spawner", 80, 20),
        ]);
        board.play("R");
        assert_eq!((board.messages(), board.died()), (0, false), "{ftype}");
        board.play("R");
        (board.messages(), board.died())
    };
    for ftype in ["killSprite", "stepBack", "subtractHealthPoints", "spawn stype=b", "wallStop", "killBoth"] {
        assert_eq!(planned(ftype), (1, false), "{ftype}");
    }
    for ftype in ["undoAll", "transformToAll stype=b stypeTo=none", "subtractHealthPoints stype=b"] {
        assert_eq!(planned(ftype), (0, false), "{ftype}");
    }
    let deadly = [
        "killIfNotUpright",
        "waterPhysics",
        "subtractHealthPoints stype=none",
        "updateSpawnType stype=b spawnPoint=spawner",
    ];
    for ftype in deadly {
        assert!(planned(ftype).1, "{ftype}");
    }
    assert!(!planned("updateSpawnType stype=b spawnPoint=b").1, "nothing to update");
}

/// Q7, K-18: the score of a line with TIME is the line's own, whatever its effect does.
#[test]
fn timed_effects_ignore_score_parameters() {
    let sprites = "r > Resource limit=9\na > Immovable healthPoints=1\navatar > MovingAvatar";
    let rule = "avatar TIME > killIfHasMore resource=r limit=5 scoreChange=1";
    let mut board = setup(sprites, rule).place(&[AVATAR]);
    assert_eq!((board.wait().score(), board.one("avatar").flags & 1), (1, 0));
    let rule = "a TIME > subtractHealthPoints scoreChange=3 scoreChangeIfKilled=100";
    let mut board = setup(sprites, rule).place(&[("a", 20, 20), AVATAR]);
    assert_eq!((board.wait().score(), board.count("a")), (3, 0));
}

/// `spec/03` §6.3: the effect runs once per sprite, except for killed and disabled sprites. The same holds
/// for counters.
#[test]
fn timed_effects_run_on_every_sprite_of_the_tree() {
    let sprites = "all >\n  a > Immovable\n  b > Immovable\navatar > MovingAvatar";
    let rules =
        "all TIME > flipDirection scoreChange=1 counter=1,0 counterElse=10,0\nall TIME > killAll stype=a";
    let placed = [("a", 20, 20), ("a", 30, 20), ("b", 40, 20), AVATAR];
    let mut board = setup(sprites, rules).header("no_counters=2").place(&placed);
    // First all sprites of type `a` are killed. Then the effect runs once for each sprite of the tree that is not dead.
    board.wait();
    assert_eq!((board.score(), board.state.counters()), (1, &[11, 0][..]));
}

/// Q8, K-16: if a type has n lines, each line runs n times.
#[test]
fn edge_lines_multiply() {
    let sprites = "a > Missile orientation=LEFT\navatar > MovingAvatar";
    let two = "a EOS > flipDirection scoreChange=10\na EOS > halfSpeed scoreChange=10";
    let mut board = setup(sprites, two).place(&[("a", 0, 20), AVATAR]);
    assert_eq!(board.play("..").score(), 40);
    let three = "a EOS > halfSpeed scoreChange=1\nEOS a > halfSpeed scoreChange=10\na EOS > halfSpeed scoreChange=100";
    let mut board = setup(sprites, three).place(&[("a", 0, 20), AVATAR]);
    assert_eq!(board.play("..").score(), 333);
    // A disabled line counts as a line.
    let mut board =
        setup(sprites, &two.replace("halfSpeed", "halfSpeed enabled=False")).place(&[("a", 0, 20), AVATAR]);
    assert_eq!(board.play("..").score(), 20);
    // `repeat` has no effect.
    let mut board = setup(sprites, "a EOS > halfSpeed repeat=5 scoreChange=1").place(&[("a", 0, 20), AVATAR]);
    assert_eq!(board.play("..").score(), 1);
}

/// Q9: spawning into the group being visited ends the visit, with a message.
#[test]
fn spawning_at_the_edge() {
    let sprites = "a > Missile orientation=LEFT\nb > Immovable\navatar > MovingAvatar";
    let placed = [("a", 0, 10), ("a", 0, 20), AVATAR];
    let mut board = setup(sprites, "a EOS > cloneSprite scoreChange=1").place(&placed);
    board.play("..");
    assert_eq!((board.count("a"), board.score(), board.messages()), (3, 1, 1));
    let mut board = setup(sprites, "a EOS > spawn stype=b scoreChange=1").place(&placed);
    board.play("..");
    assert_eq!((board.count("b"), board.score(), board.messages()), (2, 2, 0));
}

/// Q10: in the time phase, the reference crashes.
#[test]
fn spawning_by_the_clock() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    assert!(setup(sprites, "a TIME > cloneSprite").place(&[("a", 20, 20), AVATAR]).wait().died());
    let mut board = setup(sprites, "a TIME > spawn stype=b").place(&[("a", 20, 20), AVATAR]);
    assert_eq!((board.wait().died(), board.count("b")), (false, 1));
}

/// Q11: at the edge, an undeclared sprite stops the game in the first tick. In a timed effect, an undeclared
/// sprite stands for no sprite.
#[test]
fn undeclared_partners_of_edge_and_clock() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    for rule in
        ["nope EOS > killSprite", "EOS nope > killSprite", "EOS EOS > killSprite", "TIME EOS > killSprite"]
    {
        let mut board = setup(sprites, rule).place(&[("a", 20, 20), AVATAR]);
        assert_eq!((board.messages(), board.wait().died()), (1, true), "{rule}");
    }
    for rule in ["nope TIME > killAll stype=a", "TIME nope > killAll stype=a", "TIME time > killAll stype=a"]
    {
        let mut board = setup(sprites, &format!("{rule} scoreChange=1 counter=1,1"))
            .header("no_counters=1")
            .place(&[("a", 20, 20), AVATAR]);
        board.wait();
        assert_eq!((board.count("a"), board.score(), board.state.counters()), (0, 1, &[0][..]), "{rule}");
    }
}

/// Q12, K-15: the 26th message ends the game without a winner.
#[test]
fn too_many_messages() {
    let sprites = "avatar > MovingAvatar";
    let mut board = setup(sprites, "avatar EOS > killBoth scoreChange=1").place(&[AVATAR]);
    board.play("L");
    for messages in 2..=25 {
        board.wait();
        assert_eq!((board.messages(), board.state.outcome()), (messages, Outcome::Ongoing));
    }
    board.wait();
    assert_eq!((board.messages(), board.state.outcome(), board.score()), (0, Outcome::Ended, 26));
}

/// K-19: TIME on the left applies only to the first partner, once. If TIME is first on the right, the other
/// names are separate pairs.
#[test]
fn time_and_several_partners() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    let placed = [("a", 20, 20), ("b", 20, 20), AVATAR];
    let mut board = setup(sprites, "TIME a b > killSprite repeat=3 scoreChange=1").place(&placed);
    board.wait();
    assert_eq!((board.count("a"), board.count("b"), board.score()), (0, 1, 1));
    let mut board = setup(sprites, "b TIME a > halfSpeed scoreChange=1").place(&placed);
    let scores: Vec<i32> = (0..3).map(|_| board.wait().score()).collect();
    assert_eq!(scores, [2, 3, 4], "by the clock at tick 0, and at every meeting");
    // In any other position, TIME ends the reading, and the partners before it count.
    let rules = "a b TIME > halfSpeed scoreChange=1\nb a > halfSpeed scoreChange=10";
    let setting = setup(sprites, rules);
    assert_eq!(setting.problems(&placed), ["bad-interaction"]);
    let mut board = setting.place(&placed);
    assert_eq!((board.messages(), board.wait().score()), (1, 1));
}

/// A sprite named EOS is a sprite (K-46). The case of EOS and TIME does not matter.
#[test]
fn edge_and_time_in_any_case() {
    let sprites = "a > Missile orientation=LEFT\nEOS > Immovable\navatar > MovingAvatar";
    let mut board = setup(sprites, "a EOS > killSprite").place(&[("a", 0, 20), ("EOS", 50, 20), AVATAR]);
    assert_eq!(board.play("...").count("a"), 1);
    let sprites = "a > Missile orientation=LEFT\navatar > MovingAvatar";
    assert_eq!(setup(sprites, "a eOs > killSprite").place(&[("a", 0, 20), AVATAR]).play("..").count("a"), 0);
    assert_eq!(setup(sprites, "a tImE > killSprite").place(&[("a", 0, 20), AVATAR]).play(".").count("a"), 0);
}

/// The score of an avatar that has been removed permanently cannot change.
#[test]
fn scoring_without_an_avatar() {
    let sprites = "trap > Immovable\nbox > Immovable\navatar > MovingAvatar";
    let rule = "trap avatar > transformTo stype=box killSecond=True";
    let placed = [("trap", 20, 20), ("avatar", 10, 20)];
    let mut board = setup(sprites, rule).place(&placed);
    board.play("R");
    assert_eq!((board.state.avatar_id(), board.count("avatar"), board.count("box")), (None, 0, 1), "Q26");
    assert!(!board.play("....").died());
    let rules = format!("{rule}\nbox TIME > killSprite timer=5 nextExecution=1");
    let mut board = setup(sprites, &rules).place(&placed);
    assert!(!board.play("R....").died());
    assert!(board.wait().died());
    let quiet = format!("{rules} applyScore=False");
    assert!(!setup(sprites, &quiet).place(&placed).play("R.......").died());
}
