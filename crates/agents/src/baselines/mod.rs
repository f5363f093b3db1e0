//! Players that the planners are measured against.

pub(crate) mod do_nothing;
pub(crate) mod nearest_goal;
pub(crate) mod one_step;
pub(crate) mod random;
