//! Tests of signatures, key sets and logs, from the viewpoints of publishers and readers.

mod keys;
mod log;
