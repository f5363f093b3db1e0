//! Tests each sprite class and each rare parameter once, with positions computed by hand from `spec/02`, on
//! boards with cells of 10 pixels.

use crate::vectors::vector::Vector;
use engine::{Action, Chance, Game, Limit, Outcome};

const HERE: [(&str, i32, i32); 1] = [("avatar", 50, 20)];

/// Checks the columns of a sprite after each tick without a key.
#[track_caller]
fn columns(sprite: &str, expected: &[i32]) {
    let sprites = format!("avatar > MovingAvatar\ns > {sprite}");
    let mut vector = Vector::new(&sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
    let places = vector.places("s", &".".repeat(expected.len()));
    assert_eq!(places, expected.iter().map(|&x| (x, 20)).collect::<Vec<_>>(), "{sprite}");
}

#[test]
fn plain_sprites() {
    columns("Conveyor speed=1 orientation=RIGHT", &[100; 5]);
    columns("Passive speed=1 orientation=RIGHT", &[100, 110, 120, 130, 140]);
    columns("Passive speed=1", &[100; 5]);
    columns("Immovable speed=1 orientation=RIGHT is_static=False", &[100, 110, 120, 130, 140]);
    columns("Missile orientation=RIGHT only_active=True", &[100; 5]);
    columns("ErraticMissile orientation=RIGHT speed=0.5 cooldown=2", &[100, 105, 105, 110, 110, 115]);
    columns("SpriteProducer orientation=LEFT speed=1", &[100, 90, 80, 70, 60]);
    columns("OrientedFlicker orientation=RIGHT speed=1 limit=9", &[100, 110, 120, 130, 140]);
    columns("RandomMissile orientation=LEFT", &[100, 90, 80, 70, 60]);
    columns("RandomMissile orientation=LEFT is_static=True", &[100; 5]);
}

#[test]
fn speeds_cooldowns_and_first_ticks() {
    columns("Missile orientation=RIGHT speed=-1", &[100, 110, 120, 130, 140]);
    columns("Missile orientation=RIGHT speed=-2", &[100, 80, 60, 40, 20]);
    columns("Missile orientation=RIGHT speed=0.29", &[100, 102, 104, 106, 108]);
    columns("Missile orientation=RIGHT speed=0.05", &[100; 5]);
    columns("Missile orientation=RIGHT cooldown=3", &[100, 100, 110, 110, 110, 120]);
    columns("Missile orientation=RIGHT cooldown=3 lastmove=2", &[100, 110, 110, 110, 120]);
    columns("Missile orientation=RIGHT isFirstTick=False", &[110, 120, 130, 140, 150]);
    columns("Missile orientation=RIGHT cooldown=2147483647 lastmove=2147483647", &[100; 5]);
    columns("Missile orientation=RIGHT speed=NONE speed=2", &[100, 120, 140, 160, 180]);
    columns("Missile orientation=RIGHT physicstype=CONT speed=7 friction=0.5", &[100, 107, 110, 111, 111]);
}

#[test]
fn lives() {
    let gone = |sprite: &str, last: i32| {
        let sprites = format!("avatar > MovingAvatar\ns > {sprite}");
        let mut vector = Vector::new(&sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
        for tick in 0..6 {
            vector.step(Action::Nil);
            assert_eq!(!vector.all("s").is_empty(), tick <= last, "{sprite} after tick {tick}");
        }
    };
    gone("SpriteProducer timeToLive=3", 2);
    gone("Conveyor timeToLive=2", 1);
    gone("Portal stype=avatar timeToLive=2", 1);
    gone("SpawnPoint stype=avatar prob=0 timeToLive=2", 1);
    gone("Flicker age=1", 0);
    gone("Flicker limit=3", 3);
    gone("RandomMissile timeToLive=0", 9);
    gone("RandomNPC timeToLive=0", 9);
    gone("Walker orientation=RIGHT speed=1 timeToLive=0", 9);
}

/// A sprite that stands still can be given speed, or pushed, and moves from then on.
#[test]
fn speed_from_effects() {
    let placed = [("avatar", 0, 70), ("s", 100, 20)];
    let sprites = "avatar > MovingAvatar\ns > Passive orientation=RIGHT";
    let mut vector = Vector::new(sprites, "TIME s > setSpeedForAll stype=s value=2", &placed, 1);
    assert_eq!(vector.places("s", "...."), [(100, 20), (120, 20), (140, 20), (160, 20)]);

    let sprites = "avatar > MovingAvatar\ns > Passive physicstype=CONT";
    let placed = [("avatar", 80, 20), ("s", 100, 20)];
    // The second push has no direction, and uses the orientation.
    let mut vector = Vector::new(sprites, "s avatar > bounceForward", &placed, 1);
    assert_eq!(vector.places("s", "RR.."), [(100, 20), (100, 20), (101, 20), (101, 20)]);
}

/// An orientation that a spawner gives does not make a sprite oriented.
#[test]
fn spawned_orientations() {
    let sprites = "avatar > MovingAvatar\np > Passive speed=1\nm > Missile\nn > Missile orientation=UP\ns > SpawnPointMultiSprite stypes=p,m,n orientation=LEFT total=3";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("s", 100, 50)], 1);
    vector.play("....");
    assert_eq!(vector.place("p"), (100, 50));
    assert_eq!(vector.one("p").orientation, (-1.0, 0.0));
    assert_eq!((vector.place("m"), vector.place("n")), ((70, 50), (100, 20)));
}

