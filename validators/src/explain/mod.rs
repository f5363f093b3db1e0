//! Explanations for designers of why a level was not won and how an episode ended.

pub(crate) mod board;
pub(crate) mod causes;
pub(crate) mod culprits;
pub(crate) mod ending;
pub(crate) mod too_soon;
mod words;
