//! Job stores, which keep the results of finished jobs until all jobs are done, either in memory or in a
//! folder that outlives the process.

use crate::Digest;
use crate::error::SnapshotError;
use crate::format::folder;
use crate::sections::frozen::JobResult;
use base::canonical::{canonical_digest, to_canonical_json};
use disk::Access;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A store for the results of finished jobs, by job name. It can be used from several threads.
pub trait JobStore: Sync {
    /// Returns a stored result; `None` if the result is missing or damaged.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    fn get(&self, name: &str) -> Result<Option<JobResult>, SnapshotError>;

    /// Stores a result durably, so that it survives a crash.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    fn put(&self, name: &str, job: &JobResult) -> Result<(), SnapshotError>;
}

/// A job store in memory.
#[derive(Debug, Default)]
pub struct Memory(Mutex<BTreeMap<String, JobResult>>);

impl JobStore for Memory {
    fn get(&self, name: &str) -> Result<Option<JobResult>, SnapshotError> {
        let jobs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(jobs.get(name).cloned())
    }

    fn put(&self, name: &str, job: &JobResult) -> Result<(), SnapshotError> {
        let mut jobs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        jobs.insert(name.to_owned(), job.clone());
        Ok(())
    }
}

/// A job store in a folder, with one file per result. Each file is either complete or absent.
#[derive(Debug)]
pub struct JobFolder {
    folder: PathBuf,
    /// The digest of the plan. Results from different plans are ignored.
    plan: Digest,
    /// `true` once the folder contains a file that states the plan.
    is_marked: Mutex<bool>,
    /// `true` if the results are readable only by their owner.
    is_secret: bool,
}

/// The file that identifies the results' plan. It prevents results from a different recipe from being discarded by
/// mistake.
const WHOSE: &str = "plan.txt";

/// The maximum size of a result file, in bytes: 64 MiB.
const JOB_LIMIT: u64 = 64 << 20;

/// A result file's content.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct JobFile<T> {
    plan: Digest,
    /// The digest of the result's canonical JSON. It serves to recognise truncated or changed files, which are
    /// ignored.
    digest: Digest,
    result: T,
}

impl JobFolder {
    /// Opens the folder for a plan's results, and creates it if it is missing.
    ///
    /// # Errors
    /// Returns an error if the folder contains results from a different plan, or if a file system operation
    /// fails.
    pub fn open(folder: &Path, plan: Digest) -> Result<JobFolder, SnapshotError> {
        disk::create_folder(folder).map_err(SnapshotError::io("create", folder))?;
        let whose = folder.join(WHOSE);
        let is_marked = match fs::read_to_string(&whose) {
            Ok(text) if text == plan.to_string() => true,
            Ok(_) => return Err(SnapshotError::OtherPlan(folder.to_path_buf())),
            Err(error) if error.kind() == ErrorKind::NotFound => false,
            Err(error) => return Err(SnapshotError::io("read", &whose)(error)),
        };
        let is_marked = Mutex::new(is_marked);
        Ok(JobFolder { folder: folder.to_path_buf(), plan, is_marked, is_secret: false })
    }