#[test]
fn spreaders_spread_even_as_they_die() {
    let sprites = "avatar > MovingAvatar\nx > Immovable\ns > Spreader limit=0 spreadprob=1 stype=x";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
    vector.play(".");
    assert_eq!((vector.all("s").len(), vector.all("x").len()), (1, 0));
    vector.play(".");
    assert_eq!(vector.spots("x"), [(100, 10), (90, 20), (100, 30), (110, 20)]);
    vector.play("...");
    assert_eq!((vector.all("s").len(), vector.all("x").len()), (0, 4));
}

/// A sprite of a parent type is never updated.
#[test]
fn sprites_of_parent_types() {
    let sprites =
        "avatar > MovingAvatar\np > Missile orientation=RIGHT\n  c >\ns > SpawnPoint stype=p total=1";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
    assert_eq!(vector.places("p", "....."), [(100, 20); 5]);
}

/// Turning in place uses up the active movement. The passive movement then moves the sprite, except in the
/// first update.
#[test]
fn a_bomber_that_turns_in_place() {
    let sprites = "avatar > MovingAvatar\ny > Immovable\nb > RandomBomber stype=y rotateInPlace=True";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("b", 150, 40)], 5);
    let mut chance = Chance::from_java(5);
    let (mut x, mut y) = (150, 40);
    let mut facing = 3;
    for tick in 0..12 {
        let (from, drawn) = ((x, y), chance.below(4));
        chance.float();
        if tick > 0 || drawn == facing {
            let (dx, dy) = [(0, -10), (-10, 0), (0, 10), (10, 0)][drawn as usize];
            (x, y) = (x + dx, y + dy);
        }
        vector.step(Action::Nil);
        assert_eq!(vector.place("b"), (x, y), "tick {tick}");
        let made = if drawn == facing { (x, y) } else { from };
        assert_eq!(vector.spots("y").last(), Some(&made), "tick {tick}");
        facing = drawn;
    }
}

