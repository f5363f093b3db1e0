//! An append-only log. Its entries are the leaves of a Merkle tree. A signed state of the tree cannot be revoked.

mod entry;
mod history;
mod note;
mod proof;
mod tiles;
mod tree;

pub use entry::{Entry, ResultRow, Revealed, Round};
pub use history::{CommitmentOf, frozen, is_month, problems, unkept};
pub use note::{Checkpoint, MAX_CHECKPOINT, check_name, verifier_key};
pub use proof::{Consistency, Inclusion};
pub use tiles::{MAX_ENTRY, WIDTH};
pub use tree::Hash;

use crate::error::TrustError;
use crate::key::{PublicKey, SecretKey};
use crate::signatures::{read_bounded, write_document};
use base::MessagePath;
use disk::{Disk, Lock};
use std::fs;
use std::path::{Path, PathBuf};

/// The name of the file in the log's folder that contains the newest checkpoint.
pub const CHECKPOINT_FILE: &str = "checkpoint";
/// The maximum number of entries to read from a log.
const MAX_ENTRIES: u64 = 1 << 20;

/// A complete log read from its folder.
#[derive(Clone, Debug)]
pub struct Log {
    folder: PathBuf,
    /// The log's newest checkpoint.
    pub checkpoint: Checkpoint,
    entries: Vec<Vec<u8>>,
    leaves: Vec<Hash>,
}

impl Log {
    /// Opens a log, checking only that it is well-formed. Returns `None` if the folder contains no log.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read or is malformed.
    pub fn open(folder: &Path) -> Result<Option<Log>, TrustError> {
        let file = folder.join(CHECKPOINT_FILE);
        if !file.exists() {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&read_bounded(&file, MAX_CHECKPOINT)?).into_owned();
        let checkpoint = Checkpoint::parse(&text, &file.in_message().to_string())?;
        if checkpoint.size > MAX_ENTRIES {
            let fault = format!("states {} entries; the limit is {MAX_ENTRIES}", checkpoint.size);
            return Err(TrustError::document(file.in_message().to_string(), fault));
        }
        let mut entries = Vec::new();
        for (path, width) in tiles::entry_files(checkpoint.size) {
            let place = folder.join(&path);
            let limit = width * (MAX_ENTRY as u64 + 2);
            let bytes = read_bounded(&place, limit).map_err(|error| match place.exists() {
                true => error,
                false => TrustError::document(
                    place.in_message().to_string(),
                    format!(
                        "is missing: the log was truncated, because its checkpoint states {} entries",
                        checkpoint.size
                    ),
                ),
            })?;
            let found = tiles::split(&bytes, width);
            let fault = || {
                TrustError::document(place.in_message().to_string(), format!("does not hold {width} entries"))
            };
            entries.extend(found.ok_or_else(fault)?);
        }
        let leaves = entries.iter().map(|entry| tree::leaf(entry)).collect();
        Ok(Some(Log { folder: folder.to_path_buf(), checkpoint, entries, leaves }))
    }

    /// Returns the faults in the log's signature, root and files.
    pub fn faults(&self, key: &PublicKey) -> Vec<String> {
        let mut faults: Vec<String> = self.checkpoint.check(key).err().into_iter().collect();
        if tree::root(&self.leaves) != self.checkpoint.root {
            faults.push(
                "the entries do not match the signed checkpoint: an entry was changed, added or removed"
                    .to_owned(),
            );
            return faults;
        }
        for file in tiles::files(&self.entries, &self.leaves, 0) {
            let found = read_bounded(&self.folder.join(&file.path), file.bytes.len() as u64);
            if !found.is_ok_and(|found| found == file.bytes) {
                faults.push(format!("{}: the file is missing, or does not match the entries", file.path));
            }
        }
        let earlier = self.earlier_faults().into_iter().filter(|fault| !faults.contains(fault));
        let earlier: Vec<String> = earlier.collect();
        faults.extend(earlier);
        faults
    }

