//! Evaluations of states, which guide the planners.

pub(crate) mod features;
pub(crate) mod goal_guide;
pub(crate) mod heuristics;
pub(crate) mod progress;
