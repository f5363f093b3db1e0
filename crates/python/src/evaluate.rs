//! Evaluated episodes. The suite plays them with its own prompts, answer parser and logs, but obtains the
//! model's answers from Python.
//!
//! A series of episodes runs on its own thread. The thread sends each request to Python over a channel, and
//! waits for the answer.

use crate::errors::{bad_log, failed, invalid};
use crate::game::{Game, outcome_name};
use base::Seed;
use engine::Outcome;
use evaluation::client::{
    ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Decoding, Finish, Model, Role, Usage,
};
use evaluation::log::{Event, read, without_times};
use evaluation::metrics::EpisodeMetrics;
use evaluation::player::ModelPlayer;
use evaluation::prompt::{PromptSettings, Prompter};
use evaluation::run::{Entrant, FORMAT, PlayResult, Settings, Task, play_together, tasks};
use evaluation::{
    Commitment, Contestant, Evaluation, EvaluationError, Halt, Journal, Subject, SubjectFacts, Track,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::json;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;

/// A level's number, its text, and the length of its shortest win in ticks, if proved optimal.
pub(crate) type LevelText = (usize, String, Option<usize>);

/// A message's role, its text, and optionally an image in PNG format.
type Message<'py> = (&'static str, String, Option<Bound<'py, PyBytes>>);

/// A series of episodes: a single level, or several of a game's levels in one conversation.
#[derive(Clone)]
struct Order {
    subject: Arc<Subject>,
    settings: Settings,
    prompts: PromptSettings,
    run: u64,
    /// The index of this series among those with the same game and run.
    first: usize,
    reasks: u32,
}

/// A message to Python from the thread that plays the episodes.
enum Report {
    Request(ChatRequest),
    Done(Result<Vec<Played>, String>),
}

/// An episode that has ended, and its log.
struct Played {
    level: usize,
    level_digest: String,
    result: Result<Outcome, String>,
    is_practice: bool,
    log: String,
}

/// A model whose answers are provided by Python.
struct Remote {
    requests: Mutex<Sender<Report>>,
    answers: Mutex<Receiver<Result<ChatReply, ChatError>>>,
}

impl Model for Remote {
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError> {
        let gone = || ChatError {
            kind: ChatErrorKind::Infrastructure,
            message: "the evaluation was stopped before the model answered".to_owned(),
            failures: Vec::new(),
        };
        let requests = self.requests.lock().map_err(|_| gone())?;
        requests.send(Report::Request(request.clone())).map_err(|_| gone())?;
        let answers = self.answers.lock().map_err(|_| gone())?;
        answers.recv().map_err(|_| gone())?
    }
}

/// The episodes of a series played by a model. A series is either a single level, or several levels that a
/// track plays in one conversation.
///
/// Python repeatedly takes the next request, obtains an answer, and returns it, until there are no further
/// requests.
#[pyclass(module = "infinite_arcade")]
pub(crate) struct Series {
    order: Order,
    folder: Option<PathBuf>,
    reports: Mutex<Receiver<Report>>,
    answers: Option<Sender<Result<ChatReply, ChatError>>>,
    results: Option<Result<Vec<Played>, String>>,
    is_waiting: bool,
}

impl Order {
    /// Returns the episodes in the series.
    fn tasks(&self) -> Vec<Task<'_>> {
        let all = tasks(&self.settings, std::slice::from_ref(&*self.subject));
        let own: Vec<Task<'_>> = all.into_iter().filter(|task| task.run == self.run).collect();
        let is_next = |_: &Task<'_>, next: &Task<'_>| next.series.is_some_and(|place| place.index > 0);
        own.chunk_by(is_next).nth(self.first).map(<[_]>::to_vec).unwrap_or_default()
    }

    /// Plays all episodes of the series.
    fn play(&self, model: &Arc<dyn Model>, folder: Option<&PathBuf>) -> Result<Vec<Played>, String> {
        let words = |error: EvaluationError| error.to_string();
        let tasks = self.tasks();
        let (limit, commit) = (self.settings.max_steps, self.settings.commit);
        let prompter = Prompter::within(&self.subject, self.prompts.clone(), limit, commit).map_err(words)?;
        let prompter = Arc::new(prompter);
        let contestant = |task: &Task<'_>| {
            let samples = task.chance().child("answers", 0);
            let (model, decoding) = (model.clone(), Decoding::default());
            let player = ModelPlayer::new(model, prompter.clone(), decoding, self.reasks, samples);
            Ok::<_, Halt>(Contestant::Agent(Box::new(player)))
        };
        let open = |task: &Task<'_>| match folder {
            Some(folder) => Journal::open(&folder.join(task.file_name())),
            None => Ok(Journal::in_memory()),
        };
        let played = Mutex::new(Vec::new());
        let note = |task: &Task<'_>, result: &PlayResult, journal: &Journal| {
            let result = match result {
                PlayResult::Ended(outcome) => Ok(*outcome),
                PlayResult::Halted(halt) => Err(halt.to_string()),
            };
            let lines = journal.events().iter().map(|event| serde_json::to_string(event).unwrap_or_default());
            let log = lines.map(|line| line + "\n").collect();
            let (level, is_practice) = (task.level.number, task.is_practice());
            let level_digest = task.level.level.digest().to_string();
            if let Ok(mut played) = played.lock() {
                played.push(Played { level, level_digest, result, is_practice, log });
            }
        };
        play_together(&tasks, &contestant, open, &note).map_err(words)?;
        played.into_inner().map_err(|error| error.to_string())
    }
}

