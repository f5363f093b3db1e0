//! Evaluations of states: what planners steer by.

pub(crate) mod features;
pub(crate) mod goal_guide;
pub(crate) mod heuristics;
pub(crate) mod progress;
