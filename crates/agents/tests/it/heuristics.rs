//! Tests the values of the heuristics.

use agents::Heuristic;
use base::Seed;
use engine::{Action, Game};

/// A game whose cells are ten pixels wide.
const GAME: &str = "BasicGame square_size=10\n  SpriteSet\n    exit > Door\n    far > RandomNPC cons=100\n    near > RandomNPC cons=100\n    coin > Immovable\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    e > exit\n    f > far\n    n > near\n    c > coin\n    p > pit\n  InteractionSet\n    coin avatar > killSprite scoreChange=5\n    exit avatar > killSprite\n    avatar pit > killSprite\n  TerminationSet\n    SpriteCounter stype=coin win=True\n    SpriteCounter stype=avatar win=False\n";

#[track_caller]
fn check(level: &str, action: Action, win_score: f64, simple: f64) {
    let game = Game::from_source(GAME).unwrap();
    let root = game.start(&game.level(level).unwrap(), Seed::from_text("heuristics"));
    let mut state = root.clone();
    game.step(&mut state, action);
    assert_eq!(Heuristic::WinScore.value(&game, &root, &state), win_score);
    assert_eq!(Heuristic::Simple.value(&game, &root, &state), simple);
}

#[test]
fn values_match_hand_computed_ones() {
    // Without portals and NPCs, only the score counts.
    check("Acc", Action::Right, 5.0, 5.0);
    // The portal is three cells away: 30 × 30 × 10. NPCs do not matter if there is a portal.
    check("A n ec", Action::Right, 0.0, -9000.0);
    // The portal is gone, but its type is known, so NPCs still do not matter.
    check("Ae n c", Action::Right, 0.0, 0.0);
    // There are two NPCs of the last type and one of the type before. The distance is three cells, not one.
    check("Afc nn", Action::Nil, 0.0, -1600.0 / 100.0 - 300.0);
    // A win and a loss replace the score.
    check("Ac", Action::Right, 1000.0, 5.0 + 1e17);
    check("Apc", Action::Right, -1000.0, -999_999_999.0);
}
