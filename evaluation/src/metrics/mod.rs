//! What is measured of an episode: a function of its log and of the game, which is played again from the log's seed and actions
//! with every state hash compared. Nothing is measured while the episode is played, so that a metric can be added or mended
//! later without asking a model again (`docs/metrics.md`).
//!
//! What cannot be known is `None`, never 0.

mod answers;
mod as_code;
mod choices;
mod episode;
mod meaningful;
mod movement;
mod replay;

pub use as_code::{AsCode, flags_as_code};
pub use choices::{Choices, Spending};
pub use episode::{EpisodeMetrics, EpisodeStatus};
pub use meaningful::{Effect, WINDOW, meaningful};
pub use movement::Movement;
pub use replay::{Replayed, replay};
