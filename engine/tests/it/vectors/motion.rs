//! Tests the quirks of effects on position and direction (`spec/03` §14, Q35–Q58), by number.

use crate::board::{Board, setup};
use engine::Outcome;

const AVATAR: (&str, i32, i32) = ("avatar", 0, 50);

/// Q35: killIfFast and killIfSlow compare directions, unless one of the two sprites is static.
#[test]
fn relative_speeds() {
    let sprites = "a > Missile orientation=RIGHT speed=0.5\nb > Missile orientation=LEFT speed=0.5\nw > Immovable\navatar > MovingAvatar";
    let survivors = |rule: &str, other: (&str, i32, i32)| {
        let mut board = setup(sprites, rule).place(&[("a", 30, 20), other, AVATAR]);
        board.play("...");
        board.count("a")
    };
    assert_eq!(survivors("a b > killIfFast limspeed=1.9", ("b", 50, 20)), 0, "2, not 1");
    assert_eq!(survivors("a b > killIfFast limspeed=2", ("b", 50, 20)), 1);
    assert_eq!(survivors("a b > killIfSlow limspeed=2.1", ("b", 50, 20)), 0);
    assert_eq!(
        survivors("a w > killIfFast limspeed=0.4", ("w", 40, 20)),
        0,
        "the speed of the one that moves"
    );
    assert_eq!(survivors("a w > killIfFast limspeed=0.5", ("w", 40, 20)), 1);
    assert_eq!(survivors("w a > killIfSlow limspeed=0.6", ("w", 40, 20)), 1);
}

/// Q36: a sprite that stands still is killed by both effects.
#[test]
fn head_on() {
    let sprites = "a > Missile orientation=RIGHT\nb > Missile orientation=LEFT\nc > Missile orientation=RIGHT speed=2\nw > Immovable\navatar > MovingAvatar";
    let dies = |effect: &str, one: (&str, i32, i32), two: (&str, i32, i32)| {
        let rule = format!("{} {} > {effect} scoreChange=1", one.0, two.0);
        let mut board = setup(sprites, &rule).place(&[one, two, AVATAR]);
        board.play("...");
        assert_eq!(board.score(), i32::from(board.count(one.0) == 0), "it scores if it kills");
        board.count(one.0) == 0
    };
    for effect in ["killIfFrontal", "killIfNotFrontal"] {
        assert!(dies(effect, ("w", 40, 20), ("a", 30, 20)), "{effect}");
    }
    assert!(dies("killIfFrontal", ("a", 30, 20), ("b", 50, 20)));
    assert!(!dies("killIfNotFrontal", ("a", 30, 20), ("b", 50, 20)));
    assert!(!dies("killIfFrontal", ("a", 40, 20), ("c", 30, 20)));
    assert!(dies("killIfNotFrontal", ("a", 40, 20), ("c", 30, 20)));
}

/// `spec/03` §8.1: a meeting from above is judged by the last positions of both sprites, and counts only
/// while the partner falls.
#[test]
fn from_above() {
    let sprites =
        "a > Immovable\nb > Missile orientation=DOWN\nup > Missile orientation=UP\navatar > MovingAvatar";
    let mut board =
        setup(sprites, "a b > killIfFromAbove scoreChange=1").place(&[("a", 30, 30), ("b", 30, 20), AVATAR]);
    board.play("..");
    assert_eq!((board.count("a"), board.score()), (0, 1));
    let mut board = setup(sprites, "a up > killIfFromAbove scoreChange=1").place(&[
        ("a", 30, 10),
        ("up", 30, 20),
        AVATAR,
    ]);
    board.play("..");
    assert_eq!((board.count("a"), board.score()), (1, 0));
}

