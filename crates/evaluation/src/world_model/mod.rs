//! Examinations that test whether a player can build a world model. The examined player (the *examinee*) studies
//! recordings of a masked game, or explores the game, and then writes the game in VGDL.
//!
//! A [`WorldModelTask`] contains a game with masked names and characters, recordings for the examinee, and held-out
//! recordings. [`examine`] questions the examinee, reports the diagnostics of unusable games to it, and scores the game
//! that it writes. Everything except the answers follows from the task's settings.
//!
//! A transition is reproduced if the examinee's game, started from the same level and stepped with the same actions so
//! far, gives the same observation. The same definition applies after the first deviation of an episode: a later
//! transition counts if the two games agree again. [`Reproduced::first_deviations`] counts the transitions at which
//! episodes first deviate, by kind of event, which shows the kind of rule that is wrong.

mod answer;
mod examine;
mod induce;
mod masked;
mod planner;
mod prompt;
mod recording;
mod score;
mod seen;
mod table;
mod task;

pub use examine::{Ask, Examined, MAX_ATTEMPTS, examine};
pub use induce::induce;
pub use planner::PlannerScore;
pub use recording::TransitionKind;
pub use score::{Reproduced, WorldModelScore};
pub use table::table;
pub use task::{Hints, WorldModelSettings, WorldModelTask};
