//! Tests of planners by name: saving, loading and budgets.

use agents::{Budget, PLANNERS, Planner, PlannerSpec, ReferencePlanner, planner};
use base::Seed;
use engine::{Action, Episode, Game, Outcome, State};

#[test]
fn only_registered_names_make_planners() {
    let seed = Seed::from_text("names");
    assert!(PLANNERS.iter().all(|name| planner(name, seed).is_ok()));
    let unknown = planner("Mcts", seed).err().unwrap();
    assert!(PLANNERS.iter().all(|name| unknown.to_string().contains(name)));
}

#[test]
fn names_have_budgets() {
    let spec: PlannerSpec = "olets:500".parse().unwrap();
    assert_eq!((spec.name(), spec.budget()), ("olets", Some(Budget(500))));
    assert_eq!(spec.to_string(), "olets:500");
    assert_eq!("olets".parse::<PlannerSpec>().unwrap().budget(), None);
    for (text, words) in [
        ("mtcs", "did you mean `mcts`?"),
        ("mtcs:500", "did you mean `mcts`?"),
        ("mcts:many", "`mcts:500`"),
        ("mcts:-1", "`mcts:500`"),
        ("mcts:18446744073709551615", "a number of calls up to 1000000000"),
        ("", "The planners are do-nothing"),
    ] {
        let error = text.parse::<PlannerSpec>().unwrap_err().to_string();
        assert!(error.contains(words), "{text}: {error}");
    }
}

#[test]
fn reference_planners_are_read_with_their_calls() {
    let read = |name| ReferencePlanner::new(name, 500);
    let planner = read("mcts:70").unwrap();
    assert_eq!((planner.name(), planner.budget(), planner.looks_ahead()), ("mcts:70", Budget(70), true));
    assert_eq!(read("mcts").unwrap().budget(), Budget(500));
    assert!(!read("random").unwrap().looks_ahead());
    for wrong in ["mtcs", "mcts:many", "mcts:", ""] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
    let spends = |name: &str| name.parse::<PlannerSpec>().unwrap().spends_its_budget();
    assert_eq!(["random", "one-step", "mcts"].map(spends), [false, false, true]);
}

/// A game with randomness, shooting, portals, threats and pushing, which no planner can foresee completely.
const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    exit > Door\n    box > Passive\n    arrow > OrientedFlicker limit=5 singleton=True\n    bug > RandomNPC\n    avatar > ShootAvatar stype=arrow\n  LevelMapping\n    . > floor\n    A > avatar floor\n    e > exit floor\n    b > bug floor\n    x > box floor\n  InteractionSet\n    avatar wall > stepBack\n    bug wall > stepBack\n    box wall > undoAll\n    box avatar > bounceForward\n    bug box > stepBack\n    bug arrow > killSprite scoreChange=1\n    avatar bug > killSprite scoreChange=-1\n    exit avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=exit win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n";
const LEVEL: &str = "wwwwwwwwwww\nwA..x....bw\nw.........w\nw..b.w..x.w\nw....w...ew\nwwwwwwwwwww\n";

fn playing(name: &str, decisions: usize, saved_after: Option<usize>) -> (Vec<Action>, Vec<u64>, Outcome) {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level(LEVEL).unwrap();
    let mut player = name.parse::<PlannerSpec>().unwrap().player(Seed::from_text(name));
    let (mut episode, mut state) = Episode::begin(&game, &level, Seed::from_text("saved"));
    let mut calls = Vec::new();
    for decision in 0..decisions {
        if saved_after == Some(decision) {
            let saved = serde_json::to_string(&player).unwrap();
            player = serde_json::from_str(&saved).unwrap();
            assert_eq!(serde_json::to_string(&player).unwrap(), saved);
        }
        if state.is_over() {
            break;
        }
        let (action, cost) = player.plan(&game, &state, Budget(150));
        calls.push(cost);
        episode.play(&game, &mut state, action);
    }
    (episode.actions, calls, state.outcome())
}

#[test]
fn loaded_planners_continue_identically() {
    for name in PLANNERS {
        let whole = playing(name, 25, None);
        assert_eq!(playing(name, 25, None), whole, "{name} is not a function of its seed");
        for saved_after in [1, 7] {
            assert_eq!(playing(name, 25, Some(saved_after)), whole, "{name} after {saved_after}");
        }
    }
}

/// The game's own random-number stream is hidden: with a different future but the same present, the decision is the
/// same.
#[test]
fn no_planner_foresees_the_future() {
    let game = Game::from_source(GAME).unwrap();
    let state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("present"));
    for name in PLANNERS {
        let plan = |state: &State| {
            name.parse::<PlannerSpec>().unwrap().player(Seed::from_text(name)).plan(&game, state, Budget(300))
        };
        let decisions: Vec<_> =
            (0..4).map(|i| plan(&state.fork(Seed::from_text("f").child("f", i)))).collect();
        assert!(decisions.iter().all(|decision| *decision == decisions[0]), "{name}: {decisions:?}");
    }
}

#[test]
fn budgets_are_exceeded_by_at_most_one_iteration() {
    let game = Game::from_source(GAME).unwrap();
    let state = game.start(&game.level(LEVEL).unwrap(), Seed::from_text("budget"));
    for name in ["random-search", "rhea", "mcts", "guided-mcts", "olets"] {
        for budget in [0, 1, 5, 60, 1000] {
            let mut player = name.parse::<PlannerSpec>().unwrap().player(Seed::from_text(name));
            let (action, calls) = player.plan(&game, &state, Budget(budget));
            assert!((budget..budget + 40).contains(&calls), "{name}:{budget} took {calls} calls");
            assert!(action == Action::Nil || game.actions(&state).contains(&action));
        }
    }
}
