//! Sprite types, as indices.

use crate::flat::bytes_of_wrapper;

/// A sprite type of one game, as an index into the game's registry: `wall` is 0 and `avatar` is 1 in every game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SpriteType(pub u16);

bytes_of_wrapper! { SpriteType }

impl SpriteType {
    /// No type: the value for an undeclared name in games loaded in reference mode.
    pub(crate) const NONE: SpriteType = SpriteType(u16::MAX);

    /// Returns the type's index into tables with one entry per type.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}
