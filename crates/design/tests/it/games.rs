//! Small games, as a designer would write them.

/// A complete answer to the first stage.
pub(crate) fn idea(name: &str) -> String {
    format!(
        "NAME: {name}\nIDEA: The player gathers what the board offers, but each step costs time, and every way back is longer than the way there."
    )
}

/// An answer with rules.
pub(crate) fn rules(game: &str) -> String {
    format!("Here are the rules.\n\n```vgdl\n{game}```\n")
}

/// An answer with levels.
pub(crate) fn levels(levels: &[&str]) -> String {
    levels.iter().map(|level| format!("```level\n{level}```\n")).collect()
}

/// A game in which plums are collected.
pub(crate) const PLUMS: &str = "BasicGame
    SpriteSet
        plum > Immovable
        picker > MovingAvatar
    LevelMapping
        p > plum
        P > picker
    InteractionSet
        picker wall > stepBack
        plum picker > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=plum limit=0 win=True
        Timeout limit=60 win=False
";

/// Levels of [`PLUMS`] that can be won.
pub(crate) const PLUM_LEVELS: [&str; 2] =
    ["wwwwwwww\nwP    pw\nw      w\nwwwwwwww\n", "wwwwwwww\nwP    pw\nwp    pw\nwwwwwwww\n"];

/// A game in which crates are pushed into pits.
pub(crate) const PITS: &str = "BasicGame
    SpriteSet
        pit > Immovable
        crate > Passive
        wasp > Missile orientation=LEFT speed=1 cooldown=2
        pusher > MovingAvatar
    LevelMapping
        o > pit
        c > crate
        s > wasp
        P > pusher
    InteractionSet
        pusher wall > stepBack
        pusher pit > stepBack
        crate pusher > bounceForward
        crate wall > undoAll
        crate crate > undoAll
        pit crate > killBoth scoreChange=1
        pusher wasp > killSprite
        wasp wall > reverseDirection
    TerminationSet
        SpriteCounter stype=pit limit=0 win=True
        SpriteCounter stype=pusher limit=0 win=False
        Timeout limit=90 win=False
";

/// Levels of [`PITS`] that can be won.
pub(crate) const PIT_LEVELS: [&str; 2] = [
    "wwwwwwwww\nw       w\nwP c   ow\nwwwwwwwww\n",
    "wwwwwwwww\nw     s w\nwP c   ow\nw  c   ow\nw       w\nwwwwwwwww\n",
];

/// A level of [`PITS`] that cannot be won, because the crate is in a corner.
pub(crate) const LOST_LEVEL: &str = "wwwwwwwww\nwc      w\nwP     ow\nwwwwwwwww\n";

/// A game in which a shot removes targets before they land.
pub(crate) const SHOTS: &str = "BasicGame
    SpriteSet
        shot > Missile orientation=UP singleton=True
        owl > Chaser stype=mouse cooldown=4
        mouse > RandomNPC cooldown=3
        archer > FlakAvatar stype=shot
    LevelMapping
        o > owl
        m > mouse
        P > archer
    InteractionSet
        archer wall > stepBack
        shot wall > killSprite
        owl wall > stepBack
        mouse wall > turnAround
        owl shot > killBoth scoreChange=3
        mouse owl > transformTo stype=owl
    TerminationSet
        SpriteCounter stype=owl limit=0 win=True
        SpriteCounter stype=mouse limit=0 win=False
        Timeout limit=200 win=False
";

/// Levels of [`SHOTS`] that can be won.
pub(crate) const SHOT_LEVELS: [&str; 2] = [
    "wwwwwwwww\nw  o    w\nw       w\nw      mw\nw       w\nwP      w\nwwwwwwwww\n",
    "wwwwwwwww\nw o   o w\nw       w\nw       w\nwm     mw\nw   P   w\nwwwwwwwww\n",
];
