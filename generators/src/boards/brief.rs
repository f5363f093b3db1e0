//! The request for a board.

use super::idiom::Idiom;
use engine::SpriteType;

/// The demand of the last slot of a course.
pub(crate) const MAX_DEMAND: u8 = 4;

/// The request for a board: its demand on the player, and its contents.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoardBrief {
    /// The slot of the course, from 0 to 4: introduce, confirm, combine, twist, exam. It determines the size of the
    /// board and the numbers of things.
    pub demand: u8,
    /// The minimum and maximum numbers of sprites of some types; the other numbers follow from the rules and the demand.
    pub counts: Vec<(SpriteType, (usize, usize))>,
    /// The idioms of types that the caller knows better than [`Idiom::of`].
    pub idioms: Vec<(SpriteType, Idiom)>,
    /// Types that the board must not hold.
    pub without: Vec<SpriteType>,
    /// The columns and rows, including the border; `None` lets the demand decide.
    pub size: Option<(usize, usize)>,
}

impl BoardBrief {
    /// Creates a request with the usual contents for a slot from 0 to 4.
    pub fn of_demand(demand: u8) -> BoardBrief {
        BoardBrief { demand: demand.min(MAX_DEMAND), ..BoardBrief::default() }
    }
}
