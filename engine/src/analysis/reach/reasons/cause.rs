//! The reasons why a termination can never hold in a level.

use crate::rules::SpriteType;

/// The reason why a termination can never hold in a level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// More sprites than the termination allows can never be removed. Each sprite is paired with the cell in
    /// which the level places it.
    Permanent(Vec<(SpriteType, usize)>),
    /// The number of sprites of the counted types can never exceed this maximum.
    AtMost(i64),
    /// Each required removal costs some of a resource, and not enough of that resource is available.
    Unpaid(Unpaid),
}

/// Sprites that must be removed for a win, and the resource that is too scarce to pay for their removal.
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
    /// The total obtainable amount of the resource.
    pub most: i64,
    /// The indices of the interactions that perform the required removals.
    pub removing: Vec<usize>,
    /// The indices of the interactions that take the resource.
    pub taking: Vec<usize>,
}
