//! Tests the quirks of effects in the specification (`spec/03` §14), by number, and vectors for effects that
//! no public game uses.

use crate::board::{Board, setup};
use engine::{Limit, Outcome};

const AVATAR: (&str, i32, i32) = ("avatar", 0, 50);
/// The position of the avatar and of the sprites that it overlaps.
const HERE: (i32, i32) = (50, 20);

/// Returns a board with these sprites on top of the avatar, in this order, from the start.
#[track_caller]
fn heap(sprites: &str, rules: &str, names: &[&str]) -> Board {
    let placed: Vec<_> = names.iter().map(|name| (*name, HERE.0, HERE.1)).collect();
    setup(sprites, rules).place(&placed)
}

/// Q13: the file is not read beyond an unknown keyword.
#[test]
fn an_unknown_keyword_ends_the_reading() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    let rules = "a avatar > explode\na avatar > killSprite scoreChange=1";
    let mut board = heap(sprites, rules, &["a", "avatar"]);
    assert_eq!((board.messages(), board.wait().score(), board.count("a")), (1, 0, 1));
}

/// Q13: an effect without a required sprite also ends the reading, but effects with optional sprites do not.
#[test]
fn names_that_effects_need() {
    let sprites = "a > Immovable\nr > Resource\nsp > SpawnPoint stype=a prob=0\navatar > MovingAvatar";
    let fails = |effect: &str| {
        let rules = format!("a avatar > {effect}\na avatar > halfSpeed scoreChange=1");
        heap(sprites, &rules, &["a", "avatar"]).messages() == 1
    };
    let needing = [
        "killAll",
        "killAll stype=x",
        "killAll stype=RED",
        "killAll stype=7",
        "killAll stype=true",
        "killAll stype=1d",
        "killAll stype=NaN",
        "killIfHasLess",
        "killIfHasMore resource=x",
        "spawn stype=x",
        "spawnBehind",
        "spawnIfHasLess resource=r stype=x",
        "spawnIfHasMore resource=x stype=a",
        "spawnIfCounterSubTypes stype=a estype=a",
        "transformTo",
        "transformTo stype=x",
        "transformToRandomChild stype=x",
        "transformIfCount stype=x stypeCount=a",
        "transformIfCount stype=a",
        "transformToAll stype=a",
        "transformToAll stype=a stypeTo=x",
        "transformToSingleton stype=a stype_other=x",
        "increaseSpeedToAll",
        "setSpeedForAll stype=x",
        "shieldFrom ftype=killSprite",
        "shieldFrom stype=a",
        "updateSpawnType stype=a",
        "updateSpawnType stype=a spawnPoint=x",
        "subtractHealthPoints stype=x",
        "spawnAbove",
        "changeResource",
        "killIfOtherHasMore",
        "collectResourceIfHeld",
        "addTimer",
        "addTimer ftype=explode",
        "addTimer ftype=killAll",
        "addTimer ftype=addTimer",
    ];
    for effect in needing {
        assert!(fails(effect), "{effect}");
    }
    let content = [
        "removeScore stype=x",
        "undoAll notStype=x,a",
        "shieldFrom stype=a ftype=explode",
        "spawnAbove stype=x prob=0",
        "killIfOtherHasMore resource=x limit=1",
        "collectResourceIfHeld heldResource=x",
        "transformIfCount stype=a stypeCount=a geq=9 estype=x leq=10",
        "subtractHealthPoints stype=7",
    ];
    for effect in content {
        assert!(!fails(effect), "{effect}");
    }
}