/// Q37: a pusher that stood still takes the direction of the sprite that it pushes away.
#[test]
fn pushing_chains() {
    let sprites = "box > Passive\navatar > MovingAvatar";
    let push = |rules: &str, from: i32, key: &str| {
        let boxes = [("box", 40, 20), ("box", 50, 20), ("box", 60, 20), ("avatar", from, 20)];
        let mut board = setup(sprites, rules).place(&boxes);
        board.play(key);
        board.all("box").iter().map(|record| (record.rect.x, record.orientation)).collect::<Vec<_>>()
    };
    let (left, right, none) = ((-1.0, 0.0), (1.0, 0.0), (0.0, 0.0));
    let one = "box avatar > bounceForward";
    assert_eq!(push(one, 30, "R"), [(50, right), (50, none), (60, none)]);
    // Boxes meet in both orders. The first box stands still for its partner, and the partner is then pushed
    // on.
    let all = format!("{one}\nbox box > bounceForward");
    assert_eq!(push(&all, 30, "R"), [(50, none), (60, right), (70, right)]);
    // Against the order of creation, each pass pushes one box.
    assert_eq!(push(&all, 70, "L"), [(40, none), (40, left), (50, left)]);
    assert_eq!(push(&format!("{all} repeat=3"), 70, "L"), [(30, left), (40, left), (50, left)]);
}

/// Q38: a sprite is carried once per tick, not after a move of its own, and only by the first carrier.
#[test]
fn carried() {
    let sprites = "log > Missile orientation=RIGHT speed=0.5\navatar > MovingAvatar";
    let mut board = setup(sprites, "avatar log > pullWithIt").place(&[("log", 30, 20), ("avatar", 20, 20)]);
    board.play("R");
    assert_eq!(board.at("avatar"), (30, 20), "it moved itself");
    let places: Vec<i32> = (0..3).map(|_| board.wait().at("avatar").0).collect();
    assert_eq!(places, [35, 40, 45]);
    let mut board = setup(sprites, "avatar log > pullWithIt").place(&[
        ("log", 30, 20),
        ("log", 30, 20),
        ("avatar", 30, 20),
    ]);
    assert_eq!(board.play("..").at("avatar"), (35, 20), "by one log");
    let mut board = setup(sprites, "avatar log > pullWithIt\navatar log > pullWithIt")
        .place(&[("log", 30, 20), ("avatar", 30, 20)]);
    assert_eq!(board.play("..").at("avatar"), (35, 20), "two lines try, the second after a move");
    // The sprite is placed flush with the carrier if requested.
    let mut board = setup(sprites, "avatar log > pullWithIt pixelPerfect=True")
        .place(&[("log", 30, 20), ("avatar", 20, 20)]);
    board.play("R.");
    assert_eq!(board.at("avatar"), board.at("log"));
}

/// Q39: a sprite with continuous physics is carried in its own units, and lifted.
#[test]
fn carried_in_continuous_physics() {
    let sprites =
        "log > Missile orientation=RIGHT speed=0.5\nrider > Passive physicstype=CONT\navatar > MovingAvatar";
    let source = "BasicGame square_size=20\n  SpriteSet\n    log > Missile orientation=RIGHT speed=0.5\n    rider > Passive physicstype=CONT\n    avatar > MovingAvatar\n  LevelMapping\n    a > log\n    b > rider\n  InteractionSet\n    rider log > pullWithIt\n  TerminationSet\n    Timeout limit=99 win=True\n";
    let game = engine::Game::from_source_as_reference(source).unwrap();
    let level = game.level("A  \n   \nab \n").unwrap();
    let mut board = Board { state: game.start_with(&level, engine::Chance::from_java(1)), game };
    board.play("..");
    assert_eq!((board.at("log"), board.at("rider")), ((10, 40), (25, 20)));
    // With cells of 10 pixels, both units are the same.
    let mut board =
        setup(sprites, "rider log > pullWithIt").place(&[("log", 20, 30), ("rider", 30, 30), AVATAR]);
    assert_eq!(board.play("..").at("rider"), (35, 20));
}

