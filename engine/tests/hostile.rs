//! Games that would exhaust a careless engine: each ends in a typed outcome, in bounded time and memory.

use engine::{Action, Game, Limit, Outcome, Seed, SpriteClass};

/// Plays nothing but "do nothing" until the episode is over.
fn outcome(sprites: &str, rules: &str, mapping: &str, level: &str) -> Outcome {
    let source = format!(
        "BasicGame\n  SpriteSet\n    avatar > MovingAvatar\n{sprites}\n  LevelMapping\n{mapping}\n  InteractionSet\n{rules}\n  TerminationSet\n    Timeout limit=2100 win=True\n"
    );
    let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
    let level = game.level(level).unwrap_or_else(|problems| panic!("{problems}"));
    let mut state = game.start(&level, Seed::from_text("hostile"));
    for _ in 0..2100 {
        if state.is_over() {
            break;
        }
        game.step(&mut state, Action::Nil);
    }
    assert_eq!(state.state_hash(), state.state_hash_from_scratch(&game));
    state.outcome()
}

/// Everything clones itself: the reference stops at 10,000 sprites with a message each, and 26 messages end the game.
#[test]
fn a_spawn_bomb() {
    let bomb = outcome("    a > Passive", "    a a > cloneSprite", "    a > a a", "Aa\n");
    assert!(matches!(bomb, Outcome::Ended | Outcome::Stopped(Limit::Effects)), "{bomb:?}");
}

/// Two spawners that make each other.
#[test]
fn mutual_spawners() {
    let sprites = "    a > SpawnPoint stype=b\n    b > SpawnPoint stype=a";
    let mutual = outcome(sprites, "    a EOS > stepBack\n    b EOS > stepBack", "    a > a", "Aa\n");
    assert!(matches!(mutual, Outcome::Ended | Outcome::Stopped(_)), "{mutual:?}");
}

/// A crowd in one cell, each of which meets each.
#[test]
fn a_crowd() {
    let crowd =
        outcome("    a > Passive", "    a a > flipDirection", "    a > a a a a a a a a a a", &crowded());
    assert_eq!(crowd, Outcome::Lost, "ten in a cell is nothing");
    let sprites = "    s > SpawnPoint stype=a\n    a > Passive";
    let crowd = outcome(sprites, "    a a > flipDirection", "    s > s s s s s s", "As\n");
    assert_eq!(crowd, Outcome::Stopped(Limit::Effects));
}

fn crowded() -> String {
    format!("A{}\n", "a".repeat(20))
}

/// Types that become each other, tick after tick, and within one.
#[test]
fn transform_cycles() {
    let sprites = "    a > Passive\n    b > Passive";
    let rules = "    a a > transformTo stype=b\n    b b > transformTo stype=a";
    assert_eq!(outcome(sprites, rules, "    a > a a", "Aa\n"), Outcome::Lost);
    let all = "    a a > transformToAll stype=a stypeTo=a";
    assert_eq!(outcome(sprites, all, "    a > a a", "Aa\n"), Outcome::Stopped(Limit::EndlessTransform));
}

/// Each pair plans a timer in each tick.
#[test]
fn timers_without_end() {
    let rules = "    a a > addTimer timer=1000000 ftype=killAll stype=a";
    let timers = outcome("    a > Passive", rules, "    a > a a a a a a a a a a", &crowded());
    assert_eq!(timers, Outcome::Stopped(Limit::Effects));
}

/// Speeds, cooldowns and numbers beyond all measure.
#[test]
fn giant_numbers() {
    let sprites = "    a > Missile orientation=RIGHT speed=1e300\n    b > Missile orientation=LEFT speed=2147483647\n    c > Missile orientation=UP cooldown=2147483647\n    d > Flicker limit=2147483647\n    e > Passive timeToLive=2147483647 healthPoints=2147483647";
    let rules = "    a EOS > wrapAround offset=1e300\n    b EOS > reverseDirection\n    e avatar > addHealthPoints value=2147483647\n    avatar e > subtractHealthPoints value=-2147483648";
    let mapping = "    a > a\n    b > b\n    c > c\n    d > d\n    e > e\n    A > avatar e";
    assert_eq!(outcome(sprites, rules, mapping, "Aabcde\n"), Outcome::Lost);
}