/// Reads the subject of an evaluation.
pub(crate) fn subject(game: &Game, id: &str, levels: &[LevelText]) -> PyResult<Subject> {
    let facts =
        SubjectFacts { title: id.to_owned(), as_reference: game.0.as_reference, ..SubjectFacts::default() };
    Subject::read(id, &game.0.source, levels, facts).map_err(failed)
}

/// Returns the evaluation settings for one game.
fn settings_of(
    subject: &Subject,
    seed: &str,
    runs: u64,
    max_steps: u64,
    commit: &str,
    track: Option<Track>,
) -> PyResult<Settings> {
    let entrant = Entrant { name: "python".to_owned(), mode: None, aids: Vec::new(), details: json!({}) };
    let settings = Settings {
        format: FORMAT,
        semantics: engine::SEMANTICS,
        suite: env!("CARGO_PKG_VERSION").to_owned(),
        snapshot: None,
        entrant,
        seed: seed.to_owned(),
        runs,
        max_steps,
        commit: commit.parse().map_err(invalid)?,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(std::slice::from_ref(subject)),
    };
    let settings = match track {
        Some(track) => settings.on_track(track).map_err(invalid)?,
        None => settings,
    };
    settings.check().map_err(invalid)?;
    Ok(settings)
}

fn track_named(name: Option<&str>) -> PyResult<Option<Track>> {
    let named = |name: &str| {
        let found = Track::ALL.into_iter().find(|track| track.name() == name);
        found.ok_or_else(|| {
            let names = Track::ALL.map(|track| track.name()).join(", ");
            invalid(format_args!("there is no track `{name}`; the tracks are {names}"))
        })
    };
    name.map(named).transpose()
}

/// Returns the prompt settings from a track, or from a JSON object.
fn prompts_of(track: Option<Track>, prompts: Option<&str>) -> PyResult<PromptSettings> {
    match prompts {
        Some(prompts) => {
            let prompts = serde_json::from_str(prompts);
            prompts.map_err(|error| invalid(format_args!("invalid prompt settings: {error}")))
        }
        None => Ok(track.map_or_else(PromptSettings::default, Track::settings)),
    }
}

