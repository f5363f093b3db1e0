//! The intended meanings of foreign words.

/// The intended meaning of certain foreign words.
#[derive(Debug)]
pub(crate) struct Meaning {
    /// The foreign words, reduced to lower-case letters and digits.
    pub(super) words: &'static str,
    /// The VGDL words to write instead, of which the first suitable word is used. Empty if the line has to be
    /// rewritten.
    pub(crate) write: &'static [&'static str],
    /// The advice. Empty if the replacement needs no explanation.
    pub(crate) advice: &'static str,
}

pub(super) const fn means(
    words: &'static str,
    write: &'static [&'static str],
    advice: &'static str,
) -> Meaning {
    Meaning { words, write, advice }
}
