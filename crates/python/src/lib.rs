//! The extension module of the Python package `infinite_arcade`: games, states, planners, judges, snapshots, environments and
//! evaluated episodes.
//!
//! Every class here is a thin wrapper around the crates of the suite. The Python files of the package add names, types and
//! documentation. Long-running work releases the interpreter's lock.

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
