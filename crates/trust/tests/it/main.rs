//! Trust as publishers and readers meet it: signatures, key sets, the log.

mod keys;
mod log;
