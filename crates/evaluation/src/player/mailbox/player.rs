//! An agent that plays an episode through mailbox files.

use super::MAILBOX_FORMAT;
use super::files::{
    Address, FINISHED_FILE, FINISHED_TEXT, MAX_ANSWER, PROBLEM_FILE, PromptFile, is_absent, names, write,
    write_data,
};
use super::folder::Mailbox;
use crate::client::{
    ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Decoding, Finish, Model, Role, Usage,
};
use crate::error::EvaluationError;
use crate::log::{Event, Journal};
use crate::player::{Agent, Choice, Halt, ModelPlayer, Said};
use crate::prompt::Prompter;
use crate::run::Task;
use crate::run::clock::Stopwatch;
use crate::thought::stated_count;
use crate::turn::Turn;
use engine::Outcome;
use itertools::Itertools;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// The pause between checks for an answer file.
const PAUSE: Duration = Duration::from_millis(100);

/// An agent whose prompts and answers are files in its episode's folder. Prompts, feedback on invalid
/// answers, and parsing are the same as for a language model.
pub struct MailboxPlayer {
    player: ModelPlayer,
    prompter: Arc<Prompter>,
    folder: Arc<EpisodeFolder>,
}

/// An episode's result, as recorded in its folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EpisodeResult {
    /// The game's outcome, or `ongoing` if the step limit was reached.
    pub outcome: Outcome,
    /// The episode's final score.
    pub score: f64,
    /// The number of actions played.
    pub steps: u64,
}

/// An episode's folder, acting as a model. It answers a request once the answer file has been written.
#[derive(Debug)]
struct EpisodeFolder {
    mailbox: Arc<Mailbox>,
    episode: String,
    path: PathBuf,
    open: Mutex<Open>,
}

/// The current prompt, or the next prompt to open.
#[derive(Debug, Default)]
struct Open {
    address: Address,
    actions: Vec<String>,
}

impl MailboxPlayer {
    /// Creates a player for one episode of the prompter's game. `reasks` is the maximum number of times that a question
    /// is repeated after an answer without an available action.
    pub fn new(
        mailbox: Arc<Mailbox>,
        task: &Task<'_>,
        prompter: Arc<Prompter>,
        reasks: u32,
    ) -> MailboxPlayer {
        let folder = Arc::new(EpisodeFolder::of(mailbox, task));
        let samples = task.chance().child("answers", 0);
        let player = ModelPlayer::new(folder.clone(), prompter.clone(), Decoding::default(), reasks, samples);
        MailboxPlayer { player, prompter, folder }
    }
}

impl MailboxPlayer {
    /// Sets the address and the actions of the next prompt, which belongs to the given turn.
    fn open(&self, turn: &Turn<'_>, journal: &Journal) {
        let answered = journal.pending().iter().filter(|event| matches!(event, Event::Reply(_))).count();
        let address = Address { step: turn.number, attempt: answered as u32 };
        let actions = turn.actions.iter().map(ToString::to_string).collect();
        *self.folder.open.lock().expect("no holder panics") = Open { address, actions };
    }

    /// Removes the files of a prompt whose answer has been logged.
    fn close<T>(&self, answered: Result<T, Halt>) -> Result<T, Halt> {
        let answered = answered.map_err(|halt| self.folder.mailbox.stopped().unwrap_or(halt))?;
        self.folder.clear(None).map_err(|error| Halt::Infrastructure(told(&error)))?;
        Ok(answered)
    }
}

impl Agent for MailboxPlayer {
    fn begin(&mut self, task: &Task<'_>) {
        if self.folder.episode != episode_of(task) {
            self.folder = Arc::new(EpisodeFolder::of(self.folder.mailbox.clone(), task));
            self.player.set_model(self.folder.clone());
        }
        self.player.begin(task);
    }

