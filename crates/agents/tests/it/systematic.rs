//! Tests of the systematic player.

use agents::{Budget, Planner, Systematic};
use base::Seed;
use engine::{Game, Outcome};

const GAME: &str = "BasicGame
    SpriteSet
        floor > Immovable
        wall > Immovable
        hole > Immovable
        box > Passive
        avatar > MovingAvatar
    LevelMapping
        . > floor
        w > wall
        o > hole
        b > box
        A > avatar
    InteractionSet
        avatar wall > stepBack
        box avatar > bounceForward
        box wall > undoAll
        box box > undoAll
        box hole > killSprite
    TerminationSet
        SpriteCounter stype=box limit=0 win=True
";
/// A level in which the far box must be pushed first, from between the two boxes. The avatar gets there round
/// the corner.
const LEVEL: &str = "wwwwwwww\nw.....ow\nw.w.wwww\nwAb..bow\nwwwwwwww\n";

fn played(calls: u64) -> (Outcome, Vec<u64>) {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level(LEVEL).unwrap();
    let mut player = Systematic::new(Seed::from_text("systematic"));
    let mut state = game.start(&level, Seed::from_text("boxes"));
    let mut spent = Vec::new();
    while !state.is_over() && spent.len() < 100 {
        let (action, calls) = player.plan(&game, &state, Budget(calls));
        game.step(&mut state, action);
        spent.push(calls);
    }
    (state.outcome(), spent)
}

/// One search wins, and its plan is played without another search.
#[test]
fn a_win_that_is_found_is_played() {
    let (outcome, spent) = played(5000);
    assert_eq!(outcome, Outcome::Won);
    assert!(spent[0] > 0 && spent[1..].iter().all(|calls| *calls == 0), "{spent:?}");
}

/// Without a win in sight, plans are short and the search continues.
#[test]
fn small_budgets_are_kept() {
    let (_, spent) = played(20);
    assert!(spent.iter().filter(|calls| **calls > 0).count() > 1, "{spent:?}");
    assert!(spent.iter().all(|calls| *calls <= 30), "{spent:?}");
}

#[test]
fn no_budget_is_played_at_random() {
    let (_, spent) = played(0);
    assert!(!spent.is_empty() && spent.iter().all(|calls| *calls == 0), "{spent:?}");
}
