//! Summaries of the games of a release.

pub mod rungs;
