//! A subcommand's failures and their exit statuses.

use base::MessagePath;
use engine::Diagnostic;
use pages::PageError;
use serde::Serialize;
use serde_json::{Value, json};
use snapshots::mint::{MergeError, MintError};
use snapshots::proof::ProofError;
use snapshots::{AncestryError, RegenerateError, RevealError};
use std::fmt;
use std::io::{self, ErrorKind};
use std::path::Path;
#[cfg(feature = "terminal")]
use terminal::PlayError;

/// The exit status for the answer "no".
pub(crate) const NO: u8 = 1;
/// The exit status for a malformed question.
pub(crate) const MALFORMED: u8 = 2;
/// The exit status for an environment failure: I/O, network or a full disk.
pub(crate) const ENVIRONMENT: u8 = 3;

/// The reason why a subcommand has no answer.
#[derive(Debug)]
pub(crate) enum Failure {
    /// An error in usage, in VGDL or in a recipe.
    Malformed(anyhow::Error),
    /// A failure of I/O or the network, or a full disk.
    Environment(anyhow::Error),
}

/// The problems in a file, as an error.
#[derive(Debug)]
pub(crate) struct Problems {
    /// The summary line, which states the number of problems.
    pub(crate) summary: String,
    pub(crate) placed: Vec<Placed>,
    pub(crate) text: String,
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Problems {}

/// A problem and its position in a file.
#[derive(Debug, Serialize)]
pub(crate) struct Placed {
    pub(crate) file: String,
    pub(crate) line: usize,
    pub(crate) column: usize,
    #[serde(flatten)]
    pub(crate) problem: Diagnostic,
}

/// Creates the failure for a malformed question. The arguments are those of `format!`.
macro_rules! malformed {
    ($($message:tt)*) => { $crate::failure::Failure::malformed(format_args!($($message)*)) };
}

/// Returns from the enclosing function with the failure for a malformed question.
macro_rules! bail {
    ($($message:tt)*) => { return Err(malformed!($($message)*)) };
}

/// A subcommand's answer: yes, no or a failure.
pub(crate) type Answer = Result<bool, Failure>;

impl Failure {
    pub(crate) fn malformed(message: impl fmt::Display) -> Failure {
        Failure::Malformed(anyhow::anyhow!("{message}"))
    }

    pub(crate) fn environment(error: impl Into<anyhow::Error>, what: impl fmt::Display) -> Failure {
        Failure::Environment(error.into().context(what.to_string()))
    }

    /// Adds advice on how to resume, if an environment failure stopped the work.
    pub(crate) fn resumable(self, what: &str) -> Failure {
        match self {
            Failure::Environment(error) => Failure::environment(
                error,
                format_args!("the {what} was stopped by an error; fix the error and continue with --resume"),
            ),
            other => other,
        }
    }

    /// Returns the failure for a file at `path` that cannot be read. Either the user specified a missing
    /// file, or the system denied access.
    pub(crate) fn read(path: &Path, error: io::Error) -> Failure {
        let name = path.in_message();
        match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => {
                malformed!("{name}: there is no such file; check the path")
            }
            ErrorKind::InvalidFilename => {
                malformed!("{name}: the name is invalid, so there is no such file; check the path")
            }
            ErrorKind::IsADirectory => malformed!("{name} is a folder: pass a file in it"),
            // `disk` reports this kind for pipes, devices and sockets.
            ErrorKind::InvalidInput => malformed!("{name} is not a file: pass a regular file"),
            _ => Failure::environment(error, format_args!("cannot read `{name}`")),
        }
    }

