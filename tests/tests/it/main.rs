//! Tests of properties that span crates, and of the tidiness of the tree.

extern crate infinite_arcade_agents as agents;
extern crate infinite_arcade_base as base;
extern crate infinite_arcade_editor as editor;
extern crate infinite_arcade_engine as engine;
extern crate infinite_arcade_generators as generators;
extern crate infinite_arcade_render as render;
extern crate infinite_arcade_validators as validators;

mod allocations;
mod analysis;
mod batch;
mod claims;
mod corpus;
mod faults;
mod fixes;
mod front_pages;
mod game_measures;
mod hostile;
mod limits;
mod novelty;
mod pages;
mod pictures;
mod planes;
mod portfolio;
mod prose;
mod public_games;
mod recipe_keys;
mod robustness;
mod search;
mod shortcuts;
mod streams;
mod tidy;
mod verdicts;
mod words;
