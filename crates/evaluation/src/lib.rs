//! Evaluation of language models and other players on games: observations, answers, logs and metrics.
//!
//! A [`Subject`] is a game with its levels. An [`Agent`] is shown a [`Turn`], never a state, and answers with
//! a [`Choice`]. The messages in both directions are recorded in the episode's [`Journal`], an append-only
//! log of [`Event`]s. Every metric is recomputed from the log, from which the episode can also be replayed
//! exactly. Models are accessed through [`client::Model`].
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

pub mod answer;
pub mod client;
mod commitment;
pub mod contamination;
mod direction;
pub mod encoding;
mod error;
pub mod legend;
pub mod log;
mod mask;
pub mod metrics;
pub mod player;
pub mod predictions;
pub mod prompt;
pub mod questions;
pub mod reference;
pub mod run;
pub mod scale;
pub mod serve;
pub mod study;
mod subject;
mod thought;
pub mod tokens;
mod track;
mod turn;
pub mod world_model;

pub use commitment::Commitment;
pub use error::EvaluationError;
pub use log::{Event, Journal};
pub use player::{Agent, Choice, Contestant, Halt, Validity};
pub use run::{Entrant, Evaluation, Settings};
pub use subject::{LevelCeiling, LevelMark, Subject, SubjectFacts, SubjectLevel, Unreadable};
pub use thought::{AnswerLimit, budget_aid};
pub use track::{SeriesPlace, Track};
pub use turn::{Before, LevelEnd, Observed, Played, SeriesView, Turn, is_of_use};
