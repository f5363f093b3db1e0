//! A maker of boards for any game: a board is composed of a plan with a landmark, and furnished by the idiom of each type.
//!
//! The idioms are derived from the rules, so nothing here depends on names. A [`BoardVariation`] creates boards and edits
//! them; whether a board is any good is for players to find out.

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
