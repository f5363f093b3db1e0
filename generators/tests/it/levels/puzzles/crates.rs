//! Games in which crates are pushed, one for each kind of destination. Unit tests of the crate also use these
//! games.

use engine::Game;

/// Returns a game in which crates are pushed. `sprites`, `mapping` and `rules` define the destination of the
/// crates.
fn crates(sprites: &str, mapping: &str, rules: &str) -> Game {
    let source = format!(
        "BasicGame\n  SpriteSet\n    floor > Immovable\n    wall > Immovable\n{sprites}    porter > MovingAvatar\n  \
         LevelMapping\n    . > floor\n    w > wall\n{mapping}    p > floor porter\n  InteractionSet\n    \
         porter wall > stepBack\n{rules}  TerminationSet\n    SpriteCounter stype=crate win=True\n"
    );
    Game::from_source(&source).unwrap()
}

pub(crate) fn sink() -> Game {
    let sprites = "    drain > Immovable\n    crate > Passive\n";
    let mapping = "    o > floor drain\n    c > floor crate\n";
    let rules =
        "    crate porter > bounceForward\n    crate wall crate > undoAll\n    crate drain > killSprite\n";
    crates(sprites, mapping, rules)
}

pub(crate) fn hole() -> Game {
    let sprites = "    pit > Immovable\n    crate > Passive\n";
    let mapping = "    o > floor pit\n    c > floor crate\n";
    let rules = "    crate porter > bounceForward\n    crate wall crate > undoAll\n    crate pit > killBoth\n    \
                 porter pit > stepBack\n";
    crates(sprites, mapping, rules)
}

pub(crate) fn place() -> Game {
    let sprites =
        "    mat > Immovable\n    load > Passive\n      crate > color=BROWN\n      stored > color=GREEN\n";
    let mapping = "    o > mat\n    c > floor crate\n";
    let rules = "    load porter > bounceForward\n    load wall load > undoAll\n    crate mat > transformTo stype=stored\n    \
                 stored floor > transformTo stype=crate\n";
    crates(sprites, mapping, rules)
}
