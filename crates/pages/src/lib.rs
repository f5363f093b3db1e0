//! The reports as files: pages that need no other file, with their plots, and the same numbers as JSON, CSV and LaTeX.
//!
//! The model of a report is made by `forge` and `evaluation`. Here it becomes text and pictures, without a clock or a file system:
//! every function returns the [`File`]s, and the same report gives the same bytes.

mod evaluation_report;
mod page;
mod set_report;
mod timeline;

pub use evaluation_report::{Results, evaluation_report};
pub use set_report::{game_report, level_report};
pub use timeline::timeline_report;

use evaluation::EvaluationError;
use std::error::Error;

/// A file of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// The path below the folder of the report, with `/`.
    pub name: String,
    /// The content.
    pub bytes: Vec<u8>,
}

impl File {
    fn text((name, text): (String, String)) -> File {
        File { name, bytes: text.into_bytes() }
    }
}

/// The reasons why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The log of an episode cannot be read.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A picture or a page cannot be made.
    #[error("{what}")]
    Failed {
        /// The part of the report.
        what: &'static str,
        /// The cause.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl PageError {
    fn failed<E: Error + Send + Sync + 'static>(what: &'static str) -> impl FnOnce(E) -> PageError {
        move |error| PageError::Failed { what, source: Box::new(error) }
    }
}
