//! Games composed around a dilemma: kernels in scenes.
//!
//! A kernel (`file/kernel.rs`, the files of `generators/kernels/`) has the rules for one dilemma. A scene
//! (`words/scene.rs`, the files of `generators/scenes/`) has the nouns. [`KernelGenome`] draws both, and `compose.rs`
//! makes the rules and the words.

mod compose;
pub(crate) mod file;
mod genome;
mod habits;
mod turns;
pub(crate) mod ways;
pub(crate) mod words;

pub(crate) use genome::has_movers;
pub use genome::{KernelGenome, preview};
pub use turns::{Turns, kinds};
pub use words::wording::Wording;
