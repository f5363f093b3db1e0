//! The test vectors of the specification (`spec/02` §17): positions tick by tick, on boards of blocks of 10 pixels.

use engine::{Action, Chance, Game, SpriteRecord, State};

/// A game of these sprites and rules, and a board with sprites at these pixels.
struct Vector {
    game: Game,
    state: State,
}

impl Vector {
    /// `sprites` are lines of the SpriteSet, the avatar's among them; `placed` gives a sprite type and its pixel place.
    fn new(sprites: &str, rules: &str, placed: &[(&str, i32, i32)], seed: i64) -> Vector {
        let mut names: Vec<&str> = placed.iter().map(|(name, ..)| *name).collect();
        names.sort_unstable();
        names.dedup();
        let symbol =
            |name: &str| char::from(b'a' + names.iter().position(|other| *other == name).unwrap() as u8);
        let mapping: String = names.iter().map(|name| format!("    {} > {name}\n", symbol(name))).collect();
        let source = format!(
            "BasicGame square_size=10\n  SpriteSet\n{sprites}\n  LevelMapping\n{mapping}  InteractionSet\n    avatar wall > stepBack\n{rules}\n  TerminationSet\n    Timeout limit=500 win=False\n"
        );
        let mut board = vec![vec![b' '; 30]; 8];
        for (name, x, y) in placed {
            board[(y / 10) as usize][(x / 10) as usize] = symbol(name) as u8;
        }
        let text: String = board.iter().map(|row| String::from_utf8_lossy(row) + "\n").collect();
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
        let level = game.level(&text).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        let state = game.start_with(&level, Chance::from_java(seed));
        Vector { game, state }
    }

    fn step(&mut self, action: Action) {
        self.game.step(&mut self.state, action);
    }

    fn all(&self, name: &str) -> Vec<SpriteRecord> {
        let stype = self.game.sprite_type(name).unwrap().0;
        self.game.records(&self.state).into_iter().filter(|record| record.stype == stype).collect()
    }

    fn place(&self, name: &str) -> (i32, i32) {
        let all = self.all(name);
        assert_eq!(all.len(), 1, "{name} at tick {}", self.state.tick());
        (all[0].rect.x, all[0].rect.y)
    }
}

fn actions(keys: &str) -> impl Iterator<Item = Action> + '_ {
    keys.chars().map(|key| match key {
        'U' => Action::Up,
        'L' => Action::Left,
        'D' => Action::Down,
        'R' => Action::Right,
        'X' => Action::Use,
        _ => Action::Nil,
    })
}

