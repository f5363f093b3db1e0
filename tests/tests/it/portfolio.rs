//! The portfolio of methods for winning levels.

use agents::{PortfolioConfig, Solution, solve};
use base::Seed;
use engine::{Analysis, Game};

/// A game with a moth that reaches the door in time only with some seeds.
const MOTH: &str = "BasicGame\n  SpriteSet\n    door > Immovable\n    moth > RandomNPC\n    avatar > MovingAvatar\n  LevelMapping\n    d > door\n    m > moth\n  InteractionSet\n    moth wall > stepBack\n    avatar wall > stepBack\n    door moth > killSprite\n  TerminationSet\n    SpriteCounter stype=door win=True\n    Timeout limit=4 win=False\n";

#[test]
fn foresight_proves_nothing_about_other_chance() {
    let game = Game::from_source(MOTH).unwrap();
    let level = game.level("wwwwwww\nwm d  w\nwwwwwww\nwA    w\nwwwwwww\n").unwrap();
    let analysis = Analysis::of(&game);
    let config = PortfolioConfig { budget: 6000, foresight: 0.9, ..PortfolioConfig::default() };
    let mut open = 0;
    for number in 0..40 {
        match solve(&analysis, &level, &config, Seed::from_text("moth").child("level", number)).solution {
            Solution::Impossible { .. } => panic!("seed {number} is no proof"),
            Solution::Unknown => open += 1,
            Solution::Won { .. } => {}
        }
    }
    assert!((1..40).contains(&open), "{open} of 40 are open");
}
