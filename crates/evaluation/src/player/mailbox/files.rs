//! The names and contents of mailbox files, and the functions that read and write them.

use crate::client::ChatMessage;
use crate::error::EvaluationError;
use disk::Access;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs;
use std::io;
use std::path::Path;
use std::str::FromStr;

/// The name of the file that marks a folder as a mailbox.
pub(super) const MARKER_FILE: &str = "mailbox.json";
/// The name of the lock file, locked by the evaluation that writes to the mailbox.
pub(super) const LOCK_FILE: &str = ".lock";
/// The name of the file with an episode's result, or with the result of the entire evaluation.
pub(super) const FINISHED_FILE: &str = "finished.json";
/// The name of the file with an episode's last message.
pub(super) const FINISHED_TEXT: &str = "finished.txt";
/// The name of the file that describes the problem with the answer most recently set aside.
pub(super) const PROBLEM_FILE: &str = "problem.txt";

/// The maximum size of an answer, in bytes (256 KiB).
pub const MAX_ANSWER: usize = 1 << 18;
/// The maximum size of any other file in a mailbox, in bytes.
pub(super) const MAX_FILE: u64 = 1 << 26;

/// A prompt's address within its episode, such as `0007-0`. The names of the prompt's files are derived from
/// it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Address {
    /// The number of actions played before the decision.
    pub step: u64,
    /// The number of rejected answers to this turn.
    pub attempt: u32,
}

impl Address {
    /// Returns the name of the file that contains the prompt as text.
    pub fn prompt_text(self) -> String {
        format!("{self}.prompt.txt")
    }

    /// Returns the name of the file that contains the prompt as JSON ([`PromptFile`]).
    pub fn prompt_data(self) -> String {
        format!("{self}.prompt.json")
    }

    /// Returns the name of the prompt's image file.
    pub fn picture(self) -> String {
        format!("{self}.png")
    }

    /// Returns the name of the prompt's answer file.
    pub fn answer(self) -> String {
        format!("{self}.answer.txt")
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{}", self.step, self.attempt)
    }
}

impl FromStr for Address {
    type Err = ();

    fn from_str(text: &str) -> Result<Address, ()> {
        let (step, attempt) = text.split_once('-').ok_or(())?;
        let number = |digits: &str| {
            let digits = Some(digits).filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
            digits.and_then(|digits| digits.parse::<u64>().ok()).ok_or(())
        };
        let attempt = u32::try_from(number(attempt)?).map_err(|_| ())?;
        let address = Address { step: number(step)?, attempt };
        // Each address has exactly one valid name.
        if address.to_string() == text { Ok(address) } else { Err(()) }
    }
}

/// A prompt, as stored in its JSON file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PromptFile {
    /// The version of the file format.
    pub format: u32,
    /// The name of the episode's folder.
    pub episode: String,
    /// The prompt's address.
    #[serde(flatten)]
    pub address: Address,
    /// The available actions.
    pub actions: Vec<String>,
    /// The name of the answer file, in the prompt's folder.
    pub answer: String,
    /// The conversation without images, oldest message first.
    pub messages: Vec<ChatMessage>,
    /// The name of the PNG file with the newest message's image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
}

/// Writes a file atomically.
pub(super) fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), EvaluationError> {
    let path = folder.join(name);
    disk::write(&path, bytes, Access::Shared).map_err(EvaluationError::io("write", &path))
}

/// Writes data to a file as indented JSON.
pub(super) fn write_data(folder: &Path, name: &str, data: &impl Serialize) -> Result<(), EvaluationError> {
    let text = serde_json::to_string_pretty(data).expect("plain data") + "\n";
    write(folder, name, text.as_bytes())
}

/// Reads data from a JSON file. Returns `None` if the file does not exist.
///
/// # Errors
/// Returns an error if the path is not a plain file with data of this type, or if the file cannot be read.
pub(super) fn read_data<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, EvaluationError> {
    let Some(text) = read_text(path)? else { return Ok(None) };
    let wrong = |error: serde_json::Error| {
        EvaluationError::malformed(path, format!("not a mailbox file ({error}); remove the mailbox"))
    };
    serde_json::from_str(&text).map(Some).map_err(wrong)
}

/// Reads a text file. Returns `None` if the file does not exist.
pub(super) fn read_text(path: &Path) -> Result<Option<String>, EvaluationError> {
    match fs::symlink_metadata(path) {
        Err(error) if is_absent(&error) => return Ok(None),
        Err(error) => return Err(EvaluationError::io("read", path)(error)),
        Ok(found) if !found.is_file() || found.len() > MAX_FILE => {
            return Err(EvaluationError::malformed(path, "not a mailbox file; remove the file"));
        }
        Ok(_) => {}
    }
    match disk::read_no_follow(path, MAX_FILE) {
        Ok(None) => Err(EvaluationError::malformed(path, "not a mailbox file; remove the file")),
        Ok(Some(bytes)) => Ok(Some(String::from_utf8_lossy(&bytes).into_owned())),
        // The evaluation may remove the files of answered prompts at any time.
        Err(error) if is_absent(&error) => Ok(None),
        Err(error) => Err(EvaluationError::io("read", path)(error)),
    }
}

pub(super) fn is_absent(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::NotFound
}

/// Returns the names in a folder, sorted. Hidden and non-Unicode names are omitted.
pub(super) fn names(folder: &Path) -> Result<Vec<String>, EvaluationError> {
    let list = || -> io::Result<Vec<String>> {
        let mut names = Vec::new();
        for entry in fs::read_dir(folder)? {
            names.extend(entry?.file_name().into_string().ok().filter(|name| !name.starts_with('.')));
        }
        names.sort();
        Ok(names)
    };
    list().map_err(EvaluationError::io("list", folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_address_has_one_name() {
        let check = |text: &str, expect: Option<(u64, u32)>| {
            let found = text.parse::<Address>().ok().map(|found| (found.step, found.attempt));
            assert_eq!(found, expect, "{text}");
        };
        check("0007-0", Some((7, 0)));
        check("12345-1", Some((12_345, 1)));
        for other in ["7-0", "0007", "0007-00", "+007-0", "0007-0 ", "-", "99999999999999999999-0", "0007--1"]
        {
            check(other, None);
        }
    }
}