/// T1: the last tick after which each still exists.
#[test]
fn flickers_and_times_to_live() {
    let sprites = "    avatar > MovingAvatar\n    f0 > Flicker limit=0\n    f2 > Flicker limit=2\n    fd > Flicker\n    tt > Passive timeToLive=2\n    t0 > Passive timeToLive=0\n    m > Missile orientation=RIGHT timeToLive=3";
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

/// T3: random walkers, seed 1.
#[test]
fn random_walkers() {
    let sprites = "    avatar > MovingAvatar\n    a > RandomNPC cons=2\n    b > RandomNPC speed=0\n    c > RandomNPC orientation=LEFT\n    d > RandomNPC cooldown=3 cons=1\n    e > RandomNPC orientation=LEFT rotateInPlace=True";
    let placed =
        [("avatar", 0, 70), ("a", 40, 20), ("b", 80, 20), ("c", 130, 20), ("d", 190, 20), ("e", 240, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 1);
    let rows = [
        [(40, 20), (70, 20), (130, 10), (190, 20), (240, 20)],
        [(40, 20), (60, 20), (120, 10), (190, 20), (240, 30)],
        [(40, 10), (60, 30), (110, 10), (190, 10), (230, 30)],
        [(40, 0), (70, 30), (100, 10), (190, 10), (230, 40)],
        [(40, -10), (80, 30), (90, 10), (190, 10), (230, 30)],
        [(30, -10), (90, 30), (80, 10), (180, 10), (230, 40)],
    ];
    for row in rows {
        vector.step(Action::Nil);
        let got = ["a", "b", "c", "d", "e"].map(|name| vector.place(name));
        assert_eq!(got, row, "tick {}", vector.state.tick());
    }
}

/// T5: a spaceship shoots twice, turns and thrusts.
#[test]
fn spaceship() {
    let sprites =
        "    avatar > SpaceshipAvatar stype=b physicstype=CONT\n    b > Missile physicstype=CONT speed=3";
    let mut vector = Vector::new(sprites, "", &[("avatar", 90, 20)], 1);
    for action in actions(".XUR") {
        vector.step(action);
    }
    assert_eq!(vector.place("avatar"), (91, 20));
    vector.step(Action::Use);
    assert_eq!(vector.place("avatar"), (92, 20));
    let shots = vector.all("b");
    assert_eq!(shots.len(), 4);
    assert_eq!((shots[3].rect.x, shots[3].rect.y), (101, 22));
    assert_eq!(shots[3].orientation, (0.955_336_489_125_606, 0.295_520_206_661_339_55));
}

/// T7: falling, landing, jumping, and a walker beside.
#[test]
fn platformer_and_walker() {
    let sprites = "    ground > Immovable solid=True\n    k > Walker physicstype=CONT gravity=0.5 orientation=LEFT\n    avatar > PlatformerAvatar physicstype=CONT gravity=1.0 mass=1 friction=0.1 jump_strength=8";
    let rules = "    avatar ground > wallStop\n    k ground > wallReverse";
    let mut placed = vec![("ground", 0, 50), ("avatar", 10, 10), ("k", 100, 30)];
    placed.extend((1..30).map(|column| ("ground", 10 * column, 50)));
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    let heights = [10, 10, 10, 11, 13, 16, 19, 23, 27, 32, 37, 40];
    let walks = [100, 95, 91, 87, 83, 79, 75, 71, 67, 67, 64, 59];
    for (height, walk) in heights.into_iter().zip(walks) {
        vector.step(Action::Nil);
        assert_eq!(vector.place("avatar").1, height, "tick {}", vector.state.tick());
        assert_eq!(vector.place("k").0, walk, "tick {}", vector.state.tick());
    }
    vector.step(Action::Use);
    assert_eq!((vector.place("avatar").1, vector.all("avatar")[0].speed), (35, 8.0));
    vector.step(Action::Nil);
    assert_eq!(vector.place("avatar").1, 27);
}

/// T11: facing and moving.
#[test]
fn oriented_avatars() {
    let check = |params: &str, keys: &str, expected: &[(i32, i32)]| {
        let sprites = format!("    avatar > OrientedAvatar {params}");
        let mut vector = Vector::new(&sprites, "", &[("avatar", 50, 10)], 1);
        let got: Vec<(i32, i32)> = actions(keys)
            .map(|action| {
                vector.step(action);
                vector.place("avatar")
            })
            .collect();
        assert_eq!(got, expected, "{params}");
    };
    let turning = [(50, 10), (50, 0), (50, 0), (50, 0), (60, 0), (70, 0), (70, 0)];
    check("", "UULRRR.", &turning);
    let slow = [(50, 10), (50, 5), (50, 5), (55, 5), (55, 5), (60, 5), (60, 5)];
    check("rotateInPlace=False speed=0.5 cooldown=2", "UULRRR.", &slow);
}

/// T10: shots that cost more than there is.
#[test]
fn ammunition() {
    let sprites = "    r > Resource limit=9\n    b > Missile\n    avatar > FlakAvatar stype=b ammo=r minAmmo=1 ammoCost=3";
    let rules = "    r avatar > collectResource";
    let placed = [("avatar", 50, 10), ("r", 60, 10), ("r", 70, 10)];
    let mut vector = Vector::new(sprites, rules, &placed, 1);
    for action in actions("RRXXX") {
        vector.step(action);
    }
    assert_eq!(vector.all("b").len(), 1);
    assert_eq!(vector.game.held_by_avatar(&vector.state), [("r".to_owned(), -1)]);
}

/// T4: a chaser draws among one option, its alternate cousin among two of the same.
#[test]
fn chasers() {
    let sprites = "    t > Immovable\n    none1 > Immovable\n    c > Chaser stype=t\n    d > AlternateChaser stype1=t stype2=t\n    e > AlternateChaser stype1=none1 stype2=t fleeing=True\n    avatar > MovingAvatar";
    let placed =
        [("avatar", 0, 70), ("c", 40, 20), ("d", 80, 20), ("e", 130, 20), ("t", 180, 20), ("t", 230, 20)];
    let mut vector = Vector::new(sprites, "", &placed, 1);
    vector.step(Action::Nil);
    assert_eq!([vector.place("c"), vector.place("d"), vector.place("e")], [(50, 20), (90, 20), (130, 30)]);
}
