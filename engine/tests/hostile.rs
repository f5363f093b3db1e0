//! Games that would exhaust a careless engine: each ends in a typed outcome, in bounded time and memory.

use engine::{Action, Game, Limit, Outcome, Seed};

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
