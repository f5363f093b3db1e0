//! Diagnostics in words: the source of the command line, so that both say the same.

#[path = "../../cli/src/diagnostics/excerpt.rs"]
mod excerpt;
#[path = "../../cli/src/diagnostics/words.rs"]
mod words;

pub(crate) use words::in_words;