/// Returns the digest of a game's prompts. Results from different frameworks are comparable if their digests
/// are equal.
#[pyfunction]
#[pyo3(signature = (game, *, track = None, prompts = None, commit = "1"))]
pub(crate) fn prompt_digest(
    game: &Game,
    track: Option<&str>,
    prompts: Option<&str>,
    commit: &str,
) -> PyResult<String> {
    let prompts = prompts_of(track_named(track)?, prompts)?;
    let commit: Commitment = commit.parse().map_err(invalid)?;
    let prompter = Prompter::within(&subject(game, "game", &[])?, prompts, u64::MAX, commit);
    Ok(prompter.map_err(invalid)?.digest().to_string())
}

#[pymethods]
impl Series {
    #[new]
    #[pyo3(signature = (
        game, id, levels, *, group = 0, run = 0, seed, max_steps, commit = "1", track = None, prompts = None, reasks = 1,
        folder = None
    ))]
    #[allow(clippy::too_many_arguments, reason = "the arguments are the settings of an evaluation")]
    fn new(
        game: &Game,
        id: &str,
        levels: Vec<LevelText>,
        group: usize,
        run: u64,
        seed: &str,
        max_steps: u64,
        commit: &str,
        track: Option<&str>,
        prompts: Option<&str>,
        reasks: u32,
        folder: Option<PathBuf>,
    ) -> PyResult<Series> {
        let track = track_named(track)?;
        let subject = Arc::new(subject(game, id, &levels)?);
        let settings = settings_of(&subject, seed, run + 1, max_steps, commit, track)?;
        let prompts = prompts_of(track, prompts)?;
        let order = Order { subject, settings, prompts, run, first: group, reasks };
        if order.tasks().is_empty() {
            return Err(invalid(format_args!("the levels of {id} have no series {group}")));
        }
        let (sender, reports) = channel();
        let (answers, receiver) = channel();
        let model: Arc<dyn Model> =
            Arc::new(Remote { requests: Mutex::new(sender.clone()), answers: Mutex::new(receiver) });
        let (own, place) = (order.clone(), folder.clone());
        thread::Builder::new()
            .name("episode".to_owned())
            .spawn(move || {
                let played = own.play(&model, place.as_ref());
                // If the receiver is gone, the result is no longer needed.
                let _ = sender.send(Report::Done(played));
            })
            .map_err(failed)?;
        Ok(Series {
            order,
            folder,
            reports: Mutex::new(reports),
            answers: Some(answers),
            results: None,
            is_waiting: false,
        })
    }

    /// Returns the level numbers of each of a game's series, in playing order.
    #[staticmethod]
    #[pyo3(signature = (game, id, levels, *, track = None))]
    fn plan(game: &Game, id: &str, levels: Vec<LevelText>, track: Option<&str>) -> PyResult<Vec<Vec<usize>>> {
        let subject = subject(game, id, &levels)?;
        let settings = settings_of(&subject, "plan", 1, 1, "1", track_named(track)?)?;
        let all = tasks(&settings, std::slice::from_ref(&subject));
        let is_next = |_: &Task<'_>, next: &Task<'_>| next.series.is_some_and(|place| place.index > 0);
        let numbers = |series: &[Task<'_>]| series.iter().map(|task| task.level.number).collect();
        Ok(all.chunk_by(is_next).map(numbers).collect())
    }

    /// The seeds for the games' randomness, one per episode in the series.
    #[getter]
    fn seeds(&self) -> Vec<String> {
        self.order.tasks().iter().map(|task| task.chance().to_string()).collect()
    }

    /// The folder that contains the logs.
    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    /// Returns the next request, or `None` once all episodes have ended. A request is a list of messages,
    /// each consisting of role, text and image.
    fn next_request<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Vec<Message<'py>>>> {
        if self.results.is_some() {
            return Ok(None);
        }
        if self.is_waiting {
            return Err(invalid("the last request has not been answered"));
        }
        let reports = &self.reports;
        let report = py.detach(|| reports.lock().ok().and_then(|reports| reports.recv().ok()));
        match report {
            Some(Report::Request(request)) => {
                self.is_waiting = true;
                let message = |ChatMessage { role, text, image }: ChatMessage| {
                    let role = match role {
                        Role::System => "system",
                        Role::User => "user",
                        Role::Assistant => "assistant",
                    };
                    (role, text, image.map(|image| PyBytes::new(py, &image)))
                };
                Ok(Some(request.messages.into_iter().map(message).collect()))
            }
            Some(Report::Done(results)) => {
                self.results = Some(results);
                Ok(None)
            }
            None => Err(failed("the thread that plays the episode has ended unexpectedly")),
        }
    }

    /// Provides the answer to the last request. `finish` is `stop`, `length`, `refusal` or `other`.
    #[pyo3(signature = (text, *, finish = "stop", reasoning = None, input_tokens = None, output_tokens = None, served_by = None, latency_ms = 0.0))]
    #[allow(clippy::too_many_arguments, reason = "the arguments are the parts of an answer")]
    fn answer(
        &mut self,
        text: String,
        finish: &str,
        reasoning: Option<String>,
        input_tokens: Option<u64>,
        output_tokens: Option<u64>,
        served_by: Option<String>,
        latency_ms: f64,
    ) -> PyResult<()> {
        let finish = match finish {
            "stop" => Finish::Stop,
            "length" => Finish::Length,
            "refusal" => Finish::Refusal,
            _ => Finish::Other,
        };
        let usage = Usage { input_tokens, output_tokens, ..Usage::default() };
        self.reply(Ok(ChatReply {
            text,
            reasoning,
            finish,
            usage,
            served_by,
            latency_ms,
            ..ChatReply::default()
        }))
    }

    /// Reports that no answer could be obtained. The episode is aborted, but can be resumed later. `kind` is
    /// `infrastructure`, `budget` or `rejected`.
    #[pyo3(signature = (message, *, kind = "infrastructure"))]
    fn fail(&mut self, message: String, kind: &str) -> PyResult<()> {
        let kind = match kind {
            "budget" => ChatErrorKind::Budget,
            "rejected" => ChatErrorKind::Rejected,
            _ => ChatErrorKind::Infrastructure,
        };
        self.reply(Err(ChatError { kind, message, failures: Vec::new() }))
    }

    /// Returns the started episodes, each as a dictionary that includes the log. May be called once there are
    /// no further requests.
    fn results<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let Some(results) = &self.results else { return Err(invalid("the episodes are not over yet")) };
        let entry = |played: &Played| {
            let entry = PyDict::new(py);
            entry.set_item("level", played.level)?;
            entry.set_item("level_digest", &played.level_digest)?;
            entry.set_item("outcome", played.result.as_ref().ok().map(|outcome| outcome_name(*outcome)))?;
            let stopped = match played.result {
                Ok(Outcome::Stopped(limit)) => Some(limit.to_string()),
                _ => None,
            };
            entry.set_item("stopped_by", stopped)?;
            entry.set_item("halted", played.result.as_ref().err())?;
            entry.set_item("practice", played.is_practice)?;
            entry.set_item("log", &played.log)?;
            Ok(entry)
        };
        results.as_ref().map_err(bad_log)?.iter().map(entry).collect()
    }
}

