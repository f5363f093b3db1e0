//! Tests games with one rule disabled.

use base::Seed;
use engine::{Action, Game, Level, Outcome};

const GAME: &str = "BasicGame\n  SpriteSet\n    nut > Immovable\n    moth > RandomNPC\n    squirrel > MovingAvatar\n  LevelMapping\n    n > nut\n    m > moth\n    S > squirrel\n  InteractionSet\n    nut squirrel > killSprite scoreChange=1\n    moth nut > flipDirection\n    moth nut > spawn stype=moth prob=0.5\n    moth EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=nut win=True\n    Timeout limit=50\n";

fn episode(game: &Game, level: &Level, actions: &[Action]) -> (Outcome, f64, u64, usize) {
    let mut state = game.start(level, Seed::from_text("ablation"));
    for &action in actions {
        game.step(&mut state, action);
    }
    (state.outcome(), state.score(), state.chance().state(), game.records(&state).len())
}

#[test]
fn nothing_follows_and_the_draws_stay() {
    let game = Game::from_source(GAME).unwrap();
    let level = game.level("Snnnn\nnnmnn").unwrap();
    let (right, wait) = ([Action::Right; 4], [Action::Nil; 6]);
    assert!(episode(&game, &level, &right).1 >= 4.0);
    let (outcome, score, ..) = episode(&game.without(0), &level, &right);
    assert_eq!((outcome, score), (Outcome::Ongoing, 0.0));
    // A rule that draws and then does nothing, because its probability is 0, is equivalent to a disabled
    // rule.
    let never = Game::from_source(&GAME.replace("prob=0.5", "prob=0.0")).unwrap();
    let without = game.without(2);
    assert_eq!(episode(&without, &level, &wait), episode(&never, &level, &wait));
    assert!(episode(&without, &level, &wait).3 < episode(&game, &level, &wait).3);
    assert_eq!(without.digest(), game.without(2).digest());
    assert_ne!(without.digest(), game.digest());
}
