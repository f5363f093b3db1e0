//! Appends events to an episode's log, and reads them back.

use crate::error::EvaluationError;
use crate::log::event::Event;
use crate::run::text::{RESTORE, is_there, open_file};
use itertools::Itertools;
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// The maximum size of a log, in bytes. The log of a long episode with extensive model reasoning can occupy
/// several hundred megabytes.
const MAX_LOG: u64 = 1 << 30;

/// The recommendation in error messages about damaged or modified logs.
pub(crate) const NEXT_STEP: &str = "the log is damaged or was changed: restore it, or remove it and play the episode again with `arcade evaluate --resume`";

/// An episode's open log. Once [`Journal::push`] returns, the event has been written to the file.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: Option<File>,
    events: Vec<Event>,
    /// The range of events that belong to the current step. The end is set only if the step was decided in an
    /// earlier run.
    step: (usize, Option<usize>),
}

impl Journal {
    /// Opens the log at `path`. Events from an interrupted run are kept, except for a truncated last line.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or written, or is not a log.
    pub fn open(path: &Path) -> Result<Journal, EvaluationError> {
        let (events, sound) = if is_there(path)? { read_prefix(path)? } else { (Vec::new(), 0) };
        let file = disk::append_no_follow(path).map_err(EvaluationError::io("open", path))?;
        file.set_len(sound).map_err(EvaluationError::io("truncate", path))?;
        Ok(Journal { path: path.to_owned(), file: Some(file), events, step: (0, None) })
    }

    /// Creates a log that exists only in memory.
    pub fn in_memory() -> Journal {
        Journal { path: PathBuf::new(), file: None, events: Vec::new(), step: (0, None) }
    }

    /// Appends an event to the log.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, for example because the disk is full.
    pub fn push(&mut self, event: Event) -> Result<(), EvaluationError> {
        if let Some(file) = &mut self.file {
            let mut line = serde_json::to_string(&event).expect("events are plain data");
            line.push('\n');
            file.write_all(line.as_bytes()).map_err(EvaluationError::io("write", &self.path))?;
        }
        self.events.push(event);
        Ok(())
    }

    /// Returns all events recorded so far.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Returns the current step's events other than its [`Event::Step`]. After an interruption, they may
    /// include requests and replies.
    pub fn pending(&self) -> &[Event] {
        let (from, to) = self.step;
        &self.events[from..to.unwrap_or(self.events.len())]
    }

    /// Sets the range of events returned by [`pending`](Journal::pending): from `from` to `to`, or to the
    /// last event.
    pub(crate) fn set_step(&mut self, from: usize, to: Option<usize>) {
        self.step = (from, to);
    }

    /// Removes all events from the log.
    pub(crate) fn clear(&mut self) -> Result<(), EvaluationError> {
        if let Some(file) = &self.file {
            file.set_len(0).map_err(EvaluationError::io("empty", &self.path))?;
        }
        self.events.clear();
        self.step = (0, None);
        Ok(())
    }

    /// Returns an error about this log.
    pub(crate) fn malformed(&self, what: &str) -> EvaluationError {
        EvaluationError::malformed(&self.path, what)
    }
}

/// Reads the events of the log at `path`, ignoring a truncated last line.
///
/// # Errors
/// Returns an error if the file cannot be read, or is not a log.
pub fn read(path: &Path) -> Result<Vec<Event>, EvaluationError> {
    read_prefix(path).map(|(events, _)| events)
}

/// Returns a log's events and their total size in bytes.
fn read_prefix(path: &Path) -> Result<(Vec<Event>, u64), EvaluationError> {
    let mut file = BufReader::new(open_file(path, MAX_LOG, RESTORE)?.take(MAX_LOG));
    let (mut events, mut sound, mut line) = (Vec::new(), 0, Vec::new());
    loop {
        line.clear();
        let length = file.read_until(b'\n', &mut line).map_err(EvaluationError::io("read", path))?;
        let Some(whole) = line.strip_suffix(b"\n") else { return Ok((events, sound)) };
        let event = serde_json::from_slice(whole).map_err(|error| {
            let number = events.len() + 1;
            let what =
                format!("line {number} is not an event of an episode: {}; {NEXT_STEP}", fault(whole, &error));
            EvaluationError::malformed(path, what)
        })?;
        events.push(event);
        sound += length as u64;
    }
}

/// Returns a sentence that explains why a line is not an event.
fn fault(line: &[u8], error: &serde_json::Error) -> String {
    let value = match serde_json::from_slice(line) {
        Ok(Value::Object(value)) => value,
        Ok(_) => return "the line is not a JSON object".to_owned(),
        // The parser sees only one line.
        Err(error) => return format!("the line is not valid JSON (at column {})", error.column()),
    };
    let Some(name) = value.get("event").and_then(Value::as_str) else {
        return "the field `event` is missing".to_owned();
    };
    // The parser's message begins with the fault and continues with the expected input.
    let said = error.to_string();
    let named = said.split('`').nth(1).unwrap_or_default();
    match said.split_whitespace().take(2).join(" ").as_str() {
        "unknown variant" if named == name => format!("`{name}` isn't an event"),
        "unknown field" => format!("`{named}` isn't a field of `{name}`"),
        "missing field" => format!("`{name}` lacks the field `{named}`"),
        _ => format!("a field of `{name}` has an invalid value"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_lines() {
        let halt = "{\"event\":\"halt\",\"reason\":\"budget\",\"message\":\"\"}";
        for (line, expect) in [
            ("hello", "the line is not valid JSON (at column 1)"),
            (&halt[..30], "the line is not valid JSON (at column 30)"),
            ("[1, 2]", "the line is not a JSON object"),
            ("{\"step\": 3}", "the field `event` is missing"),
            (&halt.replace("halt", "stop"), "`stop` isn't an event"),
            (&halt.replace("reason", "cause"), "`cause` isn't a field of `halt`"),
            (&halt.replace(",\"message\":\"\"", ""), "`halt` lacks the field `message`"),
            (&halt.replace("\"budget\"", "7"), "a field of `halt` has an invalid value"),
        ] {
            let error = serde_json::from_str::<Event>(line).expect_err(line);
            assert_eq!(fault(line.as_bytes(), &error), expect, "{line}: {error}");
        }
        assert!(serde_json::from_str::<Event>(halt).is_ok());
    }
}
