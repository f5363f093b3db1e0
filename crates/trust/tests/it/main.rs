//! Tests of signatures, sets of keys and logs, from the viewpoints of publishers and readers.

mod keys;
mod log;
