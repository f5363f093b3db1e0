//! Baseline players, for comparison with the planners.

pub(crate) mod do_nothing;
pub(crate) mod nearest_goal;
pub(crate) mod one_step;
pub(crate) mod random;