impl Series {
    fn reply(&mut self, answer: Result<ChatReply, ChatError>) -> PyResult<()> {
        if !self.is_waiting {
            return Err(invalid("there is no request to answer"));
        }
        self.is_waiting = false;
        let sent = self.answers.as_ref().is_some_and(|answers| answers.send(answer).is_ok());
        if sent { Ok(()) } else { Err(failed("the thread that plays the episode has ended unexpectedly")) }
    }
}

/// Parses a log's events from JSON lines.
fn events(log: &str) -> PyResult<Vec<Event>> {
    let event = |(number, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|error| {
            bad_log(format_args!("line {} is not a valid event of an episode: {error}", number + 1))
        })
    };
    log.lines().enumerate().map(event).collect()
}

/// Replays a log on its game, and compares every state hash, score and outcome. If `seed` and `max_steps` are
/// given, the log must also belong to the specified episode: the level, the run, the seed for the game's
/// randomness, the step limit, the commitment and the track are checked.
///
/// Returns JSON with the actions, the outcome, the score, the number of steps and the last state hash. A flag
/// states whether the log is complete.
#[pyfunction]
#[pyo3(signature = (game, id, levels, log, *, level = None, run = 0, seed = None, max_steps = None, commit = "1", track = None))]
#[allow(clippy::too_many_arguments, reason = "the arguments are the settings of an evaluation")]
pub(crate) fn replay_log(
    py: Python<'_>,
    game: &Game,
    id: &str,
    levels: Vec<LevelText>,
    log: &str,
    level: Option<usize>,
    run: u64,
    seed: Option<&str>,
    max_steps: Option<u64>,
    commit: &str,
    track: Option<&str>,
) -> PyResult<String> {
    let (subject, log) = (subject(game, id, &levels)?, events(log)?);
    if let (Some(seed), Some(max_steps)) = (seed, max_steps) {
        let settings = settings_of(&subject, seed, run + 1, max_steps, commit, track_named(track)?)?;
        let all = tasks(&settings, std::slice::from_ref(&subject));
        let is_meant =
            |task: &&Task<'_>| task.run == run && level.is_none_or(|level| task.level.number == level);
        let task = all.iter().find(is_meant).ok_or_else(|| bad_log("there is no such episode"))?;
        let start = log.first().ok_or_else(|| bad_log("the log is empty"))?;
        task.compare_start(start).map_err(bad_log)?;
        let expected: Seed = task.chance();
        if !matches!(start, Event::Start { seed, .. } if *seed == expected) {
            return Err(bad_log("the log does not begin with the start of this episode"));
        }
    }
    let document = py.detach(|| {
        let replayed = evaluation::metrics::replay(&subject, &log).map_err(bad_log)?;
        let hash = log.iter().rev().find_map(|event| match event {
            Event::Step { hash, .. } | Event::Start { hash, .. } => Some(hash.to_string()),
            _ => None,
        });
        let is_ended = matches!(log.last(), Some(Event::End { .. }));
        Ok::<_, PyErr>(json!({
            "actions": replayed.actions,
            "outcome": outcome_name(replayed.outcome),
            "stopped_by": match replayed.outcome {
                Outcome::Stopped(limit) => Some(limit.to_string()),
                _ => None,
            },
            "score": replayed.score,
            "steps": replayed.actions.len(),
            "hash": hash,
            "ended": is_ended,
            "course": replayed.course,
        }))
    })?;
    serde_json::to_string(&document).map_err(failed)
}

/// Replays an episode's log, and returns the episode's metrics as JSON in the format of `arcade report
/// --json`.
#[pyfunction]
pub(crate) fn metrics_of_log(
    py: Python<'_>,
    game: &Game,
    id: &str,
    levels: Vec<LevelText>,
    log: &str,
) -> PyResult<String> {
    let (subject, log) = (subject(game, id, &levels)?, events(log)?);
    let metrics = py.detach(|| EpisodeMetrics::of(&subject, &log)).map_err(bad_log)?;
    serde_json::to_string(&metrics).map_err(failed)
}

/// Returns the lines of the log at the given path. If `timeless` is `true`, all times are set to 0, so that
/// runs can be compared.
#[pyfunction]
pub(crate) fn read_log(path: PathBuf, timeless: bool) -> PyResult<String> {
    let events = read(&path).map_err(bad_log)?;
    let line = |event: &Event| {
        let event = if timeless { without_times(event) } else { event.clone() };
        serde_json::to_string(&event).map(|line| line + "\n").map_err(failed)
    };
    events.iter().map(line).collect()
}
