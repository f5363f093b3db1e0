//! Explanations, for designers, of why a level is not won and how an episode ends.

pub(crate) mod board;
pub(crate) mod causes;
pub(crate) mod culprits;
pub(crate) mod ending;
pub(crate) mod too_soon;
mod words;
