//! Generators for levels and games: pure functions of a configuration and a seed.
//!
//! Generators never judge their own output. The crate `infinite-arcade-forge` evaluates the candidates.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod annealing;
mod archive;
pub mod boards;
mod breeding;
mod error;
pub mod games;
mod generator;
pub mod invention;
pub mod kernels;
pub mod levels;
mod map_elites;
mod search;

pub use annealing::{Annealing, AnnealingConfig};
pub use archive::{AddStatus, Archive, Axis, Evaluated};
pub use error::GenerateError;
pub use generator::Generator;
pub use map_elites::{MapElites, MapElitesConfig};
pub use search::{Evaluation, Search, Variation};

/// The generators' version, incremented whenever any minted byte changes for an unchanged recipe.
pub const GENERATION: u32 = 18;
