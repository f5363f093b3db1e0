//! Why a verb has no answer, and the exit status that says so.

use std::fmt;

/// The answer is no.
pub(crate) const NO: u8 = 1;
/// The question is malformed.
pub(crate) const MALFORMED: u8 = 2;
/// An environment failure: I/O, network, disk full.
pub(crate) const ENVIRONMENT: u8 = 3;

/// No answer.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Usage, VGDL or recipe errors.
    Malformed(anyhow::Error),
    /// Input or output, network, a full disk.
    Environment(anyhow::Error),
}

/// Yes or no, or why there is neither.
pub(crate) type Answer = Result<bool, Failure>;

impl Failure {
    /// The question is malformed, in these words.
    pub(crate) fn malformed(message: impl fmt::Display) -> Failure {
        Failure::Malformed(anyhow::anyhow!("{message}"))
    }

    /// An environment failure, in these words.
    pub(crate) fn environment(error: impl Into<anyhow::Error>, what: impl fmt::Display) -> Failure {
        Failure::Environment(error.into().context(what.to_string()))
    }

    pub(crate) fn code(&self) -> u8 {
        match self {
            Failure::Malformed(_) => MALFORMED,
            Failure::Environment(_) => ENVIRONMENT,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Failure::Malformed(error) | Failure::Environment(error)) = self;
        write!(f, "{error:#}")
    }
}
