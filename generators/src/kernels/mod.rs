//! Games composed around a dilemma, with levels of increasing difficulty.
//!
//! A kernel (`file/kernel.rs`, files in `generators/kernels/`) is a hand-written design: the rules for one dilemma and
//! the maps for its levels. A scene (`words/scene.rs`, files in `generators/scenes/`) supplies the nouns of a theme.
//! [`KernelGenome`] draws both, `compose.rs` composes the rules and texts, and `course/` builds levels from maps.

mod compose;
mod course;
pub(crate) mod file;
mod genome;
mod habits;
mod turns;
pub(crate) mod ways;
pub(crate) mod words;

pub use compose::{Course, CourseLevel};
pub use file::kernel::Slot;
pub(crate) use genome::has_movers;
pub use genome::{KernelGame, KernelGenome, preview};
pub use turns::{Turns, kinds};
pub use words::wording::Wording;
