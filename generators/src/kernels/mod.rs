//! Games composed round a dilemma: kernels in scenes, with levels as a course.
//!
//! A kernel (`kernel.rs`, the files of `generators/kernels/`) has the rules round one dilemma and the maps of its levels; a
//! scene (`scene.rs`, the files of `generators/scenes/`) has the nouns. [`KernelGenome`] draws both, `compose.rs` makes the
//! rules and the words, and `course/` builds levels from maps.

mod compose;
mod content;
mod course;
mod form;
mod genome;
mod graft;
mod habits;
mod hues;
mod kernel;
mod map;
mod naming;
mod phrase;
pub(crate) mod scene;
mod template;
mod turns;
mod variation;
mod vocabulary;
mod ways;

pub use compose::{Course, CourseLevel};
pub use genome::{KernelGame, KernelGenome, preview};
pub use kernel::Slot;
pub use turns::{Turns, kinds};
pub use variation::KernelVariation;