/// `spec/03` §2.2: checks the consequences of names that become an invalid type.
#[test]
fn undeclared_names_die_when_they_are_used() {
    let sprites = "a > Immovable\nr > Resource\navatar > MovingAvatar";
    let dies = |rule: &str| heap(sprites, rule, &["a", "r", "avatar"]).wait().died();
    for effect in ["spawnAbove", "spawnBelow", "spawnLeft", "spawnRight"] {
        assert!(dies(&format!("a avatar > {effect} stype=x")), "{effect}");
        assert!(!dies(&format!("a avatar > {effect} stype=x prob=0")), "{effect}");
    }
    assert!(dies("a avatar > transformIfCount stype=r stypeCount=x"));
    assert!(dies("a avatar > transformIfCount stype=r stypeCount=a geq=2 estype=x"));
    assert!(!dies("a avatar > transformIfCount stype=r stypeCount=a geq=1 estype=x"));
    assert!(dies("avatar a > changeResource resource=x"));
    assert!(!dies("avatar EOS > changeResource resource=x"));
    // No sprite holds any of the resource.
    let kills = |limit: i32| {
        let rule = format!("a avatar > killIfOtherHasMore resource=x limit={limit} subtract=True");
        let mut board = heap(sprites, &rule, &["a", "avatar"]);
        board.wait();
        (board.count("a"), board.held())
    };
    assert_eq!(kills(1), (1, vec![]));
    assert_eq!(kills(0), (0, vec![("#-1".to_owned(), 0)]));
    assert_eq!(kills(-3), (0, vec![("#-1".to_owned(), 3)]));
    let collects = |value: i32| {
        let rule = format!("r avatar > collectResourceIfHeld heldResource=x value={value}");
        heap(sprites, &rule, &["r", "avatar"]).wait().held()
    };
    assert_eq!(collects(1), []);
    assert_eq!(collects(0), [("r".to_owned(), 1)]);
}

/// Q14: most effects ignore `prob`, and all other effects always draw.
#[test]
fn probabilities() {
    let sprites = "a > Immovable\nb > Immovable\navatar > OrientedAvatar";
    let mut board = heap(sprites, "a avatar > killSprite prob=0", &["a", "avatar"]);
    assert_eq!((board.wait().count("a"), board.draws(1)), (0, 0));
    let cases = [
        ("spawn stype=b prob=0", 2),
        ("spawn stype=b", 2),
        ("spawnAbove stype=b", 2),
        ("spawnBehind stype=b", 2),
        ("spawnIfHasMore resource=b stype=b limit=1", 2),
        ("spawnIfHasLess resource=b stype=b", 2),
        ("attractGaze", 0),
        ("flipDirection", 1),
        ("spawnIfCounterSubTypes stype=b estype=b stypeCount=b", 0),
        ("cloneSprite", 0),
        ("transformTo stype=b", 0),
        ("transformToRandomChild stype=a", 0),
    ];
    for (effect, draws) in cases {
        let mut board = heap(sprites, &format!("a avatar > {effect}"), &["a", "avatar"]);
        assert_eq!(board.wait().draws(1), draws, "{effect}");
    }
    let mut board = heap(sprites, "avatar avatar2 > attractGaze prob=0", &["avatar"]);
    assert_eq!(board.wait().draws(1), 0);
    let sprites = "a > Missile orientation=UP speed=0\navatar > OrientedAvatar";
    let mut board = heap(sprites, "avatar a > attractGaze prob=0", &["a", "avatar"]);
    assert_eq!((board.wait().draws(1), board.one("avatar").orientation), (2, (1.0, 0.0)));
    let mut board = heap(sprites, "avatar a > attractGaze", &["a", "avatar"]);
    assert_eq!(board.wait().one("avatar").orientation, (0.0, -1.0));
}

/// Q15: values of a wrong type are ignored in reference mode, and are errors in strict mode.
#[test]
fn values_of_a_wrong_type() {
    let sprites = "a > Immovable healthPoints=9\navatar > MovingAvatar";
    for rule in
        ["a avatar > subtractHealthPoints value=0.5", "a avatar > addHealthPoints value=-1 killSecond=1"]
    {
        let setting = setup(sprites, rule);
        assert_eq!(setting.problems(&[("a", 20, 20), ("avatar", 20, 20)]), ["wrong-type"]);
        let mut board = setting.place(&[("a", 20, 20), ("avatar", 20, 20)]);
        assert_eq!((board.wait().one("a").health, board.one("avatar").flags & 1), (8, 0), "{rule}");
    }
}

/// Q16: a killed first sprite is skipped, but a killed second sprite is not.
#[test]
fn the_dead_still_collide() {
    let sprites = "a > Immovable\navatar > MovingAvatar healthPoints=1";
    let rules = "a avatar > killSprite\navatar a > addHealthPoints\na avatar > cloneSprite";
    let mut board = heap(sprites, rules, &["a", "avatar"]);
    board.wait();
    assert_eq!((board.one("avatar").health, board.count("a")), (2, 0));
}

/// Q17, K-22: a killed avatar stays, and continues to collide and score.
#[test]
fn a_killed_avatar_still_collides() {
    let sprites = "a > Immovable\navatar > MovingAvatar healthPoints=1";
    let mut board = heap(
        sprites,
        "avatar a > subtractHealthPoints scoreChange=1 scoreChangeIfKilled=5",
        &["a", "avatar"],
    );
    board.play("...");
    let avatar = board.one("avatar");
    assert_eq!((board.score(), avatar.health, avatar.flags), (15, -2, 3));
}

