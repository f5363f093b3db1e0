//! A folder of drafts: its settings, logs, finished drafts and accepted games.

use crate::draft::Draft;
use crate::error::DesignError;
use crate::settings::{DesignSettings, FORMAT};
use base::canonical::to_canonical_json;
use disk::{Access, Lock};
use engine::SEMANTICS;
use evaluation::Event;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The name of the folder of accepted games, which contains one folder per game.
pub const GAMES_FOLDER: &str = "games";
/// The name of the file with the results of all drafts.
pub const RESULTS_FILE: &str = "results.json";
const SETTINGS_FILE: &str = "settings.json";
const LOGS_FOLDER: &str = "logs";
const DRAFTS_FOLDER: &str = "drafts";
const LOCK_FILE: &str = ".lock";
/// The name of the file with an accepted game's provenance, stored beside its rules and levels.
const PROVENANCE_FILE: &str = "design.json";
/// The maximum size of a file other than a log, in bytes.
const MAX_FILE: u64 = 1 << 26;

/// A folder of drafts. While it is open for writing, no other process can write to it.
#[derive(Debug)]
pub struct DesignFolder {
    path: PathBuf,
    /// The run's settings.
    pub settings: DesignSettings,
    _lock: Option<Lock>,
}

impl DesignFolder {
    /// Creates a folder, which must be absent or empty.
    ///
    /// # Errors
    /// Returns an error if the folder is not empty or cannot be written.
    pub fn create(path: &Path, settings: DesignSettings) -> Result<DesignFolder, DesignError> {
        disk::create_folder(path).map_err(DesignError::io("create", path))?;
        let mut entries = fs::read_dir(path).map_err(DesignError::io("list", path))?;
        if entries.next().is_some() {
            let what = "the folder is not empty; choose a new folder, or pass --resume to continue a run of the same command";
            return Err(DesignError::malformed(path, what));
        }
        let lock = lock(path)?;
        write(&path.join(SETTINGS_FILE), &settings)?;
        Ok(DesignFolder { path: path.to_owned(), settings, _lock: Some(lock) })
    }

    /// Opens the folder of an interrupted run with the same settings.
    ///
    /// # Errors
    /// Returns an error if the folder contains no run, or a run with different settings.
    pub fn resume(path: &Path, settings: &DesignSettings) -> Result<DesignFolder, DesignError> {
        let opened = DesignFolder::open(path)?;
        if opened.settings != *settings {
            let what = format!(
                "the run in this folder has a different {}; repeat the command that started the run, or choose a new folder",
                difference(&opened.settings, settings)
            );
            return Err(DesignError::malformed(path, &what));
        }
        Ok(DesignFolder { _lock: Some(lock(path)?), ..opened })
    }

    /// Opens a folder for reading.
    ///
    /// # Errors
    /// Returns an error if the folder contains no run, or a run of a different version.
    pub fn open(path: &Path) -> Result<DesignFolder, DesignError> {
        let file = path.join(SETTINGS_FILE);
        let Some(settings) = read::<serde_json::Value>(&file)? else {
            let what =
                "there are no drafts here; `arcade design … --out DIR` writes drafts to the folder DIR";
            return Err(DesignError::malformed(path, what));
        };
        let number = |key: &str| settings.get(key).and_then(serde_json::Value::as_u64);
        if number("format").is_some_and(|format| format != u64::from(FORMAT)) {
            let what = format!(
                "this version of arcade reads format {FORMAT} only; use the version that wrote the folder"
            );
            return Err(DesignError::malformed(&file, &what));
        }
        if number("semantics").is_some_and(|semantics| semantics != u64::from(SEMANTICS)) {
            let what = format!(
                "this version of arcade has SEMANTICS {SEMANTICS}; use the version that wrote the folder"
            );
            return Err(DesignError::malformed(&file, &what));
        }
        let settings: DesignSettings =
            read(&file)?.ok_or_else(|| DesignError::malformed(&file, "the file has disappeared"))?;
        Ok(DesignFolder { path: path.to_owned(), settings, _lock: None })
    }

    /// Returns the path of a draft's log.
    pub fn log(&self, number: u64) -> PathBuf {
        self.path.join(LOGS_FOLDER).join(format!("{}.jsonl", conversation(number)))
    }

    /// Creates the folder for the logs.
    pub(crate) fn begin_logs(&self) -> Result<(), DesignError> {
        let folder = self.path.join(LOGS_FOLDER);
        disk::create_folder_no_follow(&folder).map_err(DesignError::io("create", &folder))
    }

