//! What a sprite type is to those that move: who stops whom, and what stopping means.
//!
//! Patterns say what body their sprites have and nothing more; every rule of movement follows from it. So whatever
//! patterns meet in a game, nothing walks through a door, and nothing leaves the board.

use super::effect::Effect;

/// How a sprite type takes part in movement. The order is the order of the SpriteSet, which is the order of drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Body {
    /// Lies under everything.
    Floor,
    /// Stops everything.
    Wall,
    /// Lies flat: everything passes.
    Flat,
    /// A place that matters: all pass but what is pushed, which would hide it.
    Spot,
    /// A thing that lies there, to be taken: as a spot.
    Item,
    /// Stops all but the hero, who digs.
    Soft,
    /// Stops everything.
    Solid,
    /// Stops all but what comes out of it.
    Den,
    /// Is pushed, and stops everything.
    Crate,
    /// Goes to and fro, and carries.
    Carrier,
    /// Goes about by itself.
    Walker,
    /// Goes straight, and turns round at obstacles.
    Patroller,
    /// Goes straight, and any other way from obstacles.
    Drifter,
    /// Is shot by a foe, or falls; ends at obstacles.
    FoeShot,
    /// A cloud, a flame, a puddle: is there for a while, not inside obstacles.
    Puff,
    /// Is shot by the hero; ends at obstacles.
    Shot,
    /// The hero.
    Hero,
}

impl Body {
    /// Whether `obstacle` stops this body.
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

    /// What happens to this body at an obstacle, in order.
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
