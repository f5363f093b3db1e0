//! One file per verb: its flags, what it does, what it prints.

pub(crate) mod conformance;
