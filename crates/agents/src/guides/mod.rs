//! Evaluations of states that guide the planners.

pub(crate) mod features;
pub(crate) mod goal_guide;
pub(crate) mod heuristics;
pub(crate) mod progress;
