//! Tests the test vectors of the specification (`spec/02` §17): positions tick by tick, on boards with cells
//! of 10 pixels.

use crate::vectors::vector::{Vector, actions};
use engine::{Action, Chance};

/// T1: checks the last tick after which each sprite still exists.
#[test]
fn flickers_and_times_to_live() {
    let sprites = "avatar > MovingAvatar\nf0 > Flicker limit=0\nf2 > Flicker limit=2\nfd > Flicker\ntt > Passive timeToLive=2\nt0 > Passive timeToLive=0\nm > Missile orientation=RIGHT timeToLive=3";
    let placed = [
        ("avatar", 0, 0),
        ("f0", 20, 10),
        ("f2", 40, 10),
        ("fd", 60, 10),
        ("tt", 80, 10),
        ("t0", 100, 10),
        ("m", 120, 10),
    ];
    let mut vector = Vector::new(sprites, "", &placed, 1);
    let expected = [("f0", 0), ("f2", 2), ("fd", 1), ("tt", 1), ("t0", -1), ("m", 2)];
    for tick in 0..5 {
        vector.step(Action::Nil);
        for (name, last) in expected {
            assert_eq!(!vector.all(name).is_empty(), tick <= last, "{name} after tick {tick}");
        }
        if tick <= 2 {
            assert_eq!(vector.place("m").0, 120 + 10 * tick);
        }
    }
}

/// T2: spreaders spread in their second update, with eight draws in total. The new sprites are updated from
/// the next tick on.
#[test]
fn spreaders() {
    let sprites = "avatar > MovingAvatar\nx > Immovable\ns > Spreader limit=4 spreadprob=0.5 stype=x\nq > Spreader limit=4 spreadprob=0.5 stype=z\nz > RandomNPC";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("s", 30, 10), ("q", 60, 20)], 1);
    let mut chance = Chance::from_java(1);
    vector.play(".");
    assert_eq!(vector.state.chance(), chance);
    vector.play(".");
    for _ in 0..8 {
        chance.double();
    }
    assert_eq!(vector.state.chance(), chance);
    assert_eq!(vector.spots("z"), [(50, 20), (60, 30), (70, 20)]);
    assert_eq!(vector.spots("x"), [(20, 10)]);
    vector.play(".");
    assert_eq!([(); 3].map(|()| chance.below(4)), [3, 3, 3]);
    assert_eq!(vector.spots("z"), [(60, 20), (70, 30), (80, 20)]);
    vector.play("..");
    assert_eq!((vector.all("s").len(), vector.all("q").len()), (1, 1), "after tick 4");
    vector.play(".");
    assert_eq!((vector.all("s").len(), vector.all("q").len()), (0, 0));
}

