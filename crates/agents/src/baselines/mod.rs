//! Baseline players, to which the planners are compared.

pub(crate) mod do_nothing;
pub(crate) mod nearest_goal;
pub(crate) mod one_step;
pub(crate) mod random;
