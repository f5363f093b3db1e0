//! The words of games: scene nouns, names and sentences, along with the colours that suit them.

pub(crate) mod dressing;
pub(crate) mod hues;
pub(crate) mod naming;
pub(crate) mod phrase;
pub(crate) mod scene;
pub(crate) mod vocabulary;
pub(crate) mod wording;
