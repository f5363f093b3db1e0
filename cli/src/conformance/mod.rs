//! Golden traces of the reference engine: reading them, and playing along.

mod compare;
mod trace;

pub(crate) use compare::{Difference, compare};
pub(crate) use trace::Trace;