    fn act(&mut self, turn: &Turn<'_>, journal: &mut Journal) -> Result<Choice, Halt> {
        self.open(turn, journal);
        let choice = self.player.act(turn, journal);
        self.close(choice)
    }

    fn predict(
        &mut self,
        last: &Turn<'_>,
        kinds: &[String],
        journal: &mut Journal,
    ) -> Result<Option<Said>, Halt> {
        self.open(last, journal);
        let said = self.player.predict(last, kinds, journal);
        if matches!(said, Ok(None)) { said } else { self.close(said) }
    }

    fn recall(&mut self, turn: &Turn<'_>, journal: &Journal, choice: &Choice) -> Result<(), Halt> {
        self.player.recall(turn, journal, choice)
    }

    fn end(&mut self, last: &Turn<'_>) {
        let result = EpisodeResult {
            outcome: last.observation.outcome,
            score: last.observation.score,
            steps: last.number,
        };
        let text = self.prompter.ending(last) + "\n";
        if let Err(error) = self.folder.finish(&result, &text) {
            (self.folder.mailbox.notices)(&told(&error));
        }
    }
}

impl Mailbox {
    /// Asks one question in a conversation that is not an episode, and waits for the answer. The files are in the
    /// subfolder `conversation` of the mailbox. If the address already has an answer, that answer is used immediately.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read or written, or if [`stop`](Mailbox::stop) was called.
    pub fn ask(
        self: &Arc<Self>,
        conversation: &str,
        address: Address,
        messages: &[ChatMessage],
    ) -> Result<ChatReply, ChatError> {
        let folder = EpisodeFolder::named(self.clone(), conversation);
        *folder.open.lock().expect("no holder panics") = Open { address, actions: Vec::new() };
        folder.answer(messages).map_err(|error| unanswered(&error))
    }

    /// Removes the files of a conversation's open question, and writes its result and its last message.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    pub fn end(
        self: &Arc<Self>,
        conversation: &str,
        result: &EpisodeResult,
        text: &str,
    ) -> Result<(), EvaluationError> {
        EpisodeFolder::named(self.clone(), conversation).finish(result, text)
    }
}

/// Returns the name of an episode's folder.
fn episode_of(task: &Task<'_>) -> String {
    let name = task.file_name();
    name.strip_suffix(".jsonl").unwrap_or(&name).to_owned()
}

impl EpisodeFolder {
    fn of(mailbox: Arc<Mailbox>, task: &Task<'_>) -> EpisodeFolder {
        EpisodeFolder::named(mailbox, &episode_of(task))
    }

    fn named(mailbox: Arc<Mailbox>, episode: &str) -> EpisodeFolder {
        let path = mailbox.folder.join(episode);
        EpisodeFolder { mailbox, episode: episode.to_owned(), path, open: Mutex::default() }
    }

    /// Creates the episode's folder unless it already exists.
    fn create(&self) -> Result<(), EvaluationError> {
        match fs::create_dir(&self.path) {
            Ok(()) => Ok(()),
            Err(_) if fs::symlink_metadata(&self.path).is_ok_and(|found| found.is_dir()) => Ok(()),
            Err(error) => Err(EvaluationError::io("create", &self.path)(error)),
        }
    }

    /// Removes all earlier answers, and all prompt files except those at address `kept`.
    fn clear(&self, kept: Option<Address>) -> Result<(), EvaluationError> {
        let names = names(&self.path)?;
        let is_removed = |name: &&String| match split(name) {
            Some((address, "answer.txt")) => kept.is_none_or(|kept| address < kept),
            Some((address, "prompt.txt" | "prompt.json" | "png")) => kept != Some(address),
            _ => false,
        };
        let mut removed: Vec<&String> = names.iter().filter(is_removed).collect();
        // Answers are removed last, because a prompt whose answer is already gone would be mistaken for an
        // open prompt.
        removed.sort_by_key(|name| name.ends_with(".answer.txt"));
        removed.into_iter().try_for_each(|name| remove(&self.path.join(name)))
    }

