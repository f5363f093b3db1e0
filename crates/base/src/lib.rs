//! The foundation of all other crates: digests, seeds and their paths, random draws, and canonical JSON.
//!
//! Seeds, digests, draws and canonical JSON never change: the bytes of every release depend on them.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

pub mod canonical;
mod digest;
mod messages;
mod named_enum;
mod sampler;
mod seed;
mod seed_path;
mod serde_as_text;
mod with_defaults;

pub use digest::{Digest, NotHex};
pub use messages::{InMessage, MessagePath, count};
pub use sampler::Sampler;
pub use seed::Seed;
pub use seed_path::{SeedPath, SeedStep};
