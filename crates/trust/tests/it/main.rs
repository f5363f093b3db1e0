//! Tests of trust from the viewpoint of publishers and readers: signatures, key sets, the log.

mod keys;
mod log;