/// Q40, Q41: a sprite that goes through a portal takes the exit's size, after a draw even for a single exit.
#[test]
fn portals() {
    let sprites = "entry > Portal stype=exit\nexit > Immovable wMult=2\nx > Immovable\navatar > MovingAvatar";
    let rules = "avatar entry > teleportToExit\nx avatar > spawnBehind stype=x";
    let mut board = setup(sprites, rules).place(&[
        ("entry", 30, 20),
        ("exit", 70, 20),
        ("x", 70, 20),
        ("avatar", 20, 20),
    ]);
    board.play("R");
    let rect = board.one("avatar").rect;
    assert_eq!(((rect.x, rect.w), board.draws(1)), ((70, 20), 1 + 2));
    assert_eq!(board.all("x")[1].rect.x, 20, "where it was at the start of its update");
    // A sprite that leads nowhere causes a message. A spawner leads to the type that it spawns.
    let sprites = "door > Door\nsp > SpawnPoint stype=x prob=0\nx > Immovable\ny > Immovable\nkey > Immovable\navatar > MovingAvatar";
    let mut board =
        setup(sprites, "avatar door > teleportToExit").place(&[("door", 30, 20), ("avatar", 30, 20)]);
    assert_eq!(board.wait().messages(), 1);
    let rules = "key sp > updateSpawnType stype=y spawnPoint=sp\navatar sp > teleportToExit";
    let placed = [("sp", 30, 20), ("key", 30, 20), ("x", 70, 20), ("y", 70, 40), ("avatar", 20, 20)];
    assert_eq!(setup(sprites, rules).place(&placed).play("R").at("avatar"), (70, 40));
}

/// Q42: a sprite appears beside the partner, whatever the first sprite is. The position is relative to the
/// partner's last position, if the partner has left that position.
#[test]
fn beside_the_partner() {
    let sprites = "wall > Immovable\nx > Immovable\navatar > MovingAvatar";
    let spawned = |rule: &str, keys: &str| {
        let mut board = setup(sprites, rule).place(&[("wall", 40, 20), ("wall", 40, 20), ("avatar", 30, 20)]);
        board.play(keys);
        board.all("x").iter().map(|record| (record.rect.x, record.rect.y)).collect::<Vec<_>>()
    };
    assert_eq!(spawned("wall avatar > spawnAbove stype=x", "R"), [(40, 10), (40, 10)]);
    assert_eq!(spawned("wall avatar > spawnBelow stype=x", "R"), [(40, 30), (40, 30)]);
    assert_eq!(spawned("wall avatar > spawnLeft stype=x stepBack=True", "R"), [(20, 20), (20, 20)]);
    assert_eq!(
        spawned("wall avatar > spawnRight stype=x stepBack=True", "R."),
        [(40, 20), (40, 20)],
        "it rests in the second tick"
    );
    assert_eq!(spawned("wall avatar > spawnBehind stype=x", "R."), [(30, 20), (30, 20)]);
}

/// Q43, K-34: the first sprite of a type had the size of a cell before its first update.
#[test]
fn the_first_of_a_scaled_type() {
    let sprites = "seed > Immovable\ntall > Immovable hMult=1.5\navatar > MovingAvatar";
    let rules = "seed avatar > transformTo stype=x\nseed avatar > spawn stype=tall\ntall avatar > stepBack";
    let sprites = format!("x > Immovable\n{sprites}");
    let mut board = setup(&sprites, &rules.replace("seed avatar > transformTo stype=x\n", "")).place(&[
        ("seed", 50, 20),
        ("seed", 50, 20),
        ("avatar", 50, 20),
    ]);
    board.wait();
    assert_eq!(board.all("tall").iter().map(|record| record.rect.h).collect::<Vec<i32>>(), [10, 15]);
}

/// Q44: the last rectangle of a transformed sprite has its old size.
#[test]
fn transformed_sizes() {
    let sprites = "a > Immovable\nwide > Immovable wMult=3\navatar > MovingAvatar";
    let rules = "a avatar > transformTo stype=wide\nwide avatar > stepBack";
    let mut board = setup(sprites, rules).place(&[("a", 50, 20), ("avatar", 50, 20)]);
    assert_eq!(board.wait().one("wide").rect.w, 10);
}