/// Q18, K-48: the limit of 10,000 sprites applies to a counter that decreases twice for a sprite that is killed twice.
#[test]
fn killing_twice_counts_twice() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    let rules = "a avatar > killSprite\nb a > killBoth";
    let twice =
        heap(sprites, rules, &["a", "b", "avatar"]).wait().state.search_key(&heap(sprites, rules, &[]).game);
    let rules = "a avatar > killSprite\nb avatar > killSprite";
    let once =
        heap(sprites, rules, &["a", "b", "avatar"]).wait().state.search_key(&heap(sprites, rules, &[]).game);
    assert_ne!(twice, once, "the counter is part of the state");
}

/// Q19, K-47: shields cover exact types, all their sprites, and later lines only.
#[test]
fn shields() {
    let sprites = "bugs >\n  bug > Immovable\n  bee > Immovable\nnet > Immovable\nleaf > Immovable\navatar > MovingAvatar";
    let placed = [
        ("bug", 20, 20),
        ("net", 20, 20),
        ("leaf", 20, 20),
        ("bug", 40, 20),
        ("net", 40, 20),
        ("bee", 60, 20),
        ("net", 60, 20),
        AVATAR,
    ];
    let left = |rules: &str| {
        let mut board = setup(sprites, rules).place(&placed);
        board.wait();
        [board.count("bug"), board.count("bee")]
    };
    let shield = "bug leaf > shieldFrom stype=net ftype=killSprite";
    assert_eq!(
        left(&format!("{shield}\nbug net > killSprite\nbee net > killSprite")),
        [2, 0],
        "one shields all"
    );
    assert_eq!(left(&format!("{shield}\nbugs net > killSprite")), [0, 0], "not those of the parent's line");
    assert_eq!(left(&format!("bug net > killSprite\n{shield}")), [0, 1], "not from earlier lines");
    assert_eq!(left(&format!("{shield}\nbug net > killBoth")), [0, 1], "not from other effects");
    assert_eq!(
        left(&format!("bug net > halfSpeed\n{shield}\nbug net > killSprite")),
        [0, 1],
        "the pair is earlier"
    );
}

/// Q20, Q21, K-7, K-8: a sprite of a parent type belongs to all its children, and is never updated.
#[test]
fn sprites_of_parent_types() {
    let sprites = "seed > Immovable\nmob > Missile orientation=RIGHT\n  kid > Missile\n  cub > Missile\navatar > MovingAvatar";
    let rules = "seed avatar > transformTo stype=mob\nkid avatar > halfSpeed scoreChange=1\ncub avatar > halfSpeed scoreChange=10\nmob avatar > halfSpeed scoreChange=100";
    let mut board = heap(sprites, rules, &["seed", "avatar"]);
    board.play("...");
    assert_eq!((board.at("mob"), board.score()), (HERE, 333));
    let mut counted = setup(sprites, "seed avatar > transformTo stype=mob")
        .ends("SpriteCounterMore stype=kid limit=1 win=True")
        .place(&[("seed", 20, 20), ("avatar", 20, 20)]);
    assert_eq!(counted.wait().state.outcome(), Outcome::Won);
}

/// Q22: effects on exactly one type do not affect its children.
#[test]
fn exact_groups() {
    let sprites = "mob >\n  kid > Immovable\nexit > Portal stype=mob\nx > Immovable\navatar > MovingAvatar";
    for rule in [
        "avatar kid > killAll stype=mob",
        "avatar kid > transformToAll stype=mob stypeTo=x",
        "avatar kid > removeScore stype=mob",
    ] {
        let mut board = heap(sprites, rule, &["kid", "avatar"]);
        assert_eq!(board.wait().count("kid"), 1, "{rule}");
    }
    // A portal to an empty group is deadly.
    let mut board = heap(sprites, "kid exit > teleportToExit", &["kid", "exit", "avatar"]);
    assert_eq!((board.wait().count("kid"), board.draws(1)), (0, 0));
}