/// T3: the positions and draws of random walkers with seed 1, and the direction of the walker that turns in
/// place.
#[test]
fn random_walkers() {
    let sprites = "avatar > MovingAvatar\na > RandomNPC cons=2\nb > RandomNPC speed=0\nc > RandomNPC orientation=LEFT\nd > RandomNPC cooldown=3 cons=1\ne > RandomNPC orientation=LEFT rotateInPlace=True";
    let placed =
        [("avatar", 0, 70), ("a", 40, 20), ("b", 80, 20), ("c", 130, 20), ("d", 190, 20), ("e", 240, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 1);
    let mut chance = Chance::from_java(1);
    let (up, down, left, right) = ((0.0, -1.0), (0.0, 1.0), (-1.0, 0.0), (1.0, 0.0));
    let rows: [(&[i32], _, _); 6] = [
        (&[2, 0, 1], [(40, 20), (70, 20), (130, 10), (190, 20), (240, 20)], down),
        (&[1, 0, 0, 1], [(40, 20), (60, 20), (120, 10), (190, 20), (240, 30)], left),
        (&[2, 3, 2, 0], [(40, 10), (60, 30), (110, 10), (190, 10), (230, 30)], down),
        (&[0, 3, 0, 3], [(40, 0), (70, 30), (100, 10), (190, 10), (230, 40)], up),
        (&[2, 3, 3], [(40, -10), (80, 30), (90, 10), (190, 10), (230, 30)], down),
        (&[3, 1, 1, 3, 1], [(30, -10), (90, 30), (80, 10), (180, 10), (230, 40)], right),
    ];
    for (draws, places, facing) in rows {
        vector.step(Action::Nil);
        let tick = vector.state.tick();
        assert_eq!(["a", "b", "c", "d", "e"].map(|name| vector.place(name)), places, "tick {tick}");
        assert_eq!(vector.one("e").orientation, facing, "tick {tick}");
        let drawn: Vec<i32> = draws.iter().map(|_| chance.below(4)).collect();
        assert_eq!(drawn, draws, "tick {tick}");
        assert_eq!(vector.state.chance(), chance, "tick {tick}");
    }
}

/// T4: a chaser draws from one option, and an AlternateChaser from two equal options. The third sprite never
/// sees a target.
#[test]
fn chasers() {
    let sprites = "t > Immovable\nnone1 > Immovable\nc > Chaser stype=t\nd > AlternateChaser stype1=t stype2=t\ne > AlternateChaser stype1=none1 stype2=t fleeing=True\navatar > MovingAvatar";
    let placed =
        [("avatar", 0, 70), ("c", 40, 20), ("d", 80, 20), ("e", 130, 20), ("t", 180, 20), ("t", 230, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 1);
    vector.step(Action::Nil);
    assert_eq!([vector.place("c"), vector.place("d"), vector.place("e")], [(50, 20), (90, 20), (130, 30)]);
    let mut chance = Chance::from_java(1);
    for _ in 0..5 {
        chance.below(4);
        chance.below(2);
        chance.below(1);
        assert_eq!(vector.state.chance(), chance, "tick {}", vector.state.tick());
        vector.step(Action::Nil);
    }
}

/// T5: a spaceship shoots twice, turns and thrusts.
#[test]
fn spaceship() {
    let sprites = "avatar > SpaceshipAvatar stype=b physicstype=CONT\nb > Missile physicstype=CONT speed=3";
    let mut vector = Vector::new(sprites, "", &[("avatar", 90, 20)], 1);
    vector.play(".X");
    assert_eq!(vector.spots("b"), [(100, 20), (100, 20)]);
    assert_eq!(vector.all("b")[0].orientation, (1.0, 0.0));
    vector.play("U");
    let avatar = vector.one("avatar");
    assert_eq!((avatar.orientation, avatar.speed), ((1.0, 0.0), 1.0));
    assert_eq!(vector.spots("b"), [(103, 20), (103, 20)]);
    vector.play("R");
    assert_eq!(vector.place("avatar"), (91, 20));
    vector.play("X");
    assert_eq!(vector.place("avatar"), (92, 20));
    let shots = vector.all("b");
    assert_eq!(shots.len(), 4);
    assert_eq!((shots[3].rect.x, shots[3].rect.y), (101, 22));
    assert_eq!(shots[3].orientation, (0.955_336_489_125_606, 0.295_520_206_661_339_55));
}

/// T6: an avatar leaves sprites behind, which are walls by default.
#[test]
fn leaves_a_trail() {
    let placed = [("avatar", 90, 20)];
    let path = [(90, 20), (100, 20), (110, 20), (110, 10), (120, 10), (130, 10)];
    for (param, left) in [("spawnBehind=trail", "trail"), ("", "wall")] {
        let sprites = format!("trail > Immovable\navatar > OngoingTurningAvatar {param}");
        let mut vector = Vector::new(&sprites, "", &placed, 1);
        assert_eq!(vector.places("avatar", "..LUR."), path);
        assert_eq!(vector.spots(left), path[..5], "{param}");
    }
}

/// T7: an avatar falls, lands and jumps, and a walker walks.
#[test]
fn platformer_and_walker() {
    let sprites = "ground > Immovable solid=True\nk > Walker physicstype=CONT gravity=0.5 orientation=LEFT\navatar > PlatformerAvatar physicstype=CONT gravity=1.0 mass=1 friction=0.1 jump_strength=8";
    let rules = "avatar ground > wallStop\nk ground > wallReverse";
    let mut placed = vec![("avatar", 10, 10), ("k", 100, 30)];
    placed.extend((0..30).map(|column| ("ground", 10 * column, 50)));
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    let heights = [10, 10, 10, 11, 13, 16, 19, 23, 27, 32, 37, 40];
    let walks = [100, 95, 91, 87, 83, 79, 75, 71, 67, 67, 64, 59];
    let speeds = [(1, 0.9), (2, 1.71), (3, 2.439), (4, 3.095_1), (11, 1.0)];
    const ON_GROUND: u16 = 8;
    for (tick, (height, walk)) in heights.into_iter().zip(walks).enumerate() {
        vector.step(Action::Nil);
        let (avatar, walker) = (vector.one("avatar"), vector.one("k"));
        assert_eq!((avatar.rect.y, walker.rect.x), (height, walk), "tick {tick}");
        if let Some((_, speed)) = speeds.iter().find(|(at, _)| *at == tick) {
            assert!((avatar.speed - speed).abs() < 1e-12, "tick {tick}: {}", avatar.speed);
        }
        if tick == 1 {
            assert_eq!(walker.orientation, (-0.995_037_190_209_989_2, 0.099_503_719_020_998_92));
        }
        let grounded = walker.flags & ON_GROUND != 0;
        assert!(if tick < 8 { !grounded } else { tick > 8 || grounded }, "tick {tick}");
    }
    let avatar = vector.one("avatar");
    assert_eq!((avatar.orientation, avatar.flags & ON_GROUND), ((0.0, 0.0), ON_GROUND));
    vector.step(Action::Use);
    let avatar = vector.one("avatar");
    assert_eq!((avatar.rect.y, avatar.orientation, avatar.speed), (35, (0.0, -1.0), 8.0));
    vector.step(Action::Nil);
    assert_eq!((vector.place("avatar").1, vector.one("avatar").speed), (27, 6.3));
}

/// T7, on the grid: a walker moves five cells per tick, in a direction that it draws once.
#[test]
fn a_walker_on_the_grid() {
    let mut vector =
        Vector::new("avatar > MovingAvatar\nk > Walker", "", &[("avatar", 0, 0), ("k", 100, 30)], 1);
    assert_eq!(vector.places("k", "...."), [(150, 30), (200, 30), (250, 30), (300, 30)]);
    let mut chance = Chance::from_java(1);
    assert_eq!(chance.below(2), 1);
    assert_eq!(vector.state.chance(), chance);
}

/// T8: checks the draws of producers, and the ticks in which they fire.
#[test]
fn producers() {
    let sprites = "avatar > MovingAvatar\na > SpawnPoint stype=z cooldown=3 prob=0.5 total=2\nb > RandomBomber stype=y cooldown=2\nc > BomberRandomMissile stypeMissile=y,z cooldown=2 speed=0.5\nd > SpawnPointMultiSprite stypes=y,z cooldown=3 total=3\ny > Immovable\nz > RandomMissile timeToLive=2";
    let placed = [("avatar", 0, 70), ("a", 20, 20), ("b", 100, 40), ("c", 140, 20), ("d", 200, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 1);
    let mut chance = Chance::from_java(1);
    let mut met = 0;
    for tick in 0..9 {
        let new = vector.all("z").len() - met;
        met += new;
        vector.step(Action::Nil);
        for _ in 0..new {
            chance.below(4);
        }
        if tick <= 3 {
            chance.float();
        }
        let missile = chance.below(2);
        chance.float();
        let way = chance.below(4);
        chance.float();
        let roll = chance.float();
        assert_eq!(vector.state.chance(), chance, "tick {tick}");
        match tick {
            0 => {
                assert_eq!((missile, way), (0, 1));
                assert!((roll - 0.036).abs() < 1e-3, "{roll}");
                // One sprite comes from each of d, c and b, which its cooldown keeps in place. The other two
                // sprites come from d and a.
                assert_eq!(vector.spots("y"), [(200, 20), (140, 20), (100, 40)]);
                assert_eq!(vector.spots("z"), [(200, 20), (20, 20)]);
            }
            3 => assert!((roll - 0.506).abs() < 1e-3, "{roll}"),
            _ => {}
        }
        assert_eq!(vector.all("d").len(), usize::from(tick < 3), "tick {tick}");
        assert!(vector.all("z").len() >= met, "no missile is ever gone: tick {tick}");
    }
    assert!(!vector.all("a").is_empty(), "its second roll failed");
}

/// T9: a spawner that is made in a tick is updated in that tick, and counts from that tick.
#[test]
fn the_phase_of_spawners() {
    let sprites = "avatar > MovingAvatar\na > SpawnPoint stype=z cooldown=5\nq > SpawnPoint stype=a total=1\nz > Immovable";
    let mut vector = Vector::new(sprites, "", &[("avatar", 0, 70), ("q", 30, 20)], 1);
    let mut chance = Chance::from_java(1);
    chance.float();
    for tick in 0..12 {
        vector.step(Action::Nil);
        chance.float();
        assert_eq!(vector.state.chance(), chance, "tick {tick}");
        assert_eq!(vector.all("z").len(), 1 + tick / 5, "tick {tick}");
        assert_eq!((vector.all("q").len(), vector.all("a").len()), (0, 1), "tick {tick}");
    }
}

/// T10: shots may cost more ammunition than the avatar has.
#[test]
fn ammunition() {
    let sprites =
        "r > Resource limit=9\nb > Missile\navatar > FlakAvatar stype=b ammo=r minAmmo=1 ammoCost=3";
    let rules = "r avatar > collectResource";
    let placed = [("avatar", 50, 10), ("r", 60, 10), ("r", 70, 10)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    vector.play("RRX");
    assert_eq!(vector.all("b").len(), 1);
    vector.play("XX");
    assert_eq!(vector.all("b").len(), 1);
    assert_eq!(vector.game.held_by_avatar(&vector.state), [("r".to_owned(), -1)]);
}

/// T11: oriented avatars face and move.
#[test]
fn oriented_avatars() {
    let (up, left, right) = ((0.0, -1.0), (-1.0, 0.0), (1.0, 0.0));
    let check = |params: &str, expected: [((i32, i32), (f64, f64)); 7]| {
        let sprites = format!("avatar > OrientedAvatar {params}");
        let mut vector = Vector::new(&sprites, "", &[("avatar", 50, 10)], 1);
        for (action, (place, facing)) in actions("UULRRR.").zip(expected) {
            vector.step(action);
            let tick = vector.state.tick();
            assert_eq!((vector.place("avatar"), vector.one("avatar").orientation), (place, facing), "{tick}");
        }
    };
    let turning = [(50, 10), (50, 0), (50, 0), (50, 0), (60, 0), (70, 0), (70, 0)];
    let facing = [up, up, left, right, right, right, right];
    check("", std::array::from_fn(|tick| (turning[tick], facing[tick])));
    let slow = [(50, 10), (50, 5), (50, 5), (55, 5), (55, 5), (60, 5), (60, 5)];
    let facing = [right, up, up, right, right, right, right];
    check("rotateInPlace=False speed=0.5 cooldown=2", std::array::from_fn(|tick| (slow[tick], facing[tick])));
}

/// T12: the avatar always moves ahead. A shot flies in the direction faced after the move, and starts to move
/// in the next tick.
#[test]
fn shoots_as_it_goes() {
    let sprites = "b > Missile\navatar > OngoingShootAvatar stype=b";
    let mut vector = Vector::new(sprites, "", &[("avatar", 50, 10)], 1);
    assert_eq!(vector.places("avatar", ".UUX"), [(50, 10), (50, 0), (50, -10), (50, -20)]);
    assert_eq!(vector.spots("b"), [(50, -30)]);
    vector.play("R");
    assert_eq!((vector.place("avatar"), vector.spots("b")), ((60, -20), vec![(50, -40)]));
    vector.play("X");
    assert_eq!((vector.place("avatar"), vector.spots("b")[1]), ((70, -20), (80, -20)));
    vector.play(".");
    assert_eq!((vector.place("avatar"), vector.spots("b")[1]), ((80, -20), (90, -20)));
}

/// T13: characters with continuous physics make random draws and measure distances.
#[test]
fn drifting_characters() {
    let sprites = "n > RandomInertial friction=0.1\na > RandomAltChaser stype1=avatar stype2=avatar epsilon=0.5\nf > Fleeing stype=avatar maxDistance=70\navatar > MovingAvatar";
    let placed = [("avatar", 50, 10), ("n", 40, 20), ("a", 70, 20), ("f", 110, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 9);
    let mut chance = Chance::from_java(9);
    vector.play(".");
    assert_eq!(chance.below(2), 1);
    assert!((chance.double() - 0.253).abs() < 1e-3);
    assert_eq!([chance.below(4), chance.below(4)], [3, 3]);
    assert_eq!(vector.state.chance(), chance);
    vector.play(".");
    assert_eq!(chance.below(4), 3);
    assert!((chance.double() - 0.591).abs() < 1e-3);
    assert_eq!([chance.below(4), chance.below(4)], [3, 0]);
    assert_eq!(vector.state.chance(), chance);
    let n = vector.one("n");
    assert_eq!((n.rect.x, n.rect.y, n.speed), (41, 20, 1.345_362_404_707_371_1));
    assert_eq!(n.orientation, (0.668_964_731_622_449_6, -0.743_294_146_247_166_3));
}

/// T14, the bird: it falls, flaps once, and drifts to the right while it is slow.
#[test]
fn bird() {
    let sprites = "avatar > BirdAvatar physicstype=CONT gravity=1.0";
    let mut vector = Vector::headed("square_size=28", sprites, "", &[("avatar", 20, 70)], 1);
    let path =
        [(56, 196), (57, 196), (57, 196), (58, 197), (59, 199), (61, 190), (64, 182), (68, 175), (72, 169)];
    assert_eq!(vector.places("avatar", "...."), path[..4]);
    assert_eq!(vector.places("avatar", "X"), path[4..5]);
    let avatar = vector.one("avatar");
    assert_eq!(avatar.orientation, (0.287_347_885_566_345_4, -0.957_826_285_221_151_3));
    assert_eq!(avatar.speed, 10.440_306_508_910_55);
    assert_eq!(vector.places("avatar", "...."), path[5..]);
}

/// T14, the car: its engine is always on, forwards or backwards, and friction changes nothing.
#[test]
fn car() {
    let sprites = "avatar > CarAvatar physicstype=CONT friction=0.2";
    let mut vector = Vector::new(sprites, "", &[("avatar", 80, 20)], 1);
    let mut columns = [0, 6, 10, 14, 18, 22, 25, 28].into_iter().map(|x| 80 + x);
    for (tick, action) in actions(".RUXLD.U").enumerate() {
        vector.step(action);
        let avatar = vector.one("avatar");
        assert_eq!(Some(avatar.rect.x), columns.next(), "tick {tick}");
        match tick {
            1 => {
                assert_eq!(avatar.orientation, (0.999_688_817_841_612_3, 0.024_945_289_784_640_872));
                assert_eq!(avatar.speed, 5.990_635_256_745_35);
            }
            5 => assert_eq!(avatar.speed, 4.001_728_466_975_15),
            _ => {}
        }
    }
}

/// T14, the artillery: it aims up, then shoots. There is one shot if the type is a singleton, and otherwise
/// there are two shots.
#[test]
fn artillery() {
    for (param, shots) in [("singleton=True", 1), ("", 2)] {
        let sprites = format!("b > Missile physicstype=CONT speed=25 {param}\navatar > AimedAvatar stype=b");
        let mut vector = Vector::headed("square_size=36", &sprites, "", &[("avatar", 10, 70)], 1);
        vector.play(".RU");
        assert_eq!(vector.one("avatar").orientation, (0.988_771_077_936_042_2, -0.149_438_132_473_599_22));
        vector.play("X");
        assert_eq!(vector.spots("b"), vec![(71, 246); shots]);
        vector.play("L");
        assert_eq!(vector.spots("b"), vec![(95, 243); shots]);
    }
}

/// T15: a wizard's blocks are at least five ticks apart, in the direction that the wizard faces.
#[test]
fn wizard() {
    let sprites = "ground > Immovable solid=True\nblk > Immovable\navatar > WizardAvatar physicstype=CONT gravity=1 mass=1 stype=blk";
    let mut placed = vec![("avatar", 10, 40)];
    placed.extend((0..30).map(|column| ("ground", 10 * column, 50)));
    let mut vector = Vector::new(sprites, "avatar ground > wallStop", &placed, 1);
    let blocks = [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1];
    for (tick, action) in actions(".....UULUXR").enumerate() {
        vector.step(action);
        assert_eq!(vector.place("avatar"), (10, if tick < 7 { 40 } else { 39 }), "tick {tick}");
        assert_eq!(vector.all("blk").len(), blocks[tick], "tick {tick}");
    }
    assert_eq!(vector.spots("blk"), [(22, 40)]);
}

/// T16: a chaser sees only along the direction that it drew last.
#[test]
fn a_chaser_with_a_line_of_sight() {
    let sprites = "t > Immovable\ns > LOSChaser stype=t cons=1\navatar > MovingAvatar";
    let placed =
        [("avatar", 0, 70), ("s", 90, 20), ("t", 90, 10), ("t", 90, 30), ("t", 130, 20), ("t", 170, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 3);
    let heights = [20, 30, 40, 50, 60, 50, 40, 30];
    let draws: [Option<(i32, i32)>; 8] =
        [None, Some((4, 2)), None, Some((4, 2)), None, Some((4, 0)), Some((1, 0)), Some((1, 0))];
    let mut chance = Chance::from_java(3);
    for (height, draw) in heights.into_iter().zip(draws) {
        vector.step(Action::Nil);
        let tick = vector.state.tick();
        assert_eq!(vector.place("s"), (90, height), "tick {tick}");
        if let Some((bound, drawn)) = draw {
            assert_eq!(chance.below(bound), drawn, "tick {tick}");
        }
        assert_eq!(vector.state.chance(), chance, "tick {tick}");
    }
}
