//! Players of games: planners that look ahead with a forward model, and the floors they are measured against.
//!
//! Budgets are counted in forward-model calls (one `step` of a copied state), never in time, so a planner with the same
//! seed and budget plays the same episode on every machine. A planner's choices, its imagined chance and the game's own
//! chance are three separate streams: it never sees the game's true future (`docs/decisions/0003-determinism.md`).

mod batch;
mod do_nothing;
mod mcts;
mod planner;
mod play;
mod random;
mod registry;

pub use batch::{Batch, BatchError};
pub use do_nothing::DoNothing;
pub use mcts::{Mcts, MctsConfig};
pub use planner::{Budget, Planner};
pub use play::{Limits, Play, play};
pub use random::Random;
pub use registry::{PLANNERS, UnknownPlanner, planner};