    /// Returns the events in a draft's log, or `None` if the draft was not started.
    ///
    /// # Errors
    /// Returns an error if the log cannot be read.
    pub fn events(&self, number: u64) -> Result<Option<Vec<Event>>, DesignError> {
        let path = self.log(number);
        match fs::symlink_metadata(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            _ => Ok(Some(evaluation::log::read(&path)?)),
        }
    }

    /// Returns the events in all logs, which record the amounts that earlier runs spent.
    ///
    /// # Errors
    /// Returns an error if a log cannot be read.
    pub fn all_events(&self) -> Result<Vec<Event>, DesignError> {
        let mut all = Vec::new();
        for number in 0..self.settings.drafts {
            all.append(&mut self.events(number)?.unwrap_or_default());
        }
        Ok(all)
    }

    fn draft_file(&self, number: u64) -> PathBuf {
        self.path.join(DRAFTS_FOLDER).join(format!("{}.json", conversation(number)))
    }

    /// Returns a finished draft, or `None` if the draft is not finished.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or is damaged.
    pub fn draft(&self, number: u64) -> Result<Option<Draft>, DesignError> {
        read(&self.draft_file(number))
    }

    /// Stores a finished draft. If the draft was accepted, stores its game first.
    pub(crate) fn store(&self, draft: &Draft) -> Result<(), DesignError> {
        if draft.is_accepted() {
            self.store_game(draft)?;
        }
        let folder = self.path.join(DRAFTS_FOLDER);
        disk::create_folder_no_follow(&folder).map_err(DesignError::io("create", &folder))?;
        write(&self.draft_file(draft.number), draft)
    }

    /// Writes an accepted game in the layout that every command accepts. The rules are written last, so that a folder
    /// with missing levels does not count as a game.
    fn store_game(&self, draft: &Draft) -> Result<(), DesignError> {
        let (Some(name), Some(rules)) = (&draft.name, &draft.rules) else { return Ok(()) };
        let folder = self.path.join(GAMES_FOLDER).join(name);
        disk::create_folder_no_follow(&folder).map_err(DesignError::io("create", &folder))?;
        for (number, level) in draft.levels.iter().enumerate() {
            write_text(&folder.join(format!("lvl{number}.txt")), level)?;
        }
        let settings = &self.settings;
        let provenance = json!({
            "format": FORMAT,
            "designer": settings.designer,
            "details": settings.details,
            "suite": settings.suite,
            "semantics": settings.semantics,
            "settings": settings.digest(),
            "draft": draft.number,
            "idea": draft.idea,
            "repairs": draft.repairs,
            "measures": draft.measures,
            "spending": draft.spending,
            "answers": draft.answers,
        });
        write(&folder.join(PROVENANCE_FILE), &provenance)?;
        write_text(&folder.join("game.vgdl"), rules)
    }

    /// Writes the results of all drafts.
    pub(crate) fn store_results(&self, results: &impl Serialize) -> Result<(), DesignError> {
        write(&self.path.join(RESULTS_FILE), results)
    }
}

/// Returns the name of a draft's conversation and files.
pub(crate) fn conversation(number: u64) -> String {
    format!("draft-{number:04}")
}

/// Returns the name of the first setting that differs.
fn difference(one: &DesignSettings, other: &DesignSettings) -> String {
    let fields = |settings: &DesignSettings| match serde_json::to_value(settings) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    };
    let (one, other) = (fields(one), fields(other));
    let differing = one.into_iter().find(|(key, value)| other.get(key) != Some(value));
    differing.map_or("setting".to_owned(), |(key, _)| format!("value of `{key}`"))
}

fn lock(path: &Path) -> Result<Lock, DesignError> {
    let file = path.join(LOCK_FILE);
    let lock = Lock::take(&file).map_err(DesignError::io("lock", &file))?;
    let what =
        "another `arcade design` is writing to this folder; wait until it ends, or choose a different folder";
    lock.ok_or_else(|| DesignError::malformed(path, what))
}

fn write(path: &Path, data: &impl Serialize) -> Result<(), DesignError> {
    write_text(
        path,
        &to_canonical_json(data).expect("drafts contain only finite numbers, which JSON can represent"),
    )
}

fn write_text(path: &Path, text: &str) -> Result<(), DesignError> {
    disk::write(path, text.as_bytes(), Access::Shared).map_err(DesignError::io("write", path))
}

/// Reads a JSON file. Returns `None` if it does not exist.
fn read<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, DesignError> {
    let bytes = match disk::read_no_follow(path, MAX_FILE) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        read => read.map_err(DesignError::io("read", path))?,
    };
    let bytes =
        bytes.ok_or_else(|| DesignError::malformed(path, "the file is too large; restore the folder"))?;
    let wrong =
        |error| DesignError::malformed(path, &format!("the file is damaged ({error}); restore the folder"));
    serde_json::from_slice(&bytes).map(Some).map_err(wrong)
}
