//! The request for a board.

use super::idiom::Idiom;
use engine::SpriteType;

/// The highest demand: the position of the last level in a course of five levels.
pub(crate) const MAX_DEMAND: u8 = 4;

/// The request for a board: its position in a course (a game's levels in order of difficulty), and its contents.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoardBrief {
    /// The level's position in the course, from 0 to 4: introduce, confirm, combine, twist, exam. Later positions
    /// demand more of the player. The position determines the board size and the numbers of sprites.
    pub demand: u8,
    /// The minimum and maximum numbers of sprites for some types. The numbers for all other types follow from the rules
    /// and from `demand`.
    pub counts: Vec<(SpriteType, (usize, usize))>,
    /// The placement patterns ([`Idiom`]) of some types, which replace the results of [`Idiom::of`].
    pub idioms: Vec<(SpriteType, Idiom)>,
    /// The types that the board must not contain.
    pub without: Vec<SpriteType>,
    /// The numbers of columns and rows, including the border. If `None`, `demand` determines the size.
    pub size: Option<(usize, usize)>,
}

impl BoardBrief {
    /// Creates a request with the default contents for a position in the course, from 0 to 4.
    pub fn of_demand(demand: u8) -> BoardBrief {
        BoardBrief { demand: demand.min(MAX_DEMAND), ..BoardBrief::default() }
    }
}
