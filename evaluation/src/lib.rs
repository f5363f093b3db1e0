//! Language models and other players on games: what they are shown, what they answer, what is recorded and measured.
//!
//! A [`Subject`] is a game with its levels. An [`Agent`] is shown a [`Turn`], never a state, and answers with a
//! [`Choice`]; what it says and is told on the way goes into the [`Journal`] of the episode, an append-only log of
//! [`Event`]s from which every metric is recomputed and by which the episode replays bit for bit. A model is reached
//! through [`client::Model`].

pub mod answer;
pub mod client;
pub mod encoding;
mod error;
pub mod legend;
pub mod log;
mod mask;
pub mod metrics;
pub mod player;
pub mod prompt;
pub mod run;
pub mod serve;
pub mod study;
mod subject;
pub mod tokens;
mod turn;

pub use error::EvaluationError;
pub use log::{Event, Journal};
pub use player::{Agent, Choice, Contestant, Halt, Validity};
pub use run::{Entrant, Evaluation, Settings};
pub use subject::{Subject, SubjectFacts, SubjectLevel, Unreadable};
pub use turn::{Before, Observed, Turn};
