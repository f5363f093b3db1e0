//! Tests plans of several actions.

use agents::{Budget, Mcts, MctsConfig, OpenLoop, Planner};
use base::Seed;
use engine::{Game, State};

/// Returns a corridor with a gem at its end, and with a ghost that walks at random if the level contains its symbol.
fn corridor(level: &str) -> (Game, State) {
    let game = Game::from_source(
        "BasicGame
    SpriteSet
        wall > Immovable
        gem > Immovable
        ghost > RandomNPC
        avatar > MovingAvatar
    LevelMapping
        w > wall
        g > gem
        r > ghost
        A > avatar
    InteractionSet
        avatar wall > stepBack
        ghost wall > stepBack
        gem avatar > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=gem limit=0 win=True
",
    )
    .unwrap();
    let level = game.level(level).unwrap();
    let state = game.start(&level, Seed::from_text("corridor"));
    (game, state)
}

fn mcts() -> Mcts {
    Mcts::new(MctsConfig::default(), Seed::from_text("planner"))
}

#[test]
fn without_chance_a_plan_is_what_looks_would_choose() {
    let (game, mut state) = corridor("wwwwwwww\nwA    gw\nwwwwwwww");
    let mut open = OpenLoop::new(mcts(), Budget(300), Seed::from_text("open"));
    let (plan, _) = open.plan(&game, &state, 40);
    let mut closed = mcts();
    for &action in &plan {
        assert_eq!(closed.plan(&game, &state, Budget(300)).0, action);
        game.step(&mut state, action);
    }
    assert!(state.is_over() && plan.len() < 40, "a plan ends with the game: {plan:?}");
}

#[test]
fn one_action_is_the_choice_of_the_planner() {
    let (game, state) = corridor("wwwwwwww\nwA r  gw\nw  r   w\nwwwwwwww");
    let mut open = OpenLoop::new(mcts(), Budget(200), Seed::from_text("open"));
    let (action, calls) = mcts().plan(&game, &state, Budget(200));
    assert_eq!(open.plan(&game, &state, 1), (vec![action], calls));
}

#[test]
fn the_games_own_chance_is_not_foreseen() {
    let (game, state) = corridor("wwwwwwww\nwA r  gw\nw  r   w\nwwwwwwww");
    let other = state.fork(Seed::from_text("another future"));
    let plan = |state| OpenLoop::new(mcts(), Budget(50), Seed::from_text("open")).plan(&game, state, 20);
    assert_eq!(plan(&state), plan(&other));
}
