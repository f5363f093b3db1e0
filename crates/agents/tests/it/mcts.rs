//! Tests MCTS on a board with a pit.

use agents::{Budget, Limits, Mcts, MctsConfig, Planner, play};
use base::Seed;
use engine::{Game, Outcome};

const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=500 win=False\n";

#[test]
fn pits_are_avoided() {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level("wwwwwww\nwA p gw\nw     w\nwwwwwww\n").unwrap();
    for run in 0..5 {
        let seed = Seed::from_text("mcts").child("run", run);
        let mut planner = Mcts::new(MctsConfig::default(), seed);
        let played = play(&game, &level, &mut planner, Budget(500), seed.child("game", 0), Limits::default());
        assert_eq!(played.episode.outcome, Outcome::Won, "run {run}");
        assert!(played.episode.replay(&game, &level).is_ok());
    }
}

#[test]
fn equal_seeds_give_equal_plans_within_budget() {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level("wwwwwww\nwA p gw\nw     w\nwwwwwww\n").unwrap();
    let state = game.start(&level, Seed::from_text("game"));
    let plan =
        |budget| Mcts::new(MctsConfig::default(), Seed::from_text("a")).plan(&game, &state, Budget(budget));
    assert_eq!(plan(300), plan(300));
    for budget in [1, 10, 100, 1000] {
        assert!((budget..budget + 10).contains(&plan(budget).1), "budget {budget} cost {}", plan(budget).1);
    }
}