/// Q23: a random child may be an ancestor. An ancestor without a class causes a message.
#[test]
fn random_children() {
    let sprites = "grand >\n  mob > Immovable\n    kid > Immovable\navatar > MovingAvatar\nx > Immovable";
    let placed: Vec<_> = (0..10).map(|column| ("x", 10 * column, 20)).chain([("avatar", 0, 50)]).collect();
    let mut board = setup(sprites, "x TIME > transformToRandomChild stype=mob").place(&placed);
    board.wait();
    let seen = [board.count("x"), board.count("kid"), board.count("mob")];
    assert_eq!((seen[0] + seen[1], seen[2], board.messages() as usize), (10, 0, seen[0]));
    assert_eq!(board.draws(1), 10);
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
    // For a type without relatives, nothing happens and nothing is drawn.
    let mut board = heap(sprites, "avatar x > transformToRandomChild stype=x", &["x", "avatar"]);
    assert_eq!((board.wait().draws(1), board.count("avatar")), (0, 1));
}

/// Q24: health is passed on, even if it is 0. The new type keeps its own maximum.
#[test]
fn transformed_health() {
    let sprites =
        "a > Immovable\nb > Immovable healthPoints=7\nc > Immovable healthPoints=9\navatar > MovingAvatar";
    let mut board =
        heap(sprites, "a avatar > transformTo stype=b\nc avatar > transformTo stype=b", &["a", "avatar"]);
    assert_eq!(board.wait().one("b").health, 0);
    let mut board = heap(sprites, "c avatar > transformTo stype=b", &["c", "avatar"]);
    assert_eq!(board.wait().one("b").health, 9);
    // transformToSingleton does not pass on health.
    let mut board = heap(sprites, "c avatar > transformToSingleton stype=b stype_other=a", &["c", "avatar"]);
    assert_eq!(board.wait().one("b").health, 7);
}

/// Q25: an avatar that turns into something else is disabled, and the new sprite appears.
#[test]
fn an_avatar_that_turns_into_a_thing() {
    let sprites = "trap > Immovable\ncorpse > Immovable\navatar > MovingAvatar";
    let mut board =
        heap(sprites, "avatar trap > transformTo stype=corpse scoreChange=1", &["trap", "avatar"]);
    board.wait();
    assert_eq!((board.count("corpse"), board.one("avatar").flags, board.state.avatar_id()), (1, 3, Some(1)));
    // The avatar is not transformed again, but still scores.
    board.wait();
    assert_eq!((board.count("corpse"), board.score()), (1, 2));
}

/// Q26: `killResource` removes an avatar permanently.
#[test]
fn an_avatar_taken_away() {
    let sprites = "a > Immovable\ngem > Resource\navatar > MovingAvatar";
    let mut board =
        heap(sprites, "a avatar > changeResource resource=gem killResource=True", &["a", "avatar"]);
    board.wait();
    assert_eq!(
        (board.count("avatar"), board.state.avatar_id(), board.one("a").resources),
        (0, None, vec![(3, 1)])
    );
    assert!(board.wait().state.outcome() == Outcome::Ongoing);
}

/// Q27: an effect on all sprites of a type also changes killed sprites.
#[test]
fn the_dead_are_transformed_with_the_rest() {
    let sprites = "pill > Immovable\nghost > Immovable\navatar > MovingAvatar\nhero > MovingAvatar";
    let rules = "avatar ghost > killSprite\nghost TIME > transformToAll stype=avatar stypeTo=hero timer=2 nextExecution=1";
    let mut board = heap(sprites, rules, &["ghost", "avatar"]);
    board.play("..");
    assert_eq!(board.one("avatar").flags & 1, 1);
    board.play(".");
    assert_eq!((board.count("avatar"), board.one("hero").flags, board.state.avatar_id()), (0, 2, Some(2)));
    board.play("R");
    assert_eq!(board.at("hero").0, HERE.0 + 10, "it is the player's");
    // Two transformations in a tick turn one sprite into two.
    let sprites = "a > Immovable\nb > Immovable\nx > Immovable\ny > Immovable\navatar > MovingAvatar";
    let rules = "avatar x > transformToAll stype=a stypeTo=b\navatar y > transformToAll stype=a stypeTo=b";
    assert_eq!(heap(sprites, rules, &["a", "x", "y", "avatar"]).wait().count("b"), 2);
    let rules = "x avatar > transformToSingleton stype=a stype_other=b\ny avatar > transformToSingleton stype=a stype_other=b";
    let mut board = heap(sprites, rules, &["a", "x", "y", "avatar"]);
    board.wait();
    // The first rule turns the old singleton into a b, and x itself into an a. The second rule turns both
    // listed sprites into a b again.
    assert_eq!((board.count("a"), board.count("b")), (1, 3));
}

