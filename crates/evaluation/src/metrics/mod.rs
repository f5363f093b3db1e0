//! The metrics of an episode, computed from its log and its game (`docs/reference/metrics.md`).
//!
//! The game is replayed from the seed and the actions in the log, and every state hash is compared. Nothing
//! is measured during play, so metrics can be added or corrected later without querying a model again.
//! Unknown values are `None`, never 0.

mod answers;
mod as_code;
mod choices;
mod commit;
mod ending;
mod episode;
mod meaningful;
mod movement;
mod replay;

pub use as_code::{AsCode, flags_as_code};
pub use choices::{Choices, Spending};
pub use ending::{EndCause, Ending, EndingKind, GoalDistance};
pub use episode::{EpisodeMetrics, EpisodeStatus};
pub use meaningful::{Effect, WINDOW, meaningful};
pub use movement::Movement;
pub use replay::{Replayed, replay, replay_course};
