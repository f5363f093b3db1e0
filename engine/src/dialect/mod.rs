//! Recognises and converts files in other dialects of VGDL.
//!
//! Dialects are recognised only in files with errors, so that no valid game is mistaken for one in a
//! different dialect.

mod convert;
mod evidence;
mod python;

pub use convert::{Change, Conversion, convert};
pub(crate) use evidence::{is_of_several_players, told};
pub use python::{PythonFile, python_file};

/// A dialect of VGDL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// The language of py-vgdl, the Python engine from which GVGAI's VGDL originates.
    PyVgdl,
    /// The language of EMPA's games: that of py-vgdl with additional effects and parameters.
    Empa,
}

impl Dialect {
    /// Returns the dialect's display name.
    pub fn name(self) -> &'static str {
        match self {
            Dialect::PyVgdl => "py-vgdl",
            Dialect::Empa => "EMPA",
        }
    }

    /// Returns the dialect's name on the command line: `arcade fmt --from py-vgdl`.
    pub fn flag(self) -> &'static str {
        match self {
            Dialect::PyVgdl => "py-vgdl",
            Dialect::Empa => "empa",
        }
    }
}