/// Q28: a transformation that a singleton prevents scores, but changes nothing.
#[test]
fn a_forbidden_transformation() {
    let sprites = "rock > Immovable\nmine > Immovable singleton=True\navatar > MovingAvatar";
    let mut board =
        heap(sprites, "rock avatar > transformTo stype=mine scoreChange=1", &["rock", "rock", "avatar"]);
    board.wait();
    assert_eq!((board.count("rock"), board.count("mine"), board.score()), (1, 1, 2));
    // transformToAll ignores singletons.
    let mut board =
        heap(sprites, "avatar rock > transformToAll stype=rock stypeTo=mine", &["rock", "rock", "avatar"]);
    assert_eq!(board.wait().count("mine"), 4, "each of two meetings transforms the two of them");
    // A singleton that was killed in this tick still exists (K-35).
    let rules = "mine avatar > killSprite\nrock avatar > spawn stype=mine";
    let mut board = heap(sprites, rules, &["mine", "rock", "avatar"]);
    assert_eq!(board.wait().count("mine"), 0);
    assert_eq!(board.wait().count("mine"), 1);
}

/// Q29: addHealthPoints does not reach the limit, but addHealthPointsToMax does.
#[test]
fn health_limits() {
    let sprites =
        "a > Immovable limitHealthPoints=10\navatar > MovingAvatar healthPoints=1 limitHealthPoints=10";
    let health = |effect: &str| {
        let mut board = heap(sprites, &format!("avatar a > {effect} scoreChange=1"), &["a", "avatar"]);
        (board.wait().one("avatar").health, board.score())
    };
    assert_eq!(health("addHealthPoints value=8"), (9, 1));
    assert_eq!(health("addHealthPoints value=9"), (1, 0));
    assert_eq!(health("addHealthPointsToMax value=8"), (9, 1));
    assert_eq!(health("addHealthPointsToMax value=100"), (10, 1));
    assert_eq!(health("addHealthPointsToMax value=100 applyScore=False"), (10, 1), "it says that it scores");
}

/// Q30, Q53: changeResource decreases without a limit, and increases up to the limit of types of class Resource.
#[test]
fn resource_limits() {
    let sprites = "gem > Resource limit=3\nrock > Immovable\npack > ResourcePack resource_name=gem\na > Immovable\navatar > MovingAvatar";
    let change = |effect: &str| {
        let mut board =
            heap(sprites, &format!("avatar a > changeResource scoreChange=1 {effect}"), &["a", "avatar"]);
        board.play("..");
        (board.held(), board.score())
    };
    let holds = |name: &str, amount: i32| vec![(name.to_owned(), amount)];
    assert_eq!(change("resource=gem value=-1"), (holds("gem", 0), 2));
    assert_eq!(change("resource=gem value=2"), (holds("gem", 2), 1), "no part of it");
    assert_eq!(change("resource=rock value=1"), (vec![], 0));
    assert_eq!(change("resource=rock value=0"), (holds("rock", 0), 2));
    assert_eq!(change("resource=pack value=1"), (vec![], 0));
}

/// Q31, K-31: on a sprite that is not a resource, collectResource scores as it did the last time.
#[test]
fn collecting_sprites_that_are_no_resources() {
    let sprites = "thing >\n  rock > Immovable\n  gold > Resource limit=1\navatar > MovingAvatar";
    let placed = [
        ("rock", 10, 20),
        ("gold", 20, 20),
        ("rock", 30, 20),
        ("gold", 40, 20),
        ("rock", 50, 20),
        ("avatar", 0, 20),
    ];
    let mut board = setup(sprites, "thing avatar > collectResource scoreChange=1").place(&placed);
    let mut scores = vec![0];
    for _ in 0..5 {
        scores.push(board.play("R").score());
    }
    let gained: Vec<i32> = scores.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!((gained, board.count("gold")), (vec![1, 1, 1, 0, 0], 1));
}

/// Q32: collectResourceIfHeld removes the resource even if there is no room.
#[test]
fn collecting_with_another_resource() {
    let sprites = "key > Resource limit=5\ngold > Resource limit=2 value=2\navatar > MovingAvatar";
    let rules = "key avatar > collectResource\ngold avatar > collectResourceIfHeld heldResource=key value=2 scoreChange=1";
    let placed = [
        ("gold", 10, 20),
        ("key", 20, 20),
        ("key", 30, 20),
        ("gold", 40, 20),
        ("gold", 50, 20),
        ("avatar", 0, 20),
    ];
    let mut board = setup(sprites, rules).place(&placed);
    let steps: Vec<_> = (0..5)
        .map(|_| {
            board.play("R");
            (board.count("gold"), board.score())
        })
        .collect();
    assert_eq!(steps, [(3, 0), (3, 0), (3, 0), (2, 1), (1, 1)]);
    assert_eq!(board.held(), [("gold".to_owned(), 2), ("key".to_owned(), 2)]);
}

