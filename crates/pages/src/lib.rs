//! Renders reports as files: self-contained pages with plots, and the same numbers as JSON, CSV and LaTeX.
//!
//! `forge` and `evaluation` provide the report data, and this crate converts the data to text and images. The
//! crate uses neither a clock nor the file system. Every function returns [`File`]s, and the same report
//! gives identical bytes.

mod evaluation_report;
mod file;
mod page;
mod set_report;
mod timeline;

pub use evaluation_report::{Results, evaluation_report};
pub use file::{File, PageError};
pub use set_report::{game_report, level_report};
pub use timeline::timeline_report;
