//! Tests the engine from its users' point of view: against the test vectors of the specification, under
//! hostile input, and part by part.

extern crate infinite_arcade_engine as engine;

mod ablation;
mod analysis;
mod any_parameters;
mod arrange;
mod board;
mod countdowns;
mod describe;
mod effect_summaries;
mod language;
mod level;
mod lint;
mod search_key;
mod sentences;
mod syntax;
mod vectors;
mod world;