/// Everybody runs from everybody, along paths and without.
#[test]
fn a_crowd_of_chasers() {
    let board = format!("A{}\n{}", "a".repeat(99), format!("{}\n", "a".repeat(100)).repeat(98));
    for sprite in ["Fleeing stype=a", "AlternateChaser stype1=a", "PathChaser stype=avatar"] {
        let source = format!(
            "BasicGame obs=wall\n  SpriteSet\n    avatar > MovingAvatar\n    a > {sprite}\n  LevelMapping\n    a > a\n  InteractionSet\n    avatar a > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n"
        );
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}"));
        let level = game.level(&board).unwrap_or_else(|problems| panic!("{problems}"));
        let mut state = game.start(&level, Seed::from_text("crowd"));
        assert_eq!(game.step(&mut state, Action::Nil), Outcome::Stopped(Limit::Effects), "{sprite}");
    }
}

/// Any class with any parameters and values beyond all measure, loaded both ways: it ends in a typed outcome or goes on.
#[test]
fn any_parameters() {
    const VALUES: [&str; 22] = [
        "0",
        "1",
        "2",
        "-1",
        "-2147483648",
        "2147483647",
        "0.5",
        "-0.5",
        "1e300",
        "-1e300",
        "1e-300",
        "NaN",
        "Infinity",
        "True",
        "False",
        "UP",
        "LEFT",
        "NIL",
        "CONT",
        "a",
        "a,b",
        "ghost",
    ];
    const BASE: [&str; 26] = [
        "speed",
        "cooldown",
        "physicstype",
        "orientation",
        "rotateInPlace",
        "is_static",
        "mass",
        "gravity",
        "friction",
        "max_speed",
        "jump_strength",
        "solid",
        "wMult",
        "hMult",
        "healthPoints",
        "timeToLive",
        "singleton",
        "is_resource",
        "is_avatar",
        "hidden",
        "rotation",
        "orientedImg",
        "lastmove",
        "isFirstTick",
        "on_ground",
        "is_from_avatar",
    ];
    let rules = "    me a > transformTo stype=b\n    b a > wallBounce\n    me b > wallStop\n    b wall > wallReverse\n    b wall > bounceForward\n    a me > collectResource\n    me wall > pullWithIt\n    b EOS > wrapAround\n    me wall > stepBack pixelPerfect=True\n    a wall > turnAround\n    me b > bounceDirection";
    let mut sampler = Seed::from_text("any parameters").sampler();
    let mut played = 0;
    for class in SpriteClass::ALL.iter().cycle().take(1500) {
        let own = class.parameters();
        let mut params = || {
            let many = sampler.between(1, 5);
            let one = |_| {
                let key = *sampler.choose(&BASE);
                let key =
                    if own.is_empty() || sampler.between(0, 1) == 0 { key } else { *sampler.choose(&own) };
                format!(" {key}={}", sampler.choose(&VALUES))
            };
            (0..many).map(one).collect::<String>()
        };
        let (avatar, other) =
            if class.is_avatar() { (class.name(), "Missile") } else { ("MovingAvatar", class.name()) };
        let source = format!(
            "BasicGame square_size=10\n  SpriteSet\n    me > {avatar} stype=b{}\n    b > {other} stype=a stype1=a stypes=a,a stypeMissile=a,a resource_name=a{}\n    a > Resource{}\n  LevelMapping\n    m > me\n    b > b\n    a > a\n  InteractionSet\n{rules}\n  TerminationSet\n    Timeout limit=100 win=True\n",
            params(),
            params(),
            params()
        );
        for game in
            [Game::from_source(&source), Game::from_source_as_reference(&source)].into_iter().flatten()
        {
            let Ok(level) = game.level("w w w w\n ba  b \n am b  \n  w w b\n") else { continue };
            let mut state = game.start(&level, Seed::from_text("any"));
            for action in Action::ALL.iter().cycle().take(18) {
                game.step(&mut state, *action);
                assert_eq!(state.state_hash(), state.state_hash_from_scratch(&game), "{source}");
            }
            let _ = (state.search_key(&game), game.observe(&state));
            played += 1;
        }
    }
    assert!(played > 500, "only {played} of the games load");
}