/// Q45, Q46, Q58: batches count two aligned walls twice, adjacent or not, and do not check whether sprites are alive.
#[test]
fn batches() {
    let sprites =
        "ball > Missile orientation=RIGHT speed=0.5 hMult=@\nbrick > Immovable\navatar > MovingAvatar";
    let bounce = |height: &str, bricks: &[i32], rules: &str| {
        let sprites = sprites.replace('@', height);
        let placed: Vec<_> =
            bricks.iter().map(|&y| ("brick", 50, y)).chain([("ball", 40, 0), AVATAR]).collect();
        let mut board = setup(&sprites, rules).place(&placed);
        board.play("..");
        (board.score(), board.one("ball").orientation.0)
    };
    let rule = "ball brick > wallBounce scoreChange=1";
    assert_eq!(bounce("3", &[0], rule), (1, -1.0));
    assert_eq!(bounce("3", &[0, 10], rule), (2, -1.0));
    assert_eq!(bounce("3", &[0, 10, 20], rule), (1, -1.0));
    assert_eq!(bounce("3.5", &[0, 30], rule), (2, -1.0));
    assert_eq!(bounce("3.5", &[0, 30], "ball brick > wallReverse scoreChange=5"), (10, -1.0));
    assert_eq!(
        bounce("3", &[0, 10], "ball brick > wallBounce scoreChange=1 inBatch=False").0,
        1,
        "the first puts it back"
    );
    let rules = format!("ball brick > killSprite\n{rule}");
    let mut board =
        setup(&sprites.replace('@', "1"), &rules).place(&[("brick", 50, 0), ("ball", 40, 0), AVATAR]);
    board.play("..");
    assert_eq!((board.count("ball"), board.score()), (0, 1));
    // Counters are multiplied as well. A text that is not a list causes a message.
    let sprites = sprites.replace('@', "3");
    let rule = "ball brick > wallBounce counter=3,x";
    let mut board = setup(&sprites, rule).header("no_counters=2").place(&[
        ("brick", 50, 0),
        ("brick", 50, 10),
        ("ball", 40, 0),
        AVATAR,
    ]);
    board.play("..");
    assert_eq!((board.state.counters(), board.messages()), (&[6, 0][..], 1));
}

/// Q47: all participants are moved back, including moving walls.
#[test]
fn batches_put_all_back() {
    let sprites = "ball > Missile orientation=RIGHT speed=0.5\npaddle > Missile orientation=LEFT speed=0.5\navatar > MovingAvatar";
    let mut board =
        setup(sprites, "ball paddle > wallBounce").place(&[("ball", 40, 0), ("paddle", 50, 0), AVATAR]);
    board.play("..");
    assert_eq!((board.at("ball"), board.at("paddle")), ((40, 0), (50, 0)));
    // The sprites meet squarely. Such a meeting also counts as a meeting from above, which is checked first.
    assert_eq!(board.one("ball").orientation, (1.0, -0.0));
}

/// Q48: an effect without a batch version does nothing as a batch, and is an error in strict mode.
#[test]
fn batches_of_other_effects() {
    let sprites = "a > Immovable\navatar > MovingAvatar";
    let setting = setup(sprites, "a avatar > killSprite inBatch=True scoreChange=7");
    let placed = [("a", 20, 20), ("avatar", 20, 20)];
    assert_eq!(setting.problems(&placed), ["bad-parameter"]);
    let mut board = setting.place(&placed);
    board.wait();
    assert_eq!((board.count("a"), board.score()), (1, 0));
}

/// Q50: wrapAround follows the direction, along one axis, and truncates fractions.
#[test]
fn wrapping() {
    let sprites =
        "a > Missile orientation=LEFT\nb > Missile orientation=DOWN\nc > Passive\navatar > MovingAvatar";
    let wrapped = |rule: &str, name: &'static str, at: (i32, i32)| {
        let rules = format!("{name} EOS > {rule}");
        let mut board = setup(sprites, &rules).size(5, 5).place(&[(name, at.0, at.1), ("avatar", 20, 20)]);
        board.play("..");
        board.at(name)
    };
    assert_eq!(wrapped("wrapAround offset=0.55", "a", (0, 10)), (34, 10));
    assert_eq!(wrapped("wrapAround", "a", (0, 10)), (40, 10));
    assert_eq!(wrapped("wrapAround", "b", (10, 40)), (10, 0));
    assert_eq!(wrapped("wrapAround offset=1.25", "b", (10, 40)), (10, 12));
}

