//! Appending to the log of an episode, and reading it back.

use crate::error::EvaluationError;
use crate::log::event::Event;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

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
    let text = std::fs::read(path).map_err(EvaluationError::io("read", path))?;
    let (mut events, mut sound) = (Vec::new(), 0);
    for (number, line) in text.split_inclusive(|&byte| byte == b'\n').enumerate() {
        let Some(whole) = line.strip_suffix(b"\n") else { break };
        let event = serde_json::from_slice(whole).map_err(|error| {
            let path = path.display();
            EvaluationError::Malformed(format!("{path}:{}: not an event of an episode: {error}", number + 1))
        })?;
        events.push(event);
        sound += line.len();
    }
    Ok((events, sound as u64))
}
