//! Properties that span crates, and the tidiness of the tree.

mod allocations;
mod analysis;
mod batch;
mod engine;
mod faults;
mod game_measures;
mod hostile;
mod limits;
mod novelty;
mod pages;
mod pictures;
mod public_games;
mod robustness;
mod search;
mod shortcuts;
mod tidy;
mod verdicts;
