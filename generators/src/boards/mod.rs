//! A board generator for any game. Each board starts from a plan with a landmark, and is furnished according to the
//! idioms of the game's types. A type's idiom is the kind of position that suits its sprites.
//!
//! The idioms are derived from the rules, so nothing in this module depends on names. A [`BoardVariation`] creates and
//! edits boards. Only playing can show whether a board is good.

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
