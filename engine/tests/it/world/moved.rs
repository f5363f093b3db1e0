//! Tests the sizes of sprites before their last update.

use base::Seed;
use engine::inspect::widths;
use engine::{Action, Game, State};

/// A game in which a bud that opens becomes a flower of two cells. The flower's last rectangle has the size
/// of a bud until the next update.
const GAME: &str = "BasicGame square_size=10\n  SpriteSet\n    bud > Immovable\n    flower > Immovable wMult=2\n    avatar > MovingAvatar\n  \
                    LevelMapping\n    b > bud\n    f > flower\n    A > avatar\n  InteractionSet\n    bud avatar > transformTo stype=flower\n    \
                    avatar EOS > stepBack\n  TerminationSet\n    Timeout limit=9 win=True\n";

#[test]
fn earlier_sizes_are_kept_until_the_next_update() {
    let game = Game::from_source(GAME).unwrap();
    let mut state = game.start(&game.level("Ab f \n").unwrap(), Seed::from_text("bud"));
    let flower = game.sprite_type("flower").unwrap();
    let sizes = |state: &State| widths(state, flower);
    // The first sprite of a type has the size of a cell until its first update.
    assert_eq!(sizes(&state), [(20, 10)]);
    game.step(&mut state, Action::Right);
    assert_eq!(sizes(&state), [(20, 20), (20, 10)]);
    state.recount(&game).unwrap();
    assert_eq!(state.state_hash(), state.state_hash_from_scratch());
    game.step(&mut state, Action::Nil);
    assert_eq!(sizes(&state), [(20, 20), (20, 20)]);
}
