//! Tests of whole runs with a scripted designer.

mod games;
mod runs;
mod scores;
mod scripted;