    /// Returns the faults in partial tiles from earlier states. Readers of those states may still use these tiles.
    /// Tiles larger than the checkpoint's are ignored, because an interrupted append may leave such tiles behind.
    fn earlier_faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (place, parts) in tiles::parts(&self.entries, &self.leaves) {
            let listed = fs::read_dir(self.folder.join(&place)).into_iter().flatten().flatten();
            let mut widths: Vec<usize> =
                listed.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).collect();
            widths.sort_unstable();
            for width in widths.into_iter().filter(|&width| width < parts.len()) {
                let (path, due) = (format!("{place}/{width}"), parts[..width].concat());
                let found = read_bounded(&self.folder.join(&path), due.len() as u64);
                if !found.is_ok_and(|found| found == due) {
                    faults.push(format!("{path}: the file does not match the entries"));
                }
            }
        }
        faults
    }

    /// Returns the fault if this log does not extend an earlier checkpoint that a reader has seen.
    pub fn fork(&self, seen: &Checkpoint) -> Option<String> {
        let Checkpoint { origin, size, root, .. } = &self.checkpoint;
        if seen.origin != *origin {
            return Some(format!(
                "this is the log `{origin}`, but the earlier checkpoint is from `{}`",
                seen.origin
            ));
        }
        if seen.size > *size {
            return Some(format!(
                "the log was rolled back: {} entries were seen before, but now it has only {size}",
                seen.size
            ));
        }
        let before = tree::root(&self.leaves[..(seen.size as usize).min(self.leaves.len())]);
        (before != seen.root || (seen.size == *size && seen.root != *root)).then(|| {
            format!(
                "the log has forked: its first {} entries differ from the entries seen before; keep both \
                 signed checkpoints, which together prove the fork",
                seen.size
            )
        })
    }

    /// Parses all entries in the log.
    ///
    /// # Errors
    /// Returns an error if an entry's kind is unknown to this version of arcade, or if an entry is not in
    /// canonical form.
    pub fn entries(&self) -> Result<Vec<Entry>, TrustError> {
        self.entries
            .iter()
            .enumerate()
            .map(|(number, bytes)| Entry::parse(bytes, &format!("entry {number}")))
            .collect()
    }

    /// Returns the bytes of the entry with the given number; `None` if the log has no such entry.
    pub fn entry(&self, number: u64) -> Option<&[u8]> {
        self.entries.get(usize::try_from(number).ok()?).map(Vec::as_slice)
    }

    /// Returns the proof that an entry is in the log, or `None` if the entry does not exist.
    pub fn prove(&self, number: u64) -> Option<Inclusion> {
        let hashes = tree::inclusion(&self.leaves, usize::try_from(number).ok()?)?;
        Some(Inclusion { index: number, hashes, checkpoint: self.checkpoint.clone() })
    }

    /// Returns the proof that this log extends its earlier state of size `old`, or `None` if the log never
    /// had that size.
    pub fn prove_growth(&self, old: u64) -> Option<Consistency> {
        let hashes = tree::consistency(&self.leaves, usize::try_from(old).ok()?)?;
        Some(Consistency { old, hashes, checkpoint: self.checkpoint.clone() })
    }

    /// Replaces the checkpoint with a version that contains additional signatures.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn write_checkpoint(&self, checkpoint: &Checkpoint, disk: &Disk) -> Result<(), TrustError> {
        let path = self.folder.join(CHECKPOINT_FILE);
        write_document(&path, checkpoint.to_text().as_bytes(), disk)
    }
}

/// Appends entries to a log, or starts a log with the name `origin`.
///
/// The new files are written first and the checkpoint last, so the log is unchanged until the checkpoint is
/// written. `rules` returns the faults in the entries as a whole. For release logs, `rules` calls
/// [`problems`].
///
/// # Errors
/// Returns an error if the log is invalid under this key, an entry breaks a rule, another process is
/// appending, or a file system operation fails.
pub fn append(
    folder: &Path,
    origin: Option<&str>,
    secret: &SecretKey,
    new: &[Entry],
    rules: &dyn Fn(&[Entry]) -> Vec<String>,
    disk: &Disk,
) -> Result<Log, TrustError> {
    let refuse = |reason: String| Err(TrustError::Refused(reason));
    let unnamed = || {
        refuse(format!(
            "`{}` contains no log, and a new log needs a name: --origin example.org/arcade",
            folder.in_message()
        ))
    };
    match origin {
        Some(origin) => check_name(origin)?,
        None if folder.join(CHECKPOINT_FILE).exists() => {}
        // If the name is missing, for example because of a typo, no folder is created.
        None => return unnamed(),
    }
    disk.create_folder(folder).map_err(TrustError::io("create", folder))?;
    let _lock = lock(folder)?;
    let old = Log::open(folder)?;
    if let Some(fault) = old.as_ref().and_then(|log| log.faults(&secret.public()).into_iter().next()) {
        return refuse(format!("nothing was appended, because the log is not sound: {fault}"));
    }
    let origin = match (&old, origin) {
        (Some(log), Some(origin)) if log.checkpoint.origin != origin => {
            return refuse(format!(
                "the log is called `{}`, not `{origin}`: omit --origin",
                log.checkpoint.origin
            ));
        }
        (Some(log), _) => log.checkpoint.origin.clone(),
        (None, Some(origin)) => origin.to_owned(),
        (None, None) => return unnamed(),
    };
    let (mut known, mut entries, mut leaves) = match old {
        Some(log) => (log.entries()?, log.entries, log.leaves),
        None => Default::default(),
    };
    let size = entries.len() as u64;
    let before = rules(&known).len();
    known.extend_from_slice(new);
    if let Some(problem) = rules(&known).get(before) {
        return refuse(format!("nothing was appended: {problem}"));
    }
    for entry in new {
        let bytes = entry.to_bytes()?;
        leaves.push(tree::leaf(&bytes));
        entries.push(bytes);
    }
    for tile in tiles::files(&entries, &leaves, size) {
        let path = folder.join(&tile.path);
        write_document(&path, &tile.bytes, disk)?;
    }
    let checkpoint = Checkpoint::sign(&origin, entries.len() as u64, tree::root(&leaves), secret);
    let log = Log { folder: folder.to_path_buf(), checkpoint, entries, leaves };
    log.write_checkpoint(&log.checkpoint, disk)?;
    Ok(log)
}

/// Locks the log against appends by other processes until the returned lock is dropped.
fn lock(folder: &Path) -> Result<Lock, TrustError> {
    let path = folder.join(".lock");
    let lock = Lock::take(&path).map_err(TrustError::io("write", &path))?;
    lock.ok_or_else(|| {
        TrustError::Refused(format!("another process is appending to `{}`: try again", folder.in_message()))
    })
}
