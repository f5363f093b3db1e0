//! Tests guided MCTS with keys, exits and certain wins.

use agents::{Budget, GuidedMcts, GuidedMctsConfig, Limits, Play, play};
use base::Seed;
use engine::{Game, Outcome};

/// A game whose key is far beyond the look-ahead. The exit, which is locked without the key, is further
/// still. No score shows the way.
const GAME: &str = "BasicGame\n  SpriteSet\n    exit > Door\n    key > Resource limit=1\n    avatar > MovingAvatar\n  LevelMapping\n    e > exit\n    k > key\n  InteractionSet\n    avatar wall > stepBack\n    key avatar > collectResource\n    exit avatar > killIfOtherHasMore resource=key limit=1\n  TerminationSet\n    SpriteCounter stype=exit win=True\n    Timeout limit=300 win=False\n";
const LEVEL: &str = "wwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwk                          Aw\nw wwwwwwwwwwwwwwwwwwwwwwwwwwww\nw                           ew\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\n";

fn played(config: GuidedMctsConfig, calls: u64) -> Play {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level(LEVEL).unwrap();
    let mut planner = GuidedMcts::new(config, Seed::from_text("guided"));
    play(&game, &level, &mut planner, Budget(calls), Seed::from_text("chance"), Limits::default())
}

#[test]
fn keys_are_fetched_for_the_exit() {
    let guided = played(GuidedMctsConfig::default(), 200);
    assert_eq!(guided.episode.outcome, Outcome::Won);
    let blind = GuidedMctsConfig { guidance: 0.0, novelty: 0.0, ..GuidedMctsConfig::default() };
    assert_eq!(played(blind, 200).episode.outcome, Outcome::Lost);
}

/// In a deterministic game, a win that was found is certain, so its last ticks need no search.
#[test]
fn certain_wins_are_played_to_the_end() {
    let config = |commit| GuidedMctsConfig { commit, ..GuidedMctsConfig::default() };
    let [sure, unsure] = [true, false].map(|commit| played(config(commit), 200));
    assert_eq!(sure.episode.outcome, Outcome::Won);
    assert!(sure.calls / (sure.episode.actions.len() as u64) < 200);
    assert!(unsure.calls / (unsure.episode.actions.len() as u64) >= 200);
}
