//! Golden traces of the reference engine: reading and replaying them.

mod compare;
mod trace;

pub(crate) use compare::{Difference, compare};
pub(crate) use trace::Trace;
