//! The engine as its users see it: against the test vectors of the specification, under hostile input, and part by part.

extern crate infinite_arcade_engine as engine;

mod ablation;
mod analysis;
mod any_parameters;
mod arrange;
mod as_reference;
mod board;
mod causes;
mod clauses;
mod compile;
mod countdowns;
mod describe;
mod dialects;
mod effect_summaries;
mod effect_vectors;
mod game_space;
mod level;
mod lint;
mod loop_vectors;
mod motion_vectors;
mod search_key;
mod sentences;
mod sprite_vectors;
mod syntax;
mod time_and_edges;
mod vector;
mod vectors;
mod world;
