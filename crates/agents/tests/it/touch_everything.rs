//! Tests of the player that touches everything.

use agents::{Budget, Limits, TouchEverything, play};
use base::Seed;
use engine::{Game, Outcome};

/// A game with a gate that a key opens, a trap that kills, and a pebble that does nothing.
const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable\n    key > Resource limit=1\n    gate > Immovable\n    trap > Immovable\n    pebble > Immovable\n    goal > Door\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    k > floor key\n    g > floor gate\n    t > floor trap\n    p > floor pebble\n    x > floor goal\n    A > floor avatar\n  InteractionSet\n    key avatar > collectResource\n    gate avatar > killIfOtherHasMore resource=key limit=1\n    avatar gate > stepBack\n    avatar trap > killSprite\n    avatar wall > stepBack\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=200 win=False\n";

fn played(player: &mut TouchEverything, level: &str) -> (Outcome, usize) {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level(level).unwrap();
    let seed = Seed::from_text("touch");
    let play = play(&game, &level, player, Budget(0), seed, Limits::default());
    let last = play.episode.replay(&game, &level).unwrap();
    player.end(&game.observe(&last));
    (play.episode.outcome, play.episode.actions.len())
}

const LOCKED: &str = "wwwwwwwwww\nwA...p.gxw\nw......www\nw...k....w\nwwwwwwwwww\n";
const TRAPPED: &str = "wwwwwwwwww\nwA.t.....w\nw.......xw\nwwwwwwwwww\n";

#[test]
fn a_gate_is_tried_again_with_the_key() {
    let mut player = TouchEverything::new(Seed::from_text("a"));
    assert_eq!(played(&mut player, LOCKED).0, Outcome::Won);
    assert!(player.experience("wall").unwrap().is_blocking());
    assert!(player.experience("key").unwrap().is_good());
    assert!(player.experience("pebble").unwrap().entered);
    assert!(player.experience("trap").is_none());
}

#[test]
fn what_has_killed_is_avoided_from_then_on() {
    let mut player = TouchEverything::new(Seed::from_text("a"));
    assert_eq!(played(&mut player, TRAPPED).0, Outcome::Lost);
    assert!(player.experience("trap").unwrap().is_deadly());
    assert!(!player.experience("floor").unwrap().is_deadly());
    assert_eq!(played(&mut player, TRAPPED).0, Outcome::Won);
    player.forget();
    assert!(player.experience("trap").is_none());
    assert_eq!(played(&mut player, TRAPPED).0, Outcome::Lost);
}

#[test]
fn the_same_seed_plays_the_same_episode() {
    let of = |seed: &str| played(&mut TouchEverything::new(Seed::from_text(seed)), LOCKED);
    assert_eq!(of("a"), of("a"));
}

#[test]
fn a_plan_goes_all_the_way() {
    let game = Game::from_source(GAME).unwrap();
    let state = game.start(&game.level(LOCKED).unwrap(), Seed::from_text("touch"));
    let mut player = TouchEverything::new(Seed::from_text("a"));
    let plan = player.act(&game.observe(&state), game.actions(&state), 30);
    assert_eq!(plan.len(), 30);
    assert!(plan.iter().any(|action| *action != plan[0]));
}
