//! The extension module of the Python package `infinite_arcade`: games, states, planners, judges, snapshots,
//! environments and evaluated episodes.
//!
//! Every class in this crate is a thin wrapper around the suite's crates. The package's Python files add
//! names, types and documentation. Long-running functions release the interpreter lock.

mod corpus;
mod errors;
mod evaluate;
mod forging;
mod game;
mod interrupt;
mod lane;
mod lanes;
mod minting;
mod module;
mod picture;
mod planner;
mod questions;
mod state;
mod status;
mod stream;
