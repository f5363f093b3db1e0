//! Players of games: planners that look ahead with a forward model, and the baselines that they are measured against.
//!
//! Budgets are counted in forward-model calls (one `step` of a copied state), never in time, so a planner with the
//! same seed and budget plays the same episode on every machine. A planner's choices, its imagined outcomes and the
//! game's own randomness are three separate streams: it never sees the game's true future
//! (`docs/decisions/0003-determinism.md`).
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod batch;
mod branches;
mod do_nothing;
mod features;
mod goal_guide;
mod heuristics;
mod mcts;
mod mcts_guided;
mod nearest_goal;
mod olets;
mod one_step;
mod open_loop;
mod planner;
mod play;
mod portfolio;
mod progress;
mod random;
mod random_search;
mod registry;
mod rhea;
#[doc(hidden)]
pub mod route;
pub mod search;
mod sequences;
mod systematic;
pub mod touch_everything;
mod width;

pub use batch::{Batch, BatchError};
pub use do_nothing::DoNothing;
pub use heuristics::Heuristic;
pub use mcts::{Mcts, MctsConfig};
pub use mcts_guided::{GuidedMcts, GuidedMctsConfig};
pub use nearest_goal::NearestGoal;
pub use olets::{Olets, OletsConfig};
pub use one_step::{OneStep, OneStepConfig};
pub use open_loop::OpenLoop;
pub use planner::{Budget, Planner};
pub use play::{Limits, Play, Stopped, play, play_until};
pub use portfolio::{PortfolioConfig, Solution, Solved, solve, solve_until};
pub use random::Random;
pub use random_search::{RandomSearch, RandomSearchConfig};
pub use registry::{PLANNERS, PlannerSpec, Player, UnknownPlanner, planner};
pub use rhea::{Rhea, RheaConfig};
pub use systematic::Systematic;
pub use touch_everything::TouchEverything;
pub use width::{Width, WidthConfig};
