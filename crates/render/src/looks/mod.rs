//! The looks of sprite types, which determine how each type is drawn: shapes, figures, colours and letters.

pub(crate) mod art;
pub(crate) mod colour;
pub(crate) mod figure;
pub(crate) mod glyph;
pub(crate) mod letters;
pub(crate) mod look;
pub(crate) mod meaning;
mod openings;
mod payments;
pub(crate) mod prospects;
mod remarks;
pub(crate) mod shape;
mod touches;
mod wins;
