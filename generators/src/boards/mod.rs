//! A board generator for any game. Each board starts from a plan with a landmark, which is its main feature. Sprites
//! are placed according to the [`Idiom`] of their type: the kind of position that suits them.
//!
//! The kinds of position are derived from the rules, so nothing in this module depends on names. A [`BoardVariation`]
//! creates and edits boards. Only playing can show whether a board is good.

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
