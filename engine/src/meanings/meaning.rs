//! The intended meaning of some words.

/// The intended meaning of some words.
#[derive(Debug)]
pub(crate) struct Meaning {
    /// The words, in small letters and digits only.
    pub(super) words: &'static str,
    /// The words of VGDL to write instead, the first that fits; none if a line has to be written anew.
    pub(crate) write: &'static [&'static str],
    /// The advice; empty if the word to write says it all.
    pub(crate) advice: &'static str,
}

pub(super) const fn means(
    words: &'static str,
    write: &'static [&'static str],
    advice: &'static str,
) -> Meaning {
    Meaning { words, write, advice }
}
