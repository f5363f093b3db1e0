//! The reports as files: pages that need no other file, with their plots, and the same numbers as JSON, CSV and LaTeX.
//!
//! The model of a report is made by `forge` and `evaluation`. Here it becomes text and pictures, without a clock or a file system:
//! every function returns the [`File`]s, and the same report gives the same bytes.

mod evaluation_report;
mod file;
mod page;
mod set_report;
mod timeline;

pub use evaluation_report::{Results, evaluation_report};
pub use file::{File, PageError};
pub use set_report::{game_report, level_report};
pub use timeline::timeline_report;