/// Q33: with a type, the effect acts on the first sprite of the last non-empty group. Without such sprites,
/// the effect acts on the first partner.
#[test]
fn health_of_a_type() {
    let sprites = "foes >\n  e1 > Immovable healthPoints=5\n  e2 > Immovable healthPoints=5\nhit > Immovable healthPoints=5\navatar > MovingAvatar";
    let rules = "hit avatar > subtractHealthPoints stype=foes";
    let mut board = setup(sprites, rules).place(&[
        ("e2", 10, 10),
        ("e1", 20, 10),
        ("e2", 30, 10),
        ("hit", 50, 20),
        ("avatar", 50, 20),
    ]);
    board.wait();
    let health = |name: &str| board.all(name).iter().map(|record| record.health).collect::<Vec<i32>>();
    assert_eq!([health("e1"), health("e2"), health("hit")], [vec![5], vec![4, 5], vec![5]]);
    let mut board = heap(sprites, rules, &["hit", "avatar"]);
    assert_eq!(board.wait().one("hit").health, 4);
    // The reference accepts a registry number: hit is type 5.
    let mut board =
        heap(sprites, "hit avatar > subtractHealthPoints itype=5 value=2", &["hit", "hit", "avatar"]);
    board.wait();
    assert_eq!(board.all("hit").iter().map(|record| record.health).collect::<Vec<i32>>(), [1, 5]);
}

/// Q34: a killing execution has a separate score.
#[test]
fn the_score_of_the_last_blow() {
    let sprites = "a > Immovable healthPoints=3\navatar > MovingAvatar";
    let mut board = heap(
        sprites,
        "a avatar > subtractHealthPoints scoreChange=10 scoreChangeIfKilled=1000",
        &["a", "avatar"],
    );
    let scores: Vec<i32> = (0..4).map(|_| board.wait().score()).collect();
    assert_eq!(scores, [10, 20, 1020, 1020]);
}

/// Score texts that are not numbers count as 0, and cause a message each time. Names of constants do not
/// count as texts.
#[test]
fn scores_that_are_no_numbers() {
    let sprites = "a > Immovable healthPoints=2\navatar > MovingAvatar";
    let score = |text: &str| {
        let mut board = heap(sprites, &format!("a avatar > halfSpeed scoreChange={text}"), &["a", "avatar"]);
        board.play("..");
        (board.score(), board.messages())
    };
    for (text, expected) in [
        ("+2", (4, 0)),
        ("2,-1", (4, 0)),
        ("5,", (10, 0)),
        ("0.5", (0, 2)),
        (",", (0, 2)),
        (",5", (0, 2)),
        ("2x", (0, 2)),
        ("RED", (0, 0)),
        ("99999999999", (0, 2)),
    ] {
        assert_eq!(score(text), expected, "{text}");
    }
    let rule = "a avatar > subtractHealthPoints scoreChange=x scoreChangeIfKilled=y applyScore=True";
    assert_eq!(heap(sprites, rule, &["a", "avatar"]).play("...").messages(), 2);
    assert_eq!(setup(sprites, "a avatar > halfSpeed scoreChange=0.5").problems(&[AVATAR]), ["wrong-type"]);
    let (sprites, rule) =
        ("a > Immovable\navatar > MovingAvatar", "a avatar > halfSpeed scoreChange=x applyScore=False");
    assert_eq!(heap(sprites, rule, &["a", "avatar"]).wait().messages(), 0);
}

/// Q53, `spec/03` §8.2: checks a sprite that is declared to be a resource but is not a resource.
#[test]
fn limits_of_other_effects() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    let mut board = heap(sprites, "avatar a > transformToAll stype=b stypeTo=b", &["a", "b", "avatar"]);
    assert_eq!(board.wait().state.outcome(), Outcome::Stopped(Limit::EndlessTransform), "Q52");
    let mut board = heap(sprites, "avatar a > transformToAll stype=b stypeTo=b", &["a", "avatar"]);
    assert_eq!(board.wait().state.outcome(), Outcome::Ongoing);
}
