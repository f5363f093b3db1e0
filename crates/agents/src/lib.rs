//! Players of games: planners that look ahead with a forward model, and baselines for comparison with them.
//!
//! Budgets are counted in forward-model calls (one `step` of a copied state), never in time. A planner with the same
//! seed and budget therefore plays the same episode on every machine. Separate random-number streams supply a planner's
//! choices, its imagined outcomes and the game's own randomness, so the planner never sees the game's true future
//! (`docs/lab/decisions/0003-determinism.md`).
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod baselines;
mod batch;
mod guides;
mod open_loop;
mod plan_search;
mod planner;
mod play;
mod portfolio;
mod reference;
mod registry;
#[doc(hidden)]
pub mod route;
pub mod search;
mod systematic;
pub mod touch_everything;
mod tree_search;
mod width;

pub use baselines::do_nothing::DoNothing;
pub use baselines::nearest_goal::NearestGoal;
pub use baselines::one_step::{OneStep, OneStepConfig};
pub use baselines::random::Random;
pub use batch::{Batch, BatchError};
pub use guides::heuristics::Heuristic;
pub use open_loop::OpenLoop;
pub use plan_search::random_search::{RandomSearch, RandomSearchConfig};
pub use plan_search::rhea::{Rhea, RheaConfig};
pub use planner::{Budget, Planner};
pub use play::{Limits, Play, Stopped, play, play_until};
pub use portfolio::{PortfolioConfig, Solution, Solved, solve, solve_until, systematic_seed};
pub use reference::ReferencePlanner;
pub use registry::{PLANNERS, PlannerSpec, Player, UnknownPlanner, planner};
pub use systematic::Systematic;
pub use touch_everything::TouchEverything;
pub use tree_search::mcts::{Mcts, MctsConfig};
pub use tree_search::mcts_guided::{GuidedMcts, GuidedMctsConfig};
pub use tree_search::olets::{Olets, OletsConfig};
pub use width::{Width, WidthConfig};