    /// Returns the failure for a file at `path` that cannot be written. Either the user specified an
    /// impossible path, or the system denied access.
    pub(crate) fn write(path: &Path, error: io::Error) -> Failure {
        let name = path.in_message();
        match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory => malformed!(
                "cannot write `{name}`: its folder does not exist; create it first, or choose another file"
            ),
            ErrorKind::InvalidFilename => {
                malformed!("cannot write `{name}`: the name is invalid; choose a shorter one")
            }
            ErrorKind::IsADirectory => malformed!("cannot write `{name}`: it is a folder; pass a file in it"),
            _ => Failure::environment(error, format_args!("cannot write `{name}`")),
        }
    }

    pub(crate) fn code(&self) -> u8 {
        match self {
            Failure::Malformed(_) => MALFORMED,
            Failure::Environment(_) => ENVIRONMENT,
        }
    }

    /// Returns the failure as a document for programs. The field `problems` locates each problem in a user's
    /// file.
    pub(crate) fn document(&self) -> Value {
        let (kind, error) = match self {
            Failure::Malformed(error) => ("malformed", error),
            Failure::Environment(error) => ("environment", error),
        };
        let problems = error.downcast_ref::<Problems>();
        let message = problems.map_or_else(|| self.to_string(), |problems| problems.summary.clone());
        let mut document = json!({ "status": self.code(), "kind": kind, "message": message });
        if let Some(problems) = problems {
            document["problems"] = json!(problems.placed);
        }
        json!({ "error": document })
    }
}

/// Converts release errors into malformed questions, except errors in the snapshot itself.
macro_rules! from_snapshot_errors {
    ($($error:ident),*) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Failure {
                match error {
                    $error::Snapshot(error) => error.into(),
                    other => Failure::Malformed(other.into()),
                }
            }
        }
    )*};
}
from_snapshot_errors!(AncestryError, MergeError, MintError, ProofError, RegenerateError, RevealError);

impl From<PageError> for Failure {
    fn from(error: PageError) -> Failure {
        match error {
            PageError::Evaluation(error) => error.into(),
            other => Failure::Environment(other.into()),
        }
    }
}

#[cfg(feature = "terminal")]
impl From<PlayError> for Failure {
    fn from(error: PlayError) -> Failure {
        match error {
            PlayError::Io(_) => Failure::Environment(error.into()),
            other => Failure::Malformed(other.into()),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Failure::Malformed(error) | Failure::Environment(error)) = self;
        write!(f, "{error:#}")?;
        let mut causes = error.chain().filter_map(|cause| cause.downcast_ref::<io::Error>());
        match causes.find_map(|cause| advice(cause.kind())) {
            Some(advice) if matches!(self, Failure::Environment(_)) => write!(f, "; {advice}"),
            _ => Ok(()),
        }
    }
}

/// Returns advice for this kind of error, or `None` if there is no advice.
fn advice(kind: ErrorKind) -> Option<&'static str> {
    match kind {
        ErrorKind::PermissionDenied => Some("check the permissions of the file and of the folders above it"),
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Some("free some space and try again"),
        ErrorKind::ReadOnlyFilesystem => Some("choose a writable folder"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(failure: &Failure, status: u8, message: &str) {
        assert_eq!(failure.to_string(), message);
        assert_eq!(failure.code(), status);
    }

    #[test]
    fn unreadable_files_are_not_reported_absent() {
        let at = Path::new("games/a");
        check(
            &Failure::read(at, ErrorKind::NotFound.into()),
            MALFORMED,
            "games/a: there is no such file; check the path",
        );
        check(
            &Failure::read(at, ErrorKind::PermissionDenied.into()),
            ENVIRONMENT,
            "cannot read `games/a`: permission denied; check the permissions of the file and of the folders above it",
        );
        check(
            &Failure::read(at, ErrorKind::IsADirectory.into()),
            MALFORMED,
            "games/a is a folder: pass a file in it",
        );
    }

    #[test]
    fn advice_fits_the_cause() {
        let at = Path::new("a.gif");
        check(
            &Failure::write(at, ErrorKind::StorageFull.into()),
            ENVIRONMENT,
            "cannot write `a.gif`: no storage space; free some space and try again",
        );
        check(
            &Failure::write(at, ErrorKind::TimedOut.into()),
            ENVIRONMENT,
            "cannot write `a.gif`: timed out",
        );
        let of_snapshots = snapshots::SnapshotError::Io {
            action: "write",
            path: at.to_owned(),
            source: ErrorKind::PermissionDenied.into(),
        };
        check(
            &of_snapshots.into(),
            ENVIRONMENT,
            "cannot write `a.gif`: permission denied; check the permissions of the file and of the folders above it",
        );
    }

    #[test]
    fn a_failure_is_a_document() {
        let document = malformed!("name a game").document();
        assert_eq!(
            document,
            json!({ "error": { "status": 2, "kind": "malformed", "message": "name a game" } })
        );
    }
}
