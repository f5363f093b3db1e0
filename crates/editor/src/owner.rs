//! Owners of parameters.

use engine::SpriteClass;

/// The owner of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner<'a> {
    /// The first line.
    Game,
    /// A sprite type with that class, inherited or its own.
    Sprite(Option<SpriteClass>),
    /// An effect, by keyword, and the one that it plans.
    Effect(&'a str, Option<&'a str>),
    /// A termination, by class.
    Termination(&'a str),
    /// A parameter of a `GameSpace`.
    Parameter,
    /// A line that lacks its subject.
    Nobody,
}
