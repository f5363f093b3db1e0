//! The extension module of the Python package `infinite_arcade`: games, states, planners, judges, snapshots, environments and
//! evaluated episodes.
//!
//! Every class here is thin: what it does is done by the crates of the suite, and the Python files beside it give it names, types
//! and documentation. Work that takes time releases the interpreter's lock.

mod corpus;
mod errors;
mod evaluate;
mod forging;
mod game;
mod lanes;
mod minting;
mod module;
mod picture;
mod planner;
mod state;