/// updateSpawnType makes spawners spawn a different type. In a list, the new type replaces the partner's
/// type.
#[test]
fn other_spawn_types() {
    let sprites = "avatar > MovingAvatar\nx > Immovable\ny > Immovable\nz > Immovable\ns > BomberRandomMissile stypeMissile=x,y\nq > SpawnPoint stype=x";
    let rules =
        "avatar y > updateSpawnType stype=z spawnPoint=s\navatar y > updateSpawnType stype=z spawnPoint=q";
    let placed = [("avatar", 50, 20), ("y", 60, 20), ("s", 100, 40), ("q", 200, 40)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    let mut chance = Chance::from_java(1);
    let mut expected = [0, 1, 0];
    for (tick, key) in ["R", ".", ".", ".", ".", ".", "."].iter().enumerate() {
        chance.float();
        let drawn = chance.below(2);
        chance.float();
        vector.play(key);
        // The first tick's events come after its updates.
        expected[if drawn == 1 && tick > 0 { 2 } else { drawn as usize }] += 1;
        expected[if tick > 0 { 2 } else { 0 }] += 1;
        let made = ["x", "y", "z"].map(|name| vector.all(name).len());
        assert_eq!(made, expected, "tick {tick}");
    }
}

#[test]
fn chasers_within_a_distance() {
    let sprites = |params: &str| format!("avatar > MovingAvatar\nt > Immovable\nc > Chaser stype=t {params}");
    let placed = [("avatar", 0, 70), ("t", 150, 20), ("c", 100, 20)];
    let mut near = Vector::new(&sprites("maxDistance=50"), "", &placed, 1);
    assert_eq!(near.places("c", "....."), [(110, 20), (120, 20), (130, 20), (140, 20), (150, 20)]);
    let mut far = Vector::new(&sprites("maxDistance=49 cons=9"), "", &placed, 1);
    assert_eq!(far.places("c", "....."), [(100, 20); 5]);
    // A decimal value is lost.
    let mut any = Vector::as_reference(&sprites("maxDistance=4.5"), "", &placed, 1);
    assert_eq!(any.places("c", ".."), [(110, 20), (120, 20)]);
}

/// A killed avatar remains a target. A type also remains a target if only its relatives have sprites.
#[test]
fn targets() {
    let sprites = "k > Immovable\navatar > MovingAvatar\nf > Fleeing stype=avatar fleeing=False\ng > Chaser stype=child\npet > Immovable\n  child >\n  other >";
    let rules = "avatar k > killSprite";
    let placed = [("avatar", 0, 70), ("k", 10, 70), ("f", 80, 70), ("g", 100, 20), ("other", 200, 20)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    assert_eq!(vector.places("f", "R...."), [(70, 70), (60, 70), (50, 70), (40, 70), (30, 70)]);
    // `other` is not a relative of `child`, so there is no target. The sprite makes random steps, with one
    // draw each.
    let mut chance = Chance::from_java(1);
    let ways = [(0, -10), (-10, 0), (0, 10), (10, 0)];
    let (mut x, mut y) = (100, 20);
    for _ in 0..5 {
        let (dx, dy) = ways[chance.below(4) as usize];
        (x, y) = (x + dx, y + dy);
        chance.below(1);
    }
    assert_eq!(vector.place("g"), (x, y));
}

#[test]
fn walkers_on_the_grid() {
    columns("WalkerJumper orientation=RIGHT speed=1", &[110, 120, 130, 140, 150]);
    columns("WalkerJumper", &[100; 5]);
    // Without a passive move, the walker turns ahead and walks at `max_speed`. After that, the passive move
    // suffices.
    columns("Walker orientation=LEFT speed=1 max_speed=2", &[80, 60, 40, 20, 0]);
    // The steering comes after the passive move, and the cooldown blocks the steering.
    columns("Walker orientation=LEFT speed=1 max_speed=1 airsteering=True", &[90, 80, 70, 60, 50]);
}

/// Only the keys of the class have an effect, and only these keys are offered.
#[test]
fn avatars_of_few_keys() {
    let check = |class: &str, keys: &str, expected: &[(i32, i32)]| {
        let mut vector = Vector::new(&format!("avatar > {class}"), "", &HERE, 1);
        assert_eq!(vector.places("avatar", keys), expected, "{class}");
    };
    check("NullAvatar", "ULDRX.", &[(50, 20); 6]);
    check("HorizontalAvatar", "URDLXR", &[(50, 20), (60, 20), (60, 20), (50, 20), (50, 20), (60, 20)]);
    check("VerticalAvatar hMult=3", "URDDL", &[(50, 10), (50, 10), (50, 20), (50, 30), (50, 30)]);
    check("MovingAvatar speed=0", "URD", &[(50, 10), (60, 10), (60, 20)]);
    check("MovingAvatar stationary=True", "URD", &[(50, 20); 3]);
    check("MissileAvatar", "ULDRX", &[(50, 20), (60, 20), (70, 20), (80, 20), (90, 20)]);
    check("MissileAvatar only_active=True", "ULDR.", &[(50, 20); 5]);
    check("OngoingAvatar orientation=DOWN", "..L.U", &[(50, 20), (50, 30), (40, 30), (30, 30), (30, 20)]);
}

/// There is one type of shot per key, and all shots fly in the same direction. A shot costs ammunition if the
/// list has an entry.
#[test]
fn shoots_by_key() {
    let sprites = "r > Resource\na > Missile\nb > Immovable\navatar > ShootOnlyAvatar stype=a,b ammo=r";
    let mut vector = Vector::new(sprites, "r avatar > collectResource", &HERE, 1);
    vector.play("LRDX");
    assert_eq!((vector.all("a").len(), vector.all("b").len()), (0, 0), "no ammunition, no such kind");
    vector.play("U");
    assert_eq!(vector.spots("b"), [(60, 20)]);
    assert_eq!(vector.place("avatar"), (50, 20));
    let placed = [("avatar", 50, 20), ("r", 50, 20)];
    let sprites = sprites.replace("ammo=r", "orientation=DOWN");
    let mut vector = Vector::new(&sprites, "", &placed[..1], 1);
    vector.play("L...");
    assert_eq!(vector.spots("a"), [(50, 60)]);
    const FROM_AVATAR: u16 = 4;
    assert_eq!(vector.one("a").flags, FROM_AVATAR);
}

/// A shot of a FlakAvatar starts at the avatar's position, whatever its size, and keeps its own orientation.
#[test]
fn flak() {
    let sprites = "b > Missile\nc > Missile orientation=UP\navatar > FlakAvatar stype=c wMult=2";
    let mut vector = Vector::new(sprites, "", &HERE, 1);
    vector.play("RX...");
    assert_eq!((vector.place("avatar"), vector.place("c")), ((60, 20), (60, -10)));
}

#[test]
fn lander() {
    let sprites = "avatar > LanderAvatar physicstype=CONT gravity=0.5";
    let mut vector = Vector::new(sprites, "", &HERE, 1);
    let fall = [20, 20, 20, 21, 22, 24];
    assert_eq!(vector.places("avatar", "......"), fall.map(|y| (50, y)));
    vector.play("LLR");
    assert_eq!(vector.one("avatar").rotation, -0.3 - 0.3 + 0.3);
}

/// Continuous avatars: without a key, an avatar without an orientation has speed 0. The mass is rounded, and
/// the speed has a limit.
#[test]
fn continuous_avatars() {
    let first = |params: &str, keys: &str| {
        let sprites = format!("avatar > MovingAvatar physicstype=CONT {params}");
        let mut vector = Vector::new(&sprites, "", &HERE, 1);
        vector.play(keys);
        let avatar = vector.one("avatar");
        (avatar.rect.x, avatar.orientation, avatar.speed)
    };
    assert_eq!(first("", "."), (50, (0.0, 0.0), 0.0));
    assert_eq!(first("mass=0.2", "R").2, 4.999_999_925_494_195);
    assert_eq!(first("max_speed=2", "RRRRR"), (57, (1.0, 0.0), 2.0));
    assert_eq!(first("friction=0.5", "RRRR").2, 1.875);
    // A mass of 0 divides by 0. The result is NaN, to which the limit does not apply.
    let (x, (ox, oy), speed) = first("mass=0 max_speed=2", "RRR");
    assert!(x == 50 && ox.is_nan() && oy.is_nan() && speed.is_nan());
}

/// The first sprite of a type keeps the size of a cell in its last rectangle until its first update.
#[test]
fn the_first_sprite_of_a_size() {
    let sprites = "avatar > MovingAvatar\ns > SpawnPoint stype=p total=1\np > Passive wMult=2";
    let rules = "p s > stepBack";
    let mut vector = Vector::new(sprites, rules, &[("avatar", 0, 70), ("s", 100, 20), ("s", 200, 20)], 1);
    vector.step(Action::Nil);
    assert_eq!(vector.all("p").iter().map(|record| record.rect.w).collect::<Vec<_>>(), [10, 20]);
}

/// A second OngoingTurningAvatar has lost the type that it leaves behind, so it leaves walls.
#[test]
fn the_second_avatar_that_leaves_a_trail() {
    let sprites = "trail > Immovable\nb > Immovable\nc > Immovable\nme >\n  avatar > OngoingTurningAvatar spawnBehind=trail\n  other > OngoingAvatar";
    let rules = "avatar b > transformTo stype=other\nother c > transformTo stype=avatar";
    let placed = [("avatar", 50, 20), ("b", 60, 20), ("c", 80, 20)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    let path = [50, 60, 60, 70, 80, 80, 90, 100];
    for (tick, x) in path.into_iter().enumerate() {
        vector.step(Action::Nil);
        let avatar = [vector.spots("avatar"), vector.spots("other")].concat();
        assert_eq!(avatar, [(x, 20)], "tick {tick}");
    }
    assert_eq!(vector.spots("trail"), [(50, 20)]);
    assert_eq!(vector.spots("wall"), [(80, 20), (90, 20)]);
}

#[test]
fn resources_by_name() {
    let sprites = "gold > Resource limit=3\npack > ResourcePack resource_name=gold value=2\nown > ResourcePack resource_name=own\navatar > MovingAvatar";
    let rules = "pack avatar > collectResource\nown avatar > collectResource";
    let placed = [("avatar", 50, 20), ("pack", 60, 20), ("own", 70, 20), ("pack", 80, 20)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    vector.play("RRR");
    assert_eq!(vector.game.held_by_avatar(&vector.state), [("gold".to_owned(), 3)]);
    assert_eq!(vector.all("own").len(), 1, "packs have no limit of their own");
}

/// Paths are requested only if there is a target. Paths go sideways for the whole episode if the first avatar
/// has three actions.
#[test]
fn paths() {
    let sprites = "rock > Immovable\nt > Immovable\np > PathChaser stype=t\nq > PathAltChaser stype1=t\navatar > MovingAvatar";
    let mut lost = Vector::new(sprites, "", &[("avatar", 0, 70), ("p", 100, 20), ("q", 200, 20)], 1);
    lost.play(".....");
    assert_eq!(lost.state.outcome(), Outcome::Ongoing);
    let placed = [("avatar", 0, 70), ("p", 100, 20), ("t", 120, 20)];
    let mut none = Vector::new(sprites, "", &placed, 1);
    none.play(".");
    assert_eq!(none.state.outcome(), Outcome::Stopped(Limit::NoPaths));

    let header = "square_size=10 obs=rock";
    let walled = [("avatar", 0, 70), ("p", 100, 20), ("t", 120, 20), ("rock", 110, 20)];
    let mut around = Vector::headed(header, sprites, "", &walled, 1);
    let way = [(100, 10), (110, 10), (120, 10), (120, 20), (120, 20)];
    assert_eq!(around.places("p", "....."), way);
    // Unknown names are not obstacles, but they enable path finding.
    let mut through = Vector::headed("square_size=10 obs=rocks", sprites, "", &walled, 1);
    assert_eq!(through.places("p", "..."), [(110, 20), (120, 20), (120, 20)]);

    let sprites = "rock > Immovable\nb > Immovable\nt > Immovable\np > PathChaser stype=t\nme >\n  avatar > FlakAvatar stype=b\n  free > MovingAvatar";
    let rules = "avatar b > transformTo stype=free";
    let mut walled = walled.to_vec();
    walled.push(("b", 10, 70));
    let mut sideways = Vector::headed(header, sprites, rules, &walled, 1);
    assert_eq!(sideways.places("p", "R...."), [(100, 20); 5]);
    assert_eq!(sideways.all("free").len(), 1);
}

/// A PathAltChaser keeps one target, and its last position if the target is gone. Only at that position does it look
/// for another target.
#[test]
fn one_target_at_a_time() {
    let header = "square_size=10 obs=rock";
    let sprites = "rock > Immovable\nt > Immovable\nq > PathAltChaser stype1=t cons=3\navatar > MovingAvatar";
    let placed = [("avatar", 140, 20), ("t", 150, 20), ("q", 100, 20)];
    let mut vector = Vector::headed(header, sprites, "t avatar > killSprite", &placed, 1);
    let mut chance = Chance::from_java(1);
    let way = [110, 120, 130, 140, 150].map(|x| (x, 20));
    assert_eq!(vector.places("q", "R..L."), way);
    assert_eq!((vector.all("t").len(), vector.state.chance()), (0, chance));
    let (dx, dy) = [(0, -10), (-10, 0), (0, 10), (10, 0)][chance.below(4) as usize];
    assert_eq!(vector.places("q", "."), [(150 + dx, 20 + dy)]);
    assert_eq!(vector.state.chance(), chance);

    let sprites = sprites.replace("cons=3", "randomTarget=True");
    let placed = [("avatar", 0, 70), ("t", 100, 0), ("t", 100, 70), ("q", 100, 30)];
    let mut vector = Vector::headed(header, &sprites, "", &placed, 1);
    let mut chance = Chance::from_java(1);
    // Each target is listed twice: all targets come in order, then all targets come again.
    let down = chance.below(4) % 2 == 1;
    vector.play("..");
    assert_eq!(vector.place("q"), (100, if down { 50 } else { 10 }));
    assert_eq!(vector.state.chance(), chance);
    let mut none = Vector::headed(header, &sprites, "", &[("avatar", 0, 70), ("q", 100, 30)], 1);
    none.play(".");
    assert_eq!(none.state.outcome(), Outcome::Stopped(Limit::NoSprite));
}

/// A RandomPathAltChaser always makes a draw. Below epsilon it takes a random step, and otherwise it follows
/// the path.
#[test]
fn now_and_then_at_random() {
    for epsilon in ["0.0", "1"] {
        let sprites = format!(
            "rock > Immovable\nt > Immovable\nq > RandomPathAltChaser stype1=t epsilon={epsilon}\navatar > MovingAvatar"
        );
        let placed = [("avatar", 0, 70), ("t", 200, 20), ("q", 100, 20)];
        let mut vector = Vector::headed("square_size=10 obs=rock", &sprites, "", &placed, 4);
        let mut chance = Chance::from_java(4);
        let (mut x, mut y) = (100, 20);
        for tick in 0..5 {
            chance.double();
            let way = if epsilon == "1" { chance.below(4) } else { 3 };
            let (dx, dy) = [(0, -10), (-10, 0), (0, 10), (10, 0)][way as usize];
            (x, y) = (x + dx, y + dy);
            vector.step(Action::Nil);
            assert_eq!(vector.place("q"), (x, y), "epsilon {epsilon}, tick {tick}");
            assert_eq!(vector.state.chance(), chance, "epsilon {epsilon}, tick {tick}");
        }
    }
}

/// A bomber makes sprites at its position, then moves on.
#[test]
fn bombers() {
    let sprites = "avatar > MovingAvatar\ny > Immovable\nb > Bomber stype=y speed=1 spawnorientation=UP";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("b", 100, 20)], 1);
    assert_eq!(vector.places("b", "....."), [100, 110, 120, 130, 140].map(|x| (x, 20)));
    assert_eq!(vector.spots("y"), [100, 100, 110, 120, 130].map(|x| (x, 20)));
    assert_eq!(vector.all("y")[4].orientation, (0.0, -1.0));
}

/// The player's avatar is updated whatever its type. A parent type is not in the update order.
#[test]
fn an_avatar_of_a_parent_type() {
    let sprites = "b > Immovable\nme > MovingAvatar\n  avatar >\n  other >";
    let rules = "avatar b > transformTo stype=me\nme wall > stepBack";
    let placed = [("avatar", 50, 20), ("b", 60, 20), ("wall", 80, 20)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    vector.play("R");
    assert_eq!(vector.places("me", "RRR"), [(70, 20); 3]);
}

/// An unknown kind of physics acts like grid physics, but avatars have passive movement, and do not face the
/// direction of their moves.
#[test]
fn physics_of_another_kind() {
    let mut vector = Vector::as_reference("avatar > OrientedAvatar physicstype=2", "", &HERE, 1);
    assert_eq!(vector.places("avatar", "..U.."), [(50, 20), (60, 20), (70, 20), (70, 10), (70, 0)]);
}

/// Names that read as something else are lost. Undeclared and missing names stop the game when they are
/// needed.
#[test]
fn names_of_other_sprites() {
    let start = |sprites: &str, keys: &str| {
        let sprites = format!("avatar > MovingAvatar\nGOLD > Immovable\nx > Immovable\n{sprites}");
        let mut vector = Vector::as_reference(&sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
        let before = vector.state.outcome();
        vector.play(keys);
        (before, vector.state.outcome())
    };
    let (on, lost) = (Outcome::Ongoing, Outcome::Stopped(Limit::NoType));
    let unfit = Outcome::Stopped(Limit::UnfitSprite);
    assert_eq!(start("s > SpawnPoint stype=GOLD", "."), (on, lost));
    assert_eq!(start("s > SpawnPoint stype=x,x", "."), (on, lost));
    assert_eq!(start("s > SpawnPoint prob=0", "....."), (on, on));
    assert_eq!(start("s > SpawnPointMultiSprite stypes=x,ghost", "."), (on, lost));
    assert_eq!(start("s > SpawnPointMultiSprite stypes=x,", "."), (on, on));
    assert_eq!(start("s > BomberRandomMissile stypeMissile=ghost prob=0", "....."), (on, on));
    assert_eq!(start("s > BomberRandomMissile stypeMissile=ghost", "."), (on, lost));
    assert_eq!(start("s > Chaser stype=ghost", "."), (on, lost));
    assert_eq!(start("s > AlternateChaser stype1=x,ghost", "."), (on, lost));
    for incomplete in
        ["Chaser", "Chaser stype=7", "AlternateChaser stype2=x", "PathChaser", "Portal", "ResourcePack"]
    {
        assert_eq!(start(&format!("s > {incomplete}"), "").0, unfit, "{incomplete}");
    }
}

/// A sprite with images only for the four directions stops the game if it has any other orientation.
#[test]
fn oriented_pictures() {
    let outcome = |sprite: &str| {
        let sprites = format!("avatar > MovingAvatar\ns > {sprite} orientedImg=x");
        let mut vector = Vector::new(&sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
        vector.play(".....");
        vector.state.outcome()
    };
    assert_eq!(outcome("Immovable"), Outcome::Stopped(Limit::UnfitSprite));
    assert_eq!(outcome("Immovable orientation=UP"), Outcome::Ongoing);
    assert_eq!(outcome("RandomNPC orientation=LEFT rotateInPlace=True"), Outcome::Ongoing);
}

#[test]
fn ammunition_that_does_not_exist() {
    let sprites = "a > Missile\nb > Missile\navatar > ShootAvatar stype=a,b ammo=ghost";
    let mut vector = Vector::as_reference(sprites, "", &HERE, 1);
    vector.play("X");
    assert_eq!((vector.all("a").len(), vector.all("b").len()), (0, 1));
    let sprites = "a > Missile\navatar > FlakAvatar stype=a ammo=ghost";
    let mut vector = Vector::as_reference(sprites, "", &HERE, 1);
    vector.play("XX");
    assert_eq!(vector.all("a").len(), 0);
}

/// Sprites with sizes that are rounded to 0 can exist, but cannot move or be made again.
#[test]
fn flat_sprites() {
    let outcome = |sprite: &str, many: usize| {
        let sprites = format!("avatar > MovingAvatar\ns > {sprite}");
        let placed = [("avatar", 0, 70), ("s", 100, 20), ("s", 120, 20)];
        let mut vector = Vector::as_reference(&sprites, "", &placed[..=many], 1);
        vector.play("...");
        vector.state.outcome()
    };
    let flat = Outcome::Stopped(Limit::FlatSprite);
    assert_eq!(outcome("Passive hMult=0", 1), Outcome::Ongoing);
    assert_eq!(outcome("Passive hMult=0", 2), flat);
    assert_eq!(outcome("Missile hMult=0.05 orientation=UP wMult=0", 1), flat);
    assert_eq!(outcome("Missile hMult=-1 orientation=UP", 2), Outcome::Ongoing);
    assert_eq!(outcome("Missile wMult=NaN hMult=1e300 orientation=UP", 2), Outcome::Ongoing);
}

#[test]
fn flags_set_by_parameters() {
    let sprites = "avatar > MovingAvatar is_avatar=False\ns > Immovable is_from_avatar=True on_ground=True";
    let mut vector = Vector::as_reference(sprites, "", &[("avatar", 50, 20), ("s", 100, 20)], 1);
    assert_eq!((vector.state.avatar_id(), vector.one("s").flags, vector.one("avatar").flags), (None, 12, 0));
    assert_eq!(vector.places("avatar", "RRR"), [(50, 20); 3]);
    let sprites = "avatar > MovingAvatar\ns > Immovable is_avatar=True";
    let vector = Vector::as_reference(sprites, "", &[("s", 100, 20)], 1);
    assert_eq!(vector.state.outcome(), Outcome::Stopped(Limit::UnfitSprite));
    let sprites = "avatar > MovingAvatar\ns > Immovable is_resource=True";
    let placed = [("avatar", 50, 20), ("s", 60, 20)];
    let mut vector = Vector::as_reference(sprites, "s avatar > collectResource", &placed, 1);
    vector.play("R");
    assert_eq!(vector.state.outcome(), Outcome::Stopped(Limit::UnfitSprite));
}

/// The reference logs a message for each unknown parameter when it makes the first sprite, and once more
/// before that if the sprite is a resource. The reference never logs a message for its own fields.
#[test]
fn messages_about_parameters() {
    let messages = |sprite: &str| {
        let sprites = format!("avatar > MovingAvatar\ns > {sprite}");
        let placed = [("avatar", 0, 70), ("s", 100, 20), ("s", 120, 20)];
        Vector::as_reference(&sprites, "", &placed, 1).state.messages()
    };
    assert_eq!(messages("Immovable limit=2 gloss=3"), 2);
    assert_eq!(messages("Resource limit=2 gloss=3"), 2);
    assert_eq!(messages("ResourcePack resource_name=s gloss=3"), 1);
    assert_eq!(messages("Immovable name=s spriteID=7 bucket=1 currentFrame=2"), 0);
    assert_eq!(messages("Immovable cooldown=2.0 hidden=1 img=RED"), 0);
    assert_eq!(messages("Fleeing stype=s cons=2 maxDistance=3 stype1=s"), 1);
}

/// If two parameters have the same name, the last parameter counts.
#[test]
fn the_last_of_two_parameters() {
    let sprites = "avatar > MovingAvatar\np > Immovable singleton=True singleton=False";
    let vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("p", 10, 10), ("p", 20, 10)], 1);
    assert_eq!(vector.all("p").len(), 2);
}

/// The phase of a spawner is part of the search key, even before the spawner's first update.
#[test]
fn search_keys_tell_phases_apart() {
    for spawner in ["SpawnPointMultiSprite stypes=y cooldown=50", "SpawnPoint stype=y cooldown=50"] {
        let sprites = format!("avatar > MovingAvatar\ny > Immovable\ns > {spawner}");
        let mut vector = Vector::new(&sprites, "", &[("avatar", 0, 70), ("s", 100, 20)], 1);
        let key = |vector: &Vector| vector.state.fork(base::Seed::from_text("one")).search_key(&vector.game);
        vector.play(".");
        let first = key(&vector);
        vector.play(".");
        assert_ne!(key(&vector), first, "{spawner}");
    }
}

/// In strict mode, each tested line is an error at its position, with help.
#[test]
fn strict_loading_reports_errors() {
    let check = |line: &str, code: &str, marked: &str| {
        let source = format!(
            "BasicGame\n  SpriteSet\n    avatar > MovingAvatar\n    GOLD > Immovable\n    s > {line}\n  LevelMapping\n    s > s GOLD\n  InteractionSet\n    avatar s > stepBack\n  TerminationSet\n    Timeout limit=5 win=True\n"
        );
        let problems = Game::from_source(&source).expect_err(line).0;
        let problem = problems.iter().find(|problem| problem.code == code);
        let problem = problem.unwrap_or_else(|| panic!("{line}: {problems:?}"));
        assert_eq!(&source[problem.span.start..problem.span.end], marked, "{line}");
    };
    check("SpawnPoint stype=GOLD", "wrong-type", "GOLD");
    check("SpawnPoint stype=s", "spawns-itself", "s");
    check("SpawnPointMultiSprite stypes=s,GOLD", "spawns-itself", "s,GOLD");
    check("Portal", "missing-parameter", "s");
    check("ResourcePack", "missing-parameter", "s");
    check("Chaser stype=s,s", "wrong-type", "s,s");
    check("BomberRandomMissile stypeMissile=s,ghost", "unknown-sprite", "ghost");
    check("SpawnPointMultiSprite stypes=avatar,", "wrong-type", "avatar,");
    check("Immovable spriteID=3", "bad-parameter", "spriteID");
    check("Immovable physicstype=2", "wrong-type", "2");
    check("Immovable is_avatar=True", "bad-parameter", "is_avatar=True");
    check("Immovable hMult=0", "bad-parameter", "0");
    check("Missile speed=fast", "wrong-type", "fast");
}
