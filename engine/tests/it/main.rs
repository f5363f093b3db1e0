//! The engine against the test vectors of the specification, and under hostile input.

extern crate infinite_arcade_engine as engine;

mod any_parameters;
mod as_reference;
mod board;
mod effect_vectors;
mod loop_vectors;
mod motion_vectors;
mod search_key;
mod sentences;
mod sprite_vectors;
mod time_and_edges;
mod vector;
mod vectors;
