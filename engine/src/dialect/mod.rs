//! Other dialects of VGDL: how a file in one is recognised, and how it is converted.
//!
//! Dialects are recognised only in files with errors, so that no game that plays here is taken for one of theirs.

mod convert;
mod evidence;
mod python;

pub use convert::{Change, Conversion, convert};
pub(crate) use evidence::{is_of_several_players, told};
pub use python::{PythonFile, python_file};

/// A dialect of VGDL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// The language of py-vgdl, the Python engine that GVGAI's VGDL comes from.
    PyVgdl,
    /// The language of the games of EMPA, py-vgdl's with effects and parameters of its own.
    Empa,
}

impl Dialect {
    /// Returns the name for people.
    pub fn name(self) -> &'static str {
        match self {
            Dialect::PyVgdl => "py-vgdl",
            Dialect::Empa => "EMPA",
        }
    }

    /// Returns the name on the command line: `arcade fmt --from py-vgdl`.
    pub fn flag(self) -> &'static str {
        match self {
            Dialect::PyVgdl => "py-vgdl",
            Dialect::Empa => "empa",
        }
    }
}