    /// Restricts the results to their owner, as sealed releases require.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn keep_secret(&mut self) -> Result<(), SnapshotError> {
        #[cfg(unix)]
        {
            let owner = std::os::unix::fs::PermissionsExt::from_mode(0o700);
            fs::set_permissions(&self.folder, owner).map_err(SnapshotError::io("protect", &self.folder))?;
        }
        self.is_secret = true;
        Ok(())
    }

    /// Returns, for each name, `true` if a folder contains a result with that name. The folder may be absent, and
    /// existing files are not changed.
    ///
    /// # Errors
    /// Returns an error if the folder contains results from a different plan, or if a file system operation
    /// fails.
    pub fn there(folder: &Path, plan: Digest, names: &[String]) -> Result<Vec<bool>, SnapshotError> {
        if !folder.exists() {
            return Ok(vec![false; names.len()]);
        }
        let store = JobFolder::open(folder, plan)?;
        names.iter().map(|name| Ok(store.get(name)?.is_some())).collect()
    }

    /// Writes the plan's digest before the first result.
    fn mark(&self) -> Result<(), SnapshotError> {
        let mut is_marked = self.is_marked.lock().unwrap_or_else(PoisonError::into_inner);
        if !*is_marked {
            self.write(&self.folder.join(WHOSE), &self.plan.to_string())?;
            *is_marked = true;
        }
        Ok(())
    }

    /// Writes a file atomically: it is either complete or absent.
    fn write(&self, path: &Path, text: &str) -> Result<(), SnapshotError> {
        let access = if self.is_secret { Access::Private } else { Access::Shared };
        disk::write(path, text.as_bytes(), access).map_err(SnapshotError::io("write", path))
    }

    /// Returns a stored result of any type; `None` if the result is missing or damaged.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn stored<T: Serialize + DeserializeOwned>(&self, name: &str) -> Result<Option<T>, SnapshotError> {
        let bytes = folder::find(&self.folder, &JobFolder::file(name), JOB_LIMIT)?;
        bytes.map_or(Ok(None), |bytes| JobFolder::parse(self.plan, &bytes))
    }

    /// Stores a result of any type durably, so that it survives a crash.
    ///
    /// # Errors
    /// Returns an error if a file system operation fails.
    pub fn store<T: Serialize>(&self, name: &str, job: &T) -> Result<(), SnapshotError> {
        self.mark()?;
        let text = JobFolder::text(self.plan, job)?;
        self.write(&self.folder.join(JobFolder::file(name)), &text)
    }

    /// Returns a result file's text.
    pub(super) fn text<T: Serialize>(plan: Digest, job: &T) -> Result<String, SnapshotError> {
        let digest = canonical_digest(job)?;
        Ok(to_canonical_json(&JobFile { plan, digest, result: job })?)
    }

    /// Parses the text of a result file; `None` if the text is truncated, changed, or belongs to a different
    /// plan.
    pub(super) fn parse<T: Serialize + DeserializeOwned>(
        plan: Digest,
        bytes: &[u8],
    ) -> Result<Option<T>, SnapshotError> {
        let Ok(file) = serde_json::from_slice::<JobFile<T>>(bytes) else { return Ok(None) };
        let sound = file.plan == plan && canonical_digest(&file.result)? == file.digest;
        Ok(sound.then_some(file.result))
    }

    fn file(name: &str) -> String {
        format!("{name}.json")
    }
}

impl JobStore for JobFolder {
    fn get(&self, name: &str) -> Result<Option<JobResult>, SnapshotError> {
        self.stored(name)
    }

    fn put(&self, name: &str, job: &JobResult) -> Result<(), SnapshotError> {
        self.store(name, job)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use forge::Tally;

    #[test]
    fn a_job_that_is_cut_changed_or_of_another_plan_does_not_count() {
        let home = tempfile::tempdir().unwrap();
        let plan = Digest::of(b"plan");
        let store = JobFolder::open(home.path(), plan).unwrap();
        let tally = Tally { games_tried: 3, ..Tally::default() };
        let job = JobResult { games: Vec::new(), tally };
        assert_eq!(store.get("a").unwrap(), None);
        store.put("a", &job).unwrap();
        assert_eq!(store.get("a").unwrap(), Some(job.clone()));
        let other = JobFolder::open(home.path(), Digest::of(b"other"));
        assert!(matches!(other, Err(SnapshotError::OtherPlan(_))), "{other:?}");
        let (folder, is_marked) = (home.path().to_path_buf(), Mutex::new(true));
        let other = JobFolder { folder, plan: Digest::of(b"other"), is_marked, is_secret: false };
        assert_eq!(other.get("a").unwrap(), None);
        let path = home.path().join("a.json");
        let text = fs::read_to_string(&path).unwrap();
        for damaged in [&text[..text.len() / 2], "", &text.replace(": 3", ": 4")] {
            fs::write(&path, damaged).unwrap();
            assert_eq!(store.get("a").unwrap(), None, "{damaged}");
        }
        store.put("a", &job).unwrap();
        assert_eq!(store.get("a").unwrap(), Some(job));
    }
}
