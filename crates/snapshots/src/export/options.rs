//! Export options.

use crate::twin::Twin;
use std::fmt;

/// The name of the only split. Without a named split, tools would treat everything as training data, although the
/// whole release is meant for evaluation. To divide a release, for example by origin or difficulty, filter by a
/// column.
pub const SPLIT: &str = "test";

/// The export format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One JSON object per line.
    JsonLines,
    /// The Apache Parquet format.
    #[cfg(feature = "parquet")]
    Parquet,
    /// One folder per game, with its rules and levels.
    Games,
}

impl fmt::Display for Format {
    /// Writes the format's name as on the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::JsonLines => "jsonl",
            #[cfg(feature = "parquet")]
            Format::Parquet => "parquet",
            Format::Games => "games",
        })
    }
}

/// Export options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Export {
    /// The export format.
    pub format: Format,
    /// `true` to include a winning episode for each level.
    pub solutions: bool,
    /// The kind of twin (copy with a different surface) to export; `None` for the games themselves.
    pub twin: Option<Twin>,
}
