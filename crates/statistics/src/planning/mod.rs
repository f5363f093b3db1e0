//! Planning of evaluations: the number of episodes that shows a difference.

pub(crate) mod design;
pub(crate) mod draws;
pub(crate) mod power;
