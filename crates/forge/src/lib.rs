//! Games and levels on request. Candidates are generated and then judged.
//!
//! `generators` proposes candidates and `validators` judges them. In this crate, a search requests candidates and
//! learns from verdicts until an order is filled. [`levels::make_levels`] generates levels for one game, and
//! [`games::make_games`] generates whole games. Releases are minted from the same parts. The reports describe sets of
//! levels or games, and a [`survey`] judges levels and games from anywhere. The module [`well`] estimates how many
//! games a chain of monthly releases can still invent.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

pub mod boards;
pub mod card;
pub mod games;
pub mod levels;
pub mod pipeline;
mod progress;
mod reported;
pub mod review;
mod search_loop;
pub mod stream;
pub mod survey;
mod tally;
pub mod well;

pub use progress::Progress;
pub use tally::{JudgeCost, Tally, reasons};
