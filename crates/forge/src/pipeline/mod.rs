//! The stages that a candidate passes through. Each stage is defined as data: its question, its cost, its reasons for
//! rejecting a candidate, and the part that it can replace.
//!
//! The lists in `stages.rs` define the order in which `stage::walk` runs the stages. Each stage is defined in a file of
//! this folder, with its tuning constants next to its code. To add a stage, write a `Stage` there and add it to a list.
//!
//! The stages do not depend on a candidate's source. `sources.rs` contains the traits for sources of rules and
//! boards.

mod clock;
mod course;
mod game;
mod gates;
mod invented;
mod joint;
mod ladder;
mod level;
mod place;
mod recheck;
mod request;
mod rules;
mod sources;
mod stage;
mod stages;

pub(crate) use game::GameGate;
#[cfg(test)]
pub(crate) use game::tests;
pub(crate) use request::{DIFFICULTY, LevelGate};
pub(crate) use rules::NEAR_KNOWN;
pub(crate) use sources::Rules;
pub use sources::{Board, BoardSource, Boards, PlaceBrief};
pub use stages::tables;