/// `spec/03` §7.3: the sprite moves back, takes two steps down, and then turns to the opposite direction.
#[test]
fn turning_around() {
    let sprites = "a > Missile orientation=RIGHT speed=0.5\nturner > Missile orientation=RIGHT speed=0.5 rotateInPlace=True\nw > Immovable\navatar > MovingAvatar";
    let turned = |name: &'static str| {
        let mut board =
            setup(sprites, &format!("{name} w > turnAround")).place(&[(name, 30, 10), ("w", 40, 10), AVATAR]);
        board.play("..");
        (board.at(name), board.one(name).orientation)
    };
    assert_eq!(turned("a"), ((30, 20), (-1.0, -0.0)));
    assert_eq!(turned("turner"), ((30, 15), (-0.0, -1.0)), "the first step only turned it");
}

/// Q51: the score is reset to 0 before the line's own change.
#[test]
fn removing_the_score() {
    let sprites = "a > Immovable\nb > Immovable\ntwin > MovingAvatar\navatar > MovingAvatar";
    let rules = "a avatar > halfSpeed scoreChange=50\navatar a > removeScore scoreChange=3 killSecond=True";
    let mut board = setup(sprites, rules).place(&[("a", 20, 20), ("avatar", 20, 20)]);
    board.wait();
    assert_eq!((board.score(), board.count("a")), (3, 0));
    // Each avatar has its own score, so another avatar's score is not the player's.
    let rules =
        "b avatar > spawn stype=twin scoreChange=9\na avatar > removeScore stype=twin killSecond=True";
    let placed = [("a", 20, 20), ("b", 20, 20), ("avatar", 20, 20)];
    let mut board = setup(sprites, rules).place(&placed);
    board.wait();
    assert_eq!((board.score(), board.state.avatar_id()), (9, None), "and it takes the second sprite away");
}

/// Q54: negated directions have negative zeros.
#[test]
fn negative_zeros() {
    let sprites = "a > Immovable\nb > Immovable\nrock > Immovable\nm > Missile orientation=RIGHT\navatar > MovingAvatar";
    let mut board =
        setup(sprites, "a rock > transformToSingleton stype=b stype_other=a takeOrientation=True").place(&[
            ("a", 20, 20),
            ("rock", 20, 20),
            AVATAR,
        ]);
    let (x, y) = board.wait().one("b").orientation;
    assert!(x == 0.0 && y == 0.0 && x.is_sign_negative() && y.is_sign_negative());
    let mut board =
        setup(sprites, "m rock > reverseDirection").place(&[("m", 20, 20), ("rock", 20, 20), AVATAR]);
    let (x, y) = board.wait().one("m").orientation;
    assert_eq!((x, y, y.is_sign_negative()), (-1.0, 0.0, true));
}

/// Q55: transformIfCount reports an unknown parameter twice, and lines with TIME and addTimer do not report
/// it at all.
#[test]
fn messages_about_parameters() {
    let sprites =
        "a > Immovable\nb > Immovable\nr > Resource bogus=1\naddTimers > Immovable\navatar > MovingAvatar";
    let messages = |rule: &str| setup(sprites, rule).place(&[("a", 20, 20), AVATAR]).messages() - 1;
    assert_eq!(messages("a b > killSprite bogus=1 other=2 bogus=3"), 2);
    assert_eq!(messages("a b > transformIfCount stype=a stypeCount=b bogus=1"), 2);
    assert_eq!(messages("a TIME > killSprite bogus=1"), 0);
    assert_eq!(messages("a b > addTimer ftype=killSprite bogus=1"), 0);
    assert_eq!(messages("a addTimers > killSprite bogus=1"), 0);
    assert_eq!(messages("a b > killSprite timer=1"), 1);
    assert_eq!(messages("a b > killSprite hashCode=1 counter=1 isKillEffect=1"), 1);
    assert_eq!(
        messages("a b > transformTo stype=x bogus=1"),
        2,
        "the message that ends the reading comes on top"
    );
    assert_eq!(messages("a b > explode bogus=1"), 1);
}