    /// Writes a prompt's files. The text file is written last.
    fn show(&self, open: &Open, messages: &[ChatMessage]) -> Result<(), EvaluationError> {
        let address = open.address;
        let picture = messages.last().and_then(|message| message.image.as_deref());
        if let Some(picture) = picture {
            write(&self.path, &address.picture(), picture)?;
        }
        let without_picture = |message: &ChatMessage| ChatMessage { image: None, ..message.clone() };
        let prompt = PromptFile {
            format: MAILBOX_FORMAT,
            episode: self.episode.clone(),
            address,
            actions: open.actions.clone(),
            answer: address.answer(),
            messages: messages.iter().map(without_picture).collect(),
            picture: picture.map(|_| address.picture()),
        };
        write_data(&self.path, &address.prompt_data(), &prompt)?;
        write(&self.path, &address.prompt_text(), conversation(messages).as_bytes())
    }

    /// Waits for the answer to the open prompt, or until the evaluation stops. Unsuitable answer files are
    /// set aside with a notice.
    fn wait(&self, address: Address) -> Result<String, EvaluationError> {
        let (mut last, mut is_told) = (None, false);
        loop {
            for name in names(&self.path)? {
                let Some((other, "answer.txt")) = split(&name) else { continue };
                if other != address {
                    self.set_aside(
                        &name,
                        &format!("the file answers {other}, but the open prompt is {address}"),
                    )?;
                }
            }
            let name = address.answer();
            match look(&self.path.join(&name))? {
                Look::Absent => last = None,
                Look::Empty if is_told => last = None,
                Look::Empty => {
                    (last, is_told) = (None, true);
                    self.notice(&format!("{name} is still empty: waiting for an answer"));
                }
                Look::Wrong(why) => {
                    last = None;
                    self.set_aside(&name, &why)?;
                }
                // A file that is still being written will have different bytes at the next check.
                Look::Bytes(bytes) if last.as_ref() != Some(&bytes) => last = Some(bytes),
                Look::Bytes(bytes) => match String::from_utf8(bytes) {
                    Ok(text) => {
                        remove(&self.path.join(PROBLEM_FILE))?;
                        return Ok(text);
                    }
                    Err(error) => {
                        let at = error.utf8_error().valid_up_to();
                        self.set_aside(
                            &name,
                            &format!("the file is not valid UTF-8 (at byte {at}); save it as UTF-8"),
                        )?;
                        last = None;
                    }
                },
            }
            if self.mailbox.stopped().is_some() {
                return Err(EvaluationError::malformed(&self.path, "the evaluation was stopped"));
            }
            thread::sleep(PAUSE);
        }
    }

    /// Renames an unsuitable answer file, and writes the reason to a file in the same folder.
    fn set_aside(&self, name: &str, why: &str) -> Result<(), EvaluationError> {
        let to = |number: u32| name.replace(".answer.txt", &format!(".refused-{number}.txt"));
        let free = |name: &String| fs::symlink_metadata(self.path.join(name)).is_err();
        let to = (1..).map(to).find(free).expect("an unused number exists");
        let from = self.path.join(name);
        match fs::rename(&from, self.path.join(&to)) {
            Err(error) if is_absent(&error) => return Ok(()),
            renamed => renamed.map_err(EvaluationError::io("rename", &from))?,
        }
        let problem = format!("{name} cannot be used: {why}. It was renamed to {to}.");
        write(&self.path, PROBLEM_FILE, format!("{problem}\n").as_bytes())?;
        self.notice(&problem);
        Ok(())
    }

    fn notice(&self, text: &str) {
        (self.mailbox.notices)(&format!("{}: {text}", self.episode));
    }

    fn finish(&self, result: &EpisodeResult, text: &str) -> Result<(), EvaluationError> {
        self.create()?;
        self.clear(None)?;
        write(&self.path, FINISHED_TEXT, text.as_bytes())?;
        write_data(&self.path, FINISHED_FILE, result)
    }

