//! Small games for tests.

use evaluation::{Subject, SubjectFacts};

/// A stochastic corridor in which the avatar must walk to the right past wandering bugs.
pub(crate) const CORRIDOR: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    exit > Door\n    bug > RandomNPC cooldown=2\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    A > avatar floor\n    e > exit floor\n    b > bug floor\n  InteractionSet\n    avatar wall > stepBack\n    bug wall > stepBack\n    avatar bug > killSprite scoreChange=-1\n    exit avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=exit win=True\n    SpriteCounter stype=avatar win=False\n";

/// Two levels of [`CORRIDOR`].
pub(crate) const LEVELS: [&str; 2] =
    ["wwwwwwwwwww\nwA......b.w\nw.........w\nw........ew\nwwwwwwwwwww\n", "wwwwww\nwA..ew\nwwwwww\n"];

/// Returns the corridor game with its levels.
pub(crate) fn corridor() -> Subject {
    let levels: Vec<_> =
        LEVELS.iter().enumerate().map(|(number, text)| (number, (*text).to_owned(), None)).collect();
    let facts = SubjectFacts { title: "The corridor".to_owned(), ..SubjectFacts::default() };
    Subject::read("corridor", CORRIDOR, &levels, facts).expect("the game is well-formed")
}
