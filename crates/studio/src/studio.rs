//! The server's state: the opened games and the work in progress.

use crate::compiled::Cache;
use crate::judging::Judging;
use crate::running::Running;
use crate::sessions::Sessions;
use crate::workspace::Workspace;
use snapshots::Verification;
use std::fmt;
use std::sync::{Arc, Mutex};

/// The state for handling requests about a workspace.
pub struct Studio {
    pub(crate) workspace: Workspace,
    pub(crate) version: String,
    /// A function that returns a manual page in Markdown, by name.
    pub(crate) manual: fn(&str) -> Option<String>,
    pub(crate) compiled: Cache,
    pub(crate) sessions: Sessions,
    pub(crate) verdicts: Running,
    pub(crate) judging: Option<Arc<Judging>>,
    pub(crate) vouch: Option<Vouch>,
    /// A lock held while a file is compared and written, so that no two requests do so at the same time.
    pub(crate) saving: Mutex<()>,
}

impl Studio {
    /// Creates a studio for a workspace, with the version to display and the manual pages.
    pub fn new(
        workspace: Workspace,
        version: impl Into<String>,
        manual: fn(&str) -> Option<String>,
    ) -> Studio {
        Studio {
            workspace,
            version: version.into(),
            manual,
            compiled: Cache::default(),
            sessions: Sessions::default(),
            verdicts: Running::default(),
            judging: None,
            vouch: None,
            saving: Mutex::default(),
        }
    }
}

impl Studio {
    /// Adds a judging session, and starts to measure its games.
    pub fn judging(self, judging: Judging) -> Studio {
        let judging = Arc::new(judging);
        Judging::measure_ahead(&judging);
        Studio { judging: Some(judging), ..self }
    }
}

/// A check of a verified release's root, for example against its signatures. Returns a sentence about the evidence,
/// or the problems found.
type Vouch = Box<dyn Fn(&Verification) -> Result<String, Vec<String>> + Send + Sync>;

impl Studio {
    /// Adds a check of the opened release's root, to be made whenever the release is verified.
    pub fn vouched(
        self,
        check: impl Fn(&Verification) -> Result<String, Vec<String>> + Send + Sync + 'static,
    ) -> Studio {
        Studio { vouch: Some(Box::new(check)), ..self }
    }
}

impl fmt::Debug for Studio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Studio").field("workspace", &self.workspace).finish_non_exhaustive()
    }
}
