//! A generator of boards for any game: a board is composed of a plan with a landmark, and furnished according to the
//! idiom of each type.
//!
//! The idioms are derived from the rules, so nothing here depends on names. A [`BoardVariation`] creates boards and
//! edits them; players have to find out whether a board is good.

mod brief;
mod canvas;
mod dividers;
mod draft;
mod edits;
mod formations;
mod furnish;
mod idiom;
mod kit;
mod plans;
mod tidy;
mod variation;

pub use brief::BoardBrief;
pub use idiom::Idiom;
pub use variation::BoardVariation;
