//! The player's side of a mailbox, where people and programs answer prompts.

use super::files::{
    FINISHED_FILE, FINISHED_TEXT, MAX_ANSWER, PROBLEM_FILE, PromptFile, is_absent, names, read_data,
    read_text,
};
use super::folder::{Finished, is_locked, marker};
use super::player::EpisodeResult;
use crate::error::EvaluationError;
use disk::Access;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The player's access to a mailbox, for reading prompts and delivering answers.
#[derive(Debug)]
pub struct Desk {
    folder: PathBuf,
    player: String,
}

/// A snapshot of a mailbox's content.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// The open prompts, sorted by episode.
    pub waiting: Vec<OpenPrompt>,
    /// The number of answers that the evaluation has not yet read.
    pub answered: usize,
    /// The ended episodes, with their results.
    pub ended: Vec<(String, EpisodeResult)>,
    /// The result of the entire evaluation, once all episodes have ended.
    pub finished: Option<Finished>,
    /// `true` if an evaluation is currently using the mailbox.
    pub is_running: bool,
}

/// An unanswered prompt.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenPrompt {
    /// The prompt to answer.
    pub prompt: PromptFile,
    /// The problem with an earlier answer to the prompt, if an answer was set aside.
    pub problem: Option<String>,
}

/// The result of delivering an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Delivery {
    /// The answer was written to the answer file.
    Delivered,
    /// The prompt already has an answer, or is no longer open.
    TooLate,
    /// The answer was rejected for the given reason.
    Refused(String),
}

impl Desk {
    /// Opens the mailbox in a folder.
    ///
    /// # Errors
    /// Returns an error if the folder does not contain a mailbox, or if the mailbox has a newer format or is
    /// damaged.
    pub fn open(folder: &Path) -> Result<Desk, EvaluationError> {
        // If the path is a file, the error about the marker below it would contain a path that the user did
        // not specify.
        let found = if folder.is_file() { None } else { marker(folder)? };
        match found {
            Some(marker) => Ok(Desk { folder: folder.to_owned(), player: marker.player }),
            None => Err(EvaluationError::malformed(
                folder,
                "there is no mailbox here; `arcade evaluate … --player mailbox:DIR` creates a mailbox in \
                 the folder DIR",
            )),
        }
    }

    /// Returns the player's name in results.
    pub fn player(&self) -> &str {
        &self.player
    }

    /// Returns an episode's folder.
    pub fn episode(&self, episode: &str) -> PathBuf {
        self.folder.join(episode)
    }

    /// Returns the mailbox's current content.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read or is damaged.
    pub fn view(&self) -> Result<View, EvaluationError> {
        // The lock is checked first, so that an evaluation that ends while the files are read is not mistaken
        // for an interrupted one.
        let is_running = is_locked(&self.folder);
        let finished = read_data(&self.folder.join(FINISHED_FILE))?;
        let mut view = View { finished, is_running, ..View::default() };
        for episode in names(&self.folder)? {
            let folder = self.episode(&episode);
            if !fs::symlink_metadata(&folder).is_ok_and(|found| found.is_dir()) {
                continue;
            }
            if let Some(result) = read_data(&folder.join(FINISHED_FILE))? {
                view.ended.push((episode, result));
                continue;
            }
            let names = names(&folder)?;
            let is_answered = |name: &String| {
                let answer = name.strip_suffix(".prompt.json").map(|address| format!("{address}.answer.txt"));
                answer.is_some_and(|answer| names.contains(&answer))
            };
            let prompts = names.iter().filter(|name| name.ends_with(".prompt.json") && !is_answered(name));
            view.answered += names.iter().filter(|name| is_answered(name)).count();
            let Some(name) = prompts.max() else { continue };
            let Some(prompt) = read_data::<PromptFile>(&folder.join(name))? else { continue };
            // A prompt file states its episode and its address, which must match the file's path.
            if prompt.episode == episode && prompt.address.prompt_data() == *name {
                let problem = read_text(&folder.join(PROBLEM_FILE))?.map(|text| text.trim().to_owned());
                view.waiting.push(OpenPrompt { prompt, problem });
            }
        }
        Ok(view)
    }

    /// Returns an episode's last message, or `None` if the episode has not ended.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read.
    pub fn ending(&self, episode: &str) -> Result<Option<String>, EvaluationError> {
        read_text(&self.episode(episode).join(FINISHED_TEXT))
    }

    /// Delivers a prompt's answer, unless the prompt already has an answer.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn answer(&self, prompt: &PromptFile, text: &str) -> Result<Delivery, EvaluationError> {
        if text.trim().is_empty() {
            return Ok(Delivery::Refused("the answer is empty".to_owned()));
        }
        if text.len() >= MAX_ANSWER {
            let (bytes, limit) = (text.len(), MAX_ANSWER / 1024);
            return Ok(Delivery::Refused(format!("the answer has {bytes} bytes; the limit is {limit} KiB")));
        }
        let folder = self.episode(&prompt.episode);
        if !folder.join(prompt.address.prompt_data()).exists() {
            return Ok(Delivery::TooLate);
        }
        let path = folder.join(prompt.address.answer());
        match disk::create(&path, format!("{}\n", text.trim_end()).as_bytes(), Access::Shared) {
            Ok(()) => Ok(Delivery::Delivered),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists || is_absent(&error) => {
                Ok(Delivery::TooLate)
            }
            Err(error) => Err(EvaluationError::io("write", &path)(error)),
        }
    }
}
