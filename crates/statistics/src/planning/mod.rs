//! Planning of evaluations, by computing the number of episodes needed to detect a difference.

pub(crate) mod design;
pub(crate) mod draws;
pub(crate) mod power;