/// Q56: a constant, a number or a boolean is not a name in a parameter, but is a name before the arrow.
#[test]
fn names_that_read_as_something_else() {
    let sprites = "GOLD > Immovable\n7 > Immovable\na > Immovable\navatar > MovingAvatar";
    for name in ["GOLD", "7"] {
        let rules = format!("{name} avatar > killSprite\na avatar > transformTo stype={name}");
        let mut board = setup(sprites, &rules).place(&[("a", 20, 20), (name, 20, 20), ("avatar", 20, 20)]);
        assert_eq!((board.messages(), board.wait().count(name), board.count("a")), (1, 0, 1), "{name}");
    }
}

/// Q57, K-21: a sprite that a line makes takes part in the next line, not in its own.
#[test]
fn newborn_sprites() {
    let sprites = "a > Immovable\nb > Immovable\navatar > MovingAvatar";
    let rules = "a avatar > transformTo stype=b\nb avatar > killSprite scoreChange=1";
    let mut board = setup(sprites, rules).place(&[("a", 20, 20), ("avatar", 20, 20)]);
    board.wait();
    assert_eq!((board.count("a"), board.count("b"), board.score()), (0, 0, 1));
    let mut board = setup(sprites, "a avatar > cloneSprite").place(&[("a", 20, 20), ("avatar", 20, 20)]);
    assert_eq!([board.wait().count("a"), board.wait().count("a")], [2, 4]);
    let mut board =
        setup(sprites, "a avatar > cloneSprite repeat=2").place(&[("a", 20, 20), ("avatar", 20, 20)]);
    assert_eq!(board.wait().count("a"), 4, "each repeat is a pass of its own");
    let mut board =
        setup(sprites, "a avatar > killSprite repeat=0").place(&[("a", 20, 20), ("avatar", 20, 20)]);
    assert_eq!(board.wait().count("a"), 1);
}

/// `spec/03` §16: placing a sprite without height anywhere stops the game.
#[test]
fn flat_sprites() {
    let sprites = "flat > Immovable hMult=0.01\nbig > Immovable\navatar > MovingAvatar";
    let dies = |rule: &str| {
        setup(sprites, rule).place(&[("flat", 20, 20), ("big", 40, 20), ("avatar", 40, 20)]).wait().died()
    };
    assert!(dies("big avatar > undoAll"));
    assert!(!dies("big avatar > undoAll notStype=flat"));
    assert!(!dies("flat avatar > stepBack"), "it meets nobody");
    assert!(dies("flat EOS > stepBack"), "but it is never wholly on the screen");
    assert!(!dies("flat EOS > halfSpeed"));
}

/// `spec/03` §8.3: the sprite stops flush with a wall and continues along it. Each wall that it still touches counts
/// (Q49).
#[test]
fn stopping_at_walls() {
    let sprites = "ball > Missile orientation=RIGHT speed=0.7\nbrick > Immovable\navatar > MovingAvatar";
    let mut board = setup(sprites, "ball brick > wallStop scoreChange=1").place(&[
        ("brick", 50, 20),
        ("brick", 50, 20),
        ("ball", 40, 20),
        AVATAR,
    ]);
    board.play("..");
    let ball = board.one("ball");
    assert_eq!((ball.rect.x, ball.orientation, ball.speed, board.score()), (40, (0.0, 0.0), 0.0, 1));
    assert_eq!(board.state.outcome(), Outcome::Ongoing);
}

/// `spec/01` §3.5: when there are 10,001 sprites, the next sprite is rejected with a message, whether it is a
/// singleton or not.
#[test]
fn the_limit_of_sprites() {
    let sprites = "a > Immovable\none > Immovable singleton=True\navatar > MovingAvatar";
    let mapping = "  LevelMapping\n    x > a a a a a a a a a a\n    o > one one\n";
    let source = setup(sprites, "").texts(&[]).0.replace("  LevelMapping\n", mapping);
    let game = engine::Game::from_source_as_reference(&source).unwrap();
    let full = format!("{}A\n{}", " ".repeat(99), format!("{}\n", "x".repeat(100)).repeat(10));
    let start = |text: &str| game.start_with(&game.level(text).unwrap(), engine::Chance::from_java(1));
    let state = start(&full);
    assert_eq!((game.records(&state).len(), state.messages()), (10_001, 0));
    let state = start(&format!("{full}oo"));
    assert_eq!((game.records(&state).len(), state.messages()), (10_001, 4));
}
