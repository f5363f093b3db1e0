//! Tests of the searches, games, kernels and levels of the generators.

extern crate infinite_arcade_generators as generators;

mod annealing;
mod archive;
mod corpora;
mod evolution;
mod games;
mod kernels;
mod levels;
mod map_elites;
mod toys;
