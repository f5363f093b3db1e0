//! Tests sprites that keep moving in the same way.

use base::Seed;
use engine::inspect::flight_periods;
use engine::{Action, Game, Outcome};

const INVADERS: &str = "\
BasicGame
    SpriteSet
        invader > Bomber stype=bomb orientation=RIGHT cooldown=3 speed=0.8 prob=0.1
        bomb > Missile orientation=DOWN cooldown=2 speed=0.3
        avatar > MovingAvatar
    LevelMapping
        i > invader
        A > avatar
    InteractionSet
        invader EOS > turnAround
        invader invader > reverseDirection
        bomb EOS > killSprite
        bomb avatar > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=invader limit=0 win=True
";

#[test]
fn periodic_movers_fly_without_a_difference() {
    let game = Game::from_source(INVADERS).unwrap();
    let level = game.level("i i    \n   i   \n       \n       \nA      \n").unwrap();
    let mut state = game.start(&level, Seed::from_text("invaders"));
    let mut plain = state.clone();
    let mut flights = [0; 4];
    for tick in 0..300 {
        let action = if tick % 5 == 0 { Action::Right } else { Action::Nil };
        game.step(&mut state, action);
        game.step_unscheduled(&mut plain, action, &mut ());
        assert_eq!(state.state_hash(), plain.state_hash(), "tick {tick}");
        assert_eq!(state.state_hash(), state.state_hash_from_scratch(), "tick {tick}");
        // Compare with and without hash contributions of earlier ticks.
        if tick % 3 == 0 {
            state.settle_hash();
        }
        for period in flight_periods(&state) {
            flights[usize::from(period)] += 1;
        }
    }
    assert_eq!(state.outcome(), Outcome::Ongoing);
    assert!(flights[2] > 50 && flights[3] > 100, "{flights:?}");
}
