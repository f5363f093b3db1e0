//! Creates, locks and finishes a mailbox folder on the evaluation's side.

use super::MAILBOX_FORMAT;
use super::files::{FINISHED_FILE, LOCK_FILE, MARKER_FILE, names, read_data, write_data};
use crate::error::EvaluationError;
use crate::player::Halt;
use crate::run::{Settings, Tally};
use base::Digest;
use disk::Lock;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// The number of tries to lock a mailbox. Several tries are needed, because a [`Desk`](super::Desk) briefly
/// holds the lock to test whether an evaluation has locked the mailbox.
const TRIES: u32 = 20;
/// The pause between tries to lock a mailbox.
const PAUSE: Duration = Duration::from_millis(20);

/// A function that shows notices to the user who started the evaluation.
pub type Notices = Arc<dyn Fn(&str) + Send + Sync>;

/// A mailbox, as seen from the evaluation's side.
pub struct Mailbox {
    pub(super) folder: PathBuf,
    pub(super) player: String,
    pub(super) notices: Notices,
    stopped: Mutex<Option<Halt>>,
    _lock: Lock,
}

/// The content of the file that marks a folder as a mailbox.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Marker {
    pub(super) format: u32,
    /// The player's name in results.
    pub(super) player: String,
    /// The settings digest of the evaluation that uses the mailbox.
    pub(super) evaluation: Digest,
}

/// The result of an entire evaluation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finished {
    /// The number of episodes.
    pub episodes: u64,
    /// The number of episodes won.
    pub won: u64,
}

impl Mailbox {
    /// Opens an evaluation's mailbox. The folder must be absent or empty. With `resume`, the folder may also
    /// contain the same evaluation's mailbox. A mailbox without any episode can be used by any evaluation.
    ///
    /// # Errors
    /// Returns an error if the folder is unsuitable, cannot be written, or is used by a different evaluation.
    pub fn open(
        folder: &Path,
        settings: &Settings,
        resume: bool,
        notices: Notices,
    ) -> Result<Mailbox, EvaluationError> {
        Mailbox::open_as(folder, &settings.entrant.name, digest(settings), resume, notices)
    }

    /// Opens a mailbox like [`open`](Mailbox::open), for work other than an evaluation. `player` is the name of the
    /// person or program that answers, and `work` is a digest of the work's settings.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`open`](Mailbox::open).
    pub fn open_as(
        folder: &Path,
        player: &str,
        work: Digest,
        resume: bool,
        notices: Notices,
    ) -> Result<Mailbox, EvaluationError> {
        let wrong = |what: &str| EvaluationError::malformed(folder, what);
        if fs::metadata(folder).is_ok_and(|found| !found.is_dir()) {
            return Err(wrong("a mailbox is a folder, but this is a file; choose a different path"));
        }
        fs::create_dir_all(folder).map_err(EvaluationError::io("create", folder))?;
        let marker: Option<Marker> = marker(folder)?;
        let others = names(folder)?.into_iter().filter(|name| name != MARKER_FILE);
        let is_empty = others.count() == 0;
        let player = player.to_owned();
        let own = Marker { format: MAILBOX_FORMAT, player: player.clone(), evaluation: work };
        match &marker {
            None if !is_empty => {
                return Err(wrong("the folder is neither empty nor a mailbox; choose a new or empty folder"));
            }
            Some(other) if other.evaluation != own.evaluation && !is_empty => {
                return Err(wrong(&format!(
                    "this mailbox belongs to a different evaluation, with the player `{}`; choose another \
                     folder, or remove this one",
                    other.player
                )));
            }
            Some(_) if !is_empty && !resume => {
                return Err(wrong(
                    "the mailbox contains episodes of this evaluation: continue the evaluation with \
                     --resume, or choose another folder",
                ));
            }
            _ => {}
        }
        let lock = lock(folder)?;
        if marker.as_ref() != Some(&own) {
            write_data(folder, MARKER_FILE, &own)?;
        }
        let finished = folder.join(FINISHED_FILE);
        if finished.exists() {
            fs::remove_file(&finished).map_err(EvaluationError::io("remove", &finished))?;
        }
        Ok(Mailbox { folder: folder.to_owned(), player, notices, stopped: Mutex::default(), _lock: lock })
    }

    /// Returns the path to the mailbox folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Makes all episodes stop waiting for answers. Their prompts stay open for a resumed evaluation.
    pub fn stop(&self, halt: &Halt) {
        self.stopped.lock().expect("no holder panics").get_or_insert_with(|| halt.clone());
    }

    /// Returns the reason why episodes must stop waiting, if any.
    pub(super) fn stopped(&self) -> Option<Halt> {
        self.stopped.lock().expect("no holder panics").clone()
    }

    /// Informs the players that all episodes have ended. Does nothing if any episode is still open.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn finish(&self, tally: &Tally) -> Result<(), EvaluationError> {
        if tally.open > 0 {
            return Ok(());
        }
        self.finish_with(&Finished { episodes: tally.episodes, won: tally.won })
    }

    /// Informs the players that the work is over, with the given result.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn finish_with(&self, finished: &Finished) -> Result<(), EvaluationError> {
        write_data(&self.folder, FINISHED_FILE, finished)
    }
}

impl std::fmt::Debug for Mailbox {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mailbox").field("folder", &self.folder).field("player", &self.player).finish()
    }
}

/// Reads a mailbox's marker. Returns `None` if the folder has no marker.
pub(super) fn marker(folder: &Path) -> Result<Option<Marker>, EvaluationError> {
    let path = folder.join(MARKER_FILE);
    let Some(data) = read_data::<serde_json::Value>(&path)? else { return Ok(None) };
    let format = data.get("format").and_then(serde_json::Value::as_u64);
    if let Some(format) = format.filter(|&format| format > u64::from(MAILBOX_FORMAT)) {
        return Err(EvaluationError::malformed(
            &path,
            format!(
                "the mailbox has format {format}, but this version of arcade reads formats up to \
                 {MAILBOX_FORMAT}: update arcade"
            ),
        ));
    }
    read_data(&path)
}

/// Returns `true` if an evaluation is currently using the mailbox.
pub(super) fn is_locked(folder: &Path) -> bool {
    Lock::is_held(&folder.join(LOCK_FILE))
}

/// Locks the folder against other evaluations.
fn lock(folder: &Path) -> Result<Lock, EvaluationError> {
    let path = folder.join(LOCK_FILE);
    for _ in 0..TRIES {
        match Lock::take(&path).map_err(EvaluationError::io("lock", &path))? {
            Some(lock) => return Ok(lock),
            None => thread::sleep(PAUSE),
        }
    }
    let what =
        "another `arcade evaluate` is writing to this mailbox; wait until it ends, or choose another folder";
    Err(EvaluationError::malformed(folder, what))
}

/// Returns a digest of an evaluation's settings. Distinct evaluations have distinct digests.
fn digest(settings: &Settings) -> Digest {
    Digest::of(&serde_json::to_vec(settings).expect("settings are plain data"))
}
