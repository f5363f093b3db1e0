//! Tests of whole evaluations, from prompts to tables, with scripted servers and players.

extern crate infinite_arcade_evaluation as evaluation;

mod boards;
mod budgets;
mod commitment;
mod games;
mod mailbox;
mod misbehaving_servers;
mod prompts;
mod questions;
mod runs;
mod scores;
mod served;
mod server;
mod tracks;
mod walk;
mod world_model;

/// Returns `true` if all cases are requested (`cargo xtask sweep`).
fn sweeping() -> bool {
    std::env::var_os("ARCADE_SWEEP").is_some()
}
