//! The body of a sprite type: which sprites stop which, and the effects of being stopped.
//!
//! Patterns only state which body their sprites have; every rule of movement follows from it. So for every combination of
//! patterns in a game, nothing walks through a door, and nothing leaves the board.

use super::effect::Effect;

/// The part that a sprite type plays in movement. The order is that of the SpriteSet, and so of drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Body {
    /// Lies under everything.
    Floor,
    /// Stops everything.
    Wall,
    /// Lies flat: everything passes.
    Flat,
    /// A place that matters: everything passes except pushed things, which would hide it.
    Spot,
    /// An item to be taken: behaves as a spot.
    Item,
    /// Stops everything except the hero, who digs.
    Soft,
    /// Stops everything.
    Solid,
    /// Stops only the hero, its shots and crates, since other sprites come out of it.
    Den,
    /// Is pushed, and stops everything.
    Crate,
    /// Moves to and fro, and carries.
    Carrier,
    /// Moves about by itself.
    Walker,
    /// Moves straight, and turns round at obstacles.
    Patroller,
    /// Moves straight, and turns in any other direction at obstacles.
    Drifter,
    /// Is shot by a foe, or falls; is destroyed at obstacles.
    FoeShot,
    /// A cloud, a flame or a puddle: exists for a while, and not inside obstacles.
    Puff,
    /// Is shot by the hero; is destroyed at obstacles.
    Shot,
    /// The hero.
    Hero,
}

impl Body {
    /// Returns `true` if `obstacle` stops this body.
    pub(crate) fn is_stopped_by(self, obstacle: Body) -> bool {
        use Body as B;
        match self {
            B::Hero => matches!(obstacle, B::Wall | B::Solid | B::Den | B::Crate),
            B::Walker | B::Patroller | B::Drifter | B::Carrier | B::FoeShot | B::Puff => {
                matches!(obstacle, B::Wall | B::Solid | B::Soft | B::Crate)
            }
            B::Shot => matches!(obstacle, B::Wall | B::Solid | B::Den | B::Soft | B::Crate),
            B::Crate => !matches!(obstacle, B::Floor | B::Flat | B::FoeShot | B::Puff | B::Shot | B::Hero),
            _ => false,
        }
    }

    /// The effects on this body at an obstacle, in order.
    pub(crate) fn when_stopped(self) -> &'static [Effect] {
        match self {
            Body::Hero | Body::Walker | Body::Crate => &[Effect::StepBack],
            Body::Patroller | Body::Carrier => &[Effect::ReverseDirection, Effect::StepBack],
            Body::Drifter => &[Effect::FlipDirection, Effect::StepBack],
            Body::FoeShot | Body::Puff | Body::Shot => &[Effect::KillSprite],
            _ => &[],
        }
    }
}
