//! Searches, games, kernels and levels of the generators.

extern crate infinite_arcade_generators as generators;

mod annealing;
mod archive;
mod evolution;
mod feasible_infeasible;
mod map_elites;
mod measures;
mod toys;
