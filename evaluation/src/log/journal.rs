//! Appending to the log of an episode, and reading it back.

use crate::error::EvaluationError;
use crate::log::event::Event;
use crate::run::text::open_file;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// Bytes of a log at most: a long episode of a model that reasons at length has some hundred million.
const MAX_LOG: u64 = 1 << 30;

/// The next move for a log that is damaged or was changed.
pub(crate) const NEXT_MOVE: &str = "the log is damaged or was changed: get it again, or remove it and have the episode played again by `arcade evaluate` with --resume";

/// The open log of an episode. Every event is on its way to the disk when [`Journal::push`] returns.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: Option<File>,
    events: Vec<Event>,
    /// The events of the step that is being decided: from here, to there if it has been decided before.
    step: (usize, Option<usize>),
}

impl Journal {
    /// Opens the log at `path`; what an interrupted run has left there is kept, but for a last line that was cut off.
    ///
    /// # Errors
    /// The file cannot be read or written, or it is not a log.
    pub fn open(path: &Path) -> Result<Journal, EvaluationError> {
        let (events, sound) = if path.exists() { read_prefix(path)? } else { (Vec::new(), 0) };
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.map_err(EvaluationError::io("open", path))?;
        file.set_len(sound).map_err(EvaluationError::io("mend", path))?;
        Ok(Journal { path: path.to_owned(), file: Some(file), events, step: (0, None) })
    }

    /// A log that is kept in memory only.
    pub fn in_memory() -> Journal {
        Journal { path: PathBuf::new(), file: None, events: Vec::new(), step: (0, None) }
    }

    /// Appends an event.
    ///
    /// # Errors
    /// The file cannot be written: the disk is full, say.
    pub fn push(&mut self, event: Event) -> Result<(), EvaluationError> {
        if let Some(file) = &mut self.file {
            let mut line = serde_json::to_string(&event).expect("events are plain data");
            line.push('\n');
            file.write_all(line.as_bytes()).map_err(EvaluationError::io("write", &self.path))?;
        }
        self.events.push(event);
        Ok(())
    }

    /// All events so far.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Events of the step that is being decided, its [`Event::Step`] not among them. After an interruption there may be
    /// requests and replies already.
    pub fn pending(&self) -> &[Event] {
        let (from, to) = self.step;
        &self.events[from..to.unwrap_or(self.events.len())]
    }

    /// Which events [`pending`](Journal::pending) gives: from this number, to that one or to the last.
    pub(crate) fn set_step(&mut self, from: usize, to: Option<usize>) {
        self.step = (from, to);
    }

    /// Starts the log anew.
    pub(crate) fn clear(&mut self) -> Result<(), EvaluationError> {
        if let Some(file) = &self.file {
            file.set_len(0).map_err(EvaluationError::io("empty", &self.path))?;
        }
        self.events.clear();
        self.step = (0, None);
        Ok(())
    }

    /// That something is wrong with this log.
    pub(crate) fn complaint(&self, what: &str) -> EvaluationError {
        EvaluationError::Malformed(format!("{}: {what}", self.path.display()))
    }
}

/// The events of the log at `path`, a cut-off last line left out.
///
/// # Errors
/// It cannot be read, or it is not a log.
pub fn read(path: &Path) -> Result<Vec<Event>, EvaluationError> {
    read_prefix(path).map(|(events, _)| events)
}

/// The events, and the bytes that they take.
fn read_prefix(path: &Path) -> Result<(Vec<Event>, u64), EvaluationError> {
    let mut file = BufReader::new(open_file(path, MAX_LOG)?.take(MAX_LOG));
    let (mut events, mut sound, mut line) = (Vec::new(), 0, Vec::new());
    loop {
        line.clear();
        let length = file.read_until(b'\n', &mut line).map_err(EvaluationError::io("read", path))?;
        let Some(whole) = line.strip_suffix(b"\n") else { return Ok((events, sound)) };
        let event = serde_json::from_slice(whole).map_err(|error| {
            let (path, number) = (path.display(), events.len() + 1);
            // The parser sees one line only.
            let why = error.to_string().replace(" at line 1 column", " at column");
            EvaluationError::Malformed(format!(
                "{path}: line {number} is not an event of an episode ({why}); {NEXT_MOVE}"
            ))
        })?;
        events.push(event);
        sound += length as u64;
    }
}
