//! The request for a board.

use super::idiom::Idiom;
use engine::SpriteType;

/// The maximum demand on the player, which is that of a course's last slot.
pub(crate) const MAX_DEMAND: u8 = 4;

/// The request for a board: its demand on the player, and its contents.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoardBrief {
    /// The slot in the course, from 0 to 4: introduce, confirm, combine, twist, exam. The slot determines the board
    /// size and the numbers of sprites.
    pub demand: u8,
    /// The minimum and maximum numbers of sprites for some types. The numbers for all other types follow from the rules
    /// and the demand.
    pub counts: Vec<(SpriteType, (usize, usize))>,
    /// The idioms of some types, which replace the results of [`Idiom::of`].
    pub idioms: Vec<(SpriteType, Idiom)>,
    /// The types that the board must not contain.
    pub without: Vec<SpriteType>,
    /// The numbers of columns and rows, including the border. If `None`, the demand determines the size.
    pub size: Option<(usize, usize)>,
}

impl BoardBrief {
    /// Creates a request with the default contents for a slot from 0 to 4.
    pub fn of_demand(demand: u8) -> BoardBrief {
        BoardBrief { demand: demand.min(MAX_DEMAND), ..BoardBrief::default() }
    }
}