    fn answer(&self, messages: &[ChatMessage]) -> Result<ChatReply, EvaluationError> {
        let mut open = self.open.lock().expect("no holder panics");
        self.create()?;
        self.clear(Some(open.address))?;
        self.show(&open, messages)?;
        let asked = Stopwatch::start();
        let text = self.wait(open.address)?;
        open.address.attempt += 1;
        let served_by = Some(self.mailbox.player.clone());
        let usage = Usage { output_tokens: stated_count(&text), ..Usage::default() };
        let latency_ms = asked.milliseconds();
        Ok(ChatReply { served_by, usage, latency_ms, ..ChatReply::new(text, Finish::Stop) })
    }
}

impl Model for EpisodeFolder {
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError> {
        self.answer(&request.messages).map_err(|error| unanswered(&error))
    }
}

fn unanswered(error: &EvaluationError) -> ChatError {
    ChatError { kind: ChatErrorKind::Infrastructure, message: told(error), failures: Vec::new() }
}

/// The state of an answer file.
enum Look {
    Absent,
    /// The file contains only white space.
    Empty,
    Wrong(String),
    Bytes(Vec<u8>),
}

fn look(path: &Path) -> Result<Look, EvaluationError> {
    let found = match fs::symlink_metadata(path) {
        Err(error) if is_absent(&error) => return Ok(Look::Absent),
        found => found.map_err(EvaluationError::io("read", path))?,
    };
    if !found.is_file() {
        return Ok(Look::Wrong("the file is not a regular file".to_owned()));
    }
    if found.len() > MAX_ANSWER as u64 {
        let (bytes, limit) = (found.len(), MAX_ANSWER / 1024);
        return Ok(Look::Wrong(format!(
            "the file has {bytes} bytes; the limit for an answer is {limit} KiB"
        )));
    }
    match disk::read_no_follow(path, MAX_ANSWER as u64) {
        Ok(None) => Ok(Look::Wrong("the file is still being written".to_owned())),
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => {
            Ok(Look::Wrong("the file is not a regular file".to_owned()))
        }
        Ok(Some(bytes)) if bytes.trim_ascii().is_empty() => Ok(Look::Empty),
        Ok(Some(bytes)) => Ok(Look::Bytes(bytes)),
        Err(error) if is_absent(&error) => Ok(Look::Absent),
        Err(error) => Err(EvaluationError::io("read", path)(error)),
    }
}

/// Splits a prompt file's name into its address and its kind, such as `prompt.txt` or `answer.txt`; `None` for any
/// other name.
fn split(name: &str) -> Option<(Address, &str)> {
    let (address, kind) = name.split_once('.')?;
    Some((address.parse().ok()?, kind))
}

/// Removes a file if it exists.
fn remove(path: &Path) -> Result<(), EvaluationError> {
    match fs::remove_file(path) {
        Err(error) if !is_absent(&error) => Err(EvaluationError::io("remove", path)(error)),
        _ => Ok(()),
    }
}

/// Returns a conversation as a single text. Roles are shown only if the conversation contains an answer.
fn conversation(messages: &[ChatMessage]) -> String {
    let has_answers = messages.iter().any(|message| message.role == Role::Assistant);
    let part = |message: &ChatMessage| match (has_answers, message.role) {
        (true, Role::Assistant) => format!("=== your answer ===\n\n{}", message.text),
        (true, _) => format!("=== message ===\n\n{}", message.text),
        (false, _) => message.text.clone(),
    };
    messages.iter().map(part).join("\n\n") + "\n"
}

/// Formats an error with its cause on one line.
fn told(error: &EvaluationError) -> String {
    match error {
        EvaluationError::Io { source, .. } => format!("{error}: {source}"),
        EvaluationError::Malformed(_) => error.to_string(),
    }
}
