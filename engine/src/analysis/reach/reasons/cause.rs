//! The reasons why a termination can never hold in a level.

use crate::rules::SpriteType;

/// The reason why a termination can never hold in a level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Too many sprites can never be removed. Each of these sprites is given with the cell in which the level
    /// places it.
    Permanent(Vec<(SpriteType, usize)>),
    /// There can never be more sprites of the counted types than this number.
    AtMost(i64),
    /// Each required removal takes some of a resource, and there is too little of that resource.
    Unpaid(Unpaid),
}

/// Sprites that must be removed for a win, and the resource that each removal takes and that runs out first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unpaid {
    /// The type of one of the sprites that must be removed.
    pub target: SpriteType,
    /// The number of sprites that must be removed.
    pub removals: i64,
    /// The resource that each removal takes from the avatar.
    pub resource: SpriteType,
    /// The minimum amount that one removal takes.
    pub each: i64,
    /// The total amount of the resource that can be obtained.
    pub most: i64,
    /// The indices of the interactions that remove sprites that must be removed.
    pub removing: Vec<usize>,
    /// The indices of the interactions that take the resource.
    pub taking: Vec<usize>,
}
