//! Plays an evaluation's episodes in parallel, each with its own log.

use crate::error::EvaluationError;
use crate::log::{Event, Journal, NEXT_STEP, decisions};
use crate::metrics::replay_course;
use crate::player::{Contestant, Halt};
use crate::run::episode::{PlayResult, Task};
use crate::run::series::{Series, play_series, series_of};
use crate::run::settings::{FORMAT, MAX_SETTINGS, SETTINGS_FILE, Settings, SubjectEntry};
use crate::run::text::{RESTORE, is_there, read_text};
use crate::run::unusable::{Answers, Watch};
use crate::subject::Subject;
use crate::track::SeriesPlace;
use base::Seed;
use disk::{Access, Lock};
use engine::Outcome;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The name of the lock file in a results folder. The program that writes to the folder holds the lock.
const LOCK_FILE: &str = ".lock";

/// The number of consecutive episodes aborted by environment failures after which an evaluation stops,
/// leaving the remaining episodes open.
const FAILURES_IN_A_ROW: u64 = 8;

/// A results folder. It contains everything needed to compute all metrics and to replay every episode:
/// `evaluation.json`, the games' texts in `games/`, and one log per episode in `episodes/`.
#[derive(Debug)]
pub struct Evaluation {
    folder: PathBuf,
    /// The evaluation's settings.
    pub settings: Settings,
    /// The evaluation's games, in the order of the settings.
    pub subjects: Vec<Subject>,
    _lock: Option<Lock>,
}

/// A display of an evaluation's progress.
pub trait Progress: Sync {
    /// Called when an episode ends or is aborted.
    fn episode(&self, task: &Task<'_>, result: &PlayResult);

    /// Called once, as soon as at least 20 decisions have been made and more than a fifth of them lack a
    /// usable answer. `is_all` is `true` if all of the first 20 decisions lack a usable answer. Returns
    /// `false` to stop the evaluation.
    fn unusable(&self, _answers: &Answers, _is_all: bool) -> bool {
        true
    }

    /// Called when the evaluation stops and leaves the running episodes open, so that players can stop
    /// waiting for answers. May be called more than once.
    fn stopped(&self, _halt: &Halt) {}
}

/// The numbers of an evaluation's episodes, by final status.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// The total number of episodes.
    pub episodes: u64,
    /// The number of episodes that ended.
    pub ended: u64,
    /// The number of episodes won, excluding practice episodes.
    pub won: u64,
    /// The episodes stopped by the engine, grouped by game and reason.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stopped: Vec<StoppedEpisodes>,
    /// The games that could not be played because the server rejected their prompts.
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    pub unfit: BTreeSet<String>,
    /// The total number of practice episodes, excluded from all results.
    #[serde(skip_serializing_if = "is_zero")]
    pub practice: u64,
    /// The number of decisions over all episodes, in total and without a usable answer.
    #[serde(flatten)]
    pub answers: Answers,
    /// The number of aborted episodes, plus the episodes not started because others were aborted.
    pub open: u64,
    /// The reason for the first aborted episode, if any.
    pub halted: Option<String>,
    /// `true` if the abort was caused by the network, the server, the disk or a player's process, rather than
    /// by a cap or the user.
    pub infrastructure: bool,
}

/// The episodes of one game that the engine stopped for the same reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StoppedEpisodes {
    /// The game's ID.
    pub game: String,
    /// The reason why the engine stopped the episodes.
    pub reason: String,
    /// The number of episodes.
    pub episodes: u64,
}

fn is_zero(number: &u64) -> bool {
    *number == 0
}

impl Evaluation {
    /// Returns `true` if the folder can be resumed: it contains an evaluation, or one whose creation was
    /// interrupted.
    pub fn is_begun(folder: &Path) -> bool {
        [SETTINGS_FILE, LOCK_FILE].iter().any(|name| folder.join(name).exists())
    }

    /// Creates a results folder. The folder must be absent or empty, except for files from an interrupted
    /// creation.
    ///
    /// # Errors
    /// Returns an error if the folder is neither absent nor empty, if it cannot be written, or if the
    /// settings exceed the limits of an evaluation.
    pub fn create(
        folder: &Path,
        settings: Settings,
        subjects: Vec<Subject>,
    ) -> Result<Evaluation, EvaluationError> {
        settings.check().map_err(EvaluationError::Malformed)?;
        fs::create_dir_all(folder).map_err(EvaluationError::io("create", folder))?;
        if !is_free(folder)? {
            let next = match folder.join(SETTINGS_FILE).exists() {
                true => "pass --resume to continue the evaluation in it, or choose another folder",
                false => "this folder contains no evaluation to resume; choose another folder",
            };
            return Err(EvaluationError::malformed(folder, format!("the folder is not empty; {next}")));
        }
        let lock = lock(folder)?;
        for subject in &subjects {
            let games = folder.join("games").join(&subject.id);
            disk::create_folder_no_follow(&games).map_err(EvaluationError::io("create", &games))?;
            let write = |name: &str, text: &str| {
                let path = games.join(name);
                disk::write(&path, text.as_bytes(), Access::Shared)
                    .map_err(EvaluationError::io("write", &path))
            };
            write("game.vgdl", &subject.source)?;
            for level in &subject.levels {
                write(&format!("lvl{}.txt", level.number), &level.text)?;
            }
        }
        let episodes = folder.join("episodes");
        disk::create_folder_no_follow(&episodes).map_err(EvaluationError::io("create", &episodes))?;
        let text = serde_json::to_string_pretty(&settings).expect("settings are plain data");
        let path = folder.join(SETTINGS_FILE);
        let written = disk::write(&path, (text + "\n").as_bytes(), Access::Shared);
        written.map_err(EvaluationError::io("write", &path))?;
        Ok(Evaluation { folder: folder.to_owned(), settings, subjects, _lock: Some(lock) })
    }

    /// Opens the evaluation in a results folder in order to resume it.
    ///
    /// # Errors
    /// Returns an error if a different program is writing to the folder, if the recorded settings differ from
    /// `settings`, or if the evaluation is damaged.
    pub fn resume(folder: &Path, settings: &Settings) -> Result<Evaluation, EvaluationError> {
        let lock = lock(folder)?;
        let mut evaluation = Evaluation::open(folder)?;
        if let Some(difference) = difference(&evaluation.settings, settings) {
            let what = format!(
                "the evaluation in this folder was started with a different {difference}; use the same {difference}, or another folder"
            );
            return Err(EvaluationError::malformed(folder, what));
        }
        evaluation._lock = Some(lock);
        Ok(evaluation)
    }

    /// Opens the evaluation in a results folder for reading.
    ///
    /// # Errors
    /// Returns an error if the folder contains no evaluation, or if the evaluation has a newer format or is
    /// damaged.
    pub fn open(folder: &Path) -> Result<Evaluation, EvaluationError> {
        let path = folder.join(SETTINGS_FILE);
        let text = read_text(&path, MAX_SETTINGS, RESTORE).map_err(|error| match error {
            EvaluationError::Io { source, .. } if is_absent(&source) => {
                let what = format!(
                    "this folder contains no evaluation results (there is no {SETTINGS_FILE}); `arcade \
                     evaluate --out DIR` writes a results folder"
                );
                EvaluationError::malformed(folder, what)
            }
            other => other,
        })?;
        let wrong = |what: String| EvaluationError::malformed(&path, what);
        let unreadable =
            |error: serde_json::Error| wrong(format!("not valid evaluation settings: {error}; {RESTORE}"));
        let value: serde_json::Value = serde_json::from_str(&text).map_err(unreadable)?;
        let format = value.get("format").and_then(serde_json::Value::as_u64);
        if let Some(format) = format.filter(|&format| format > u64::from(FORMAT)) {
            return Err(wrong(format!(
                "the results have format {format}, but this version of arcade reads formats up to \
                 {FORMAT}: update arcade"
            )));
        }
        let settings: Settings = serde_json::from_value(value).map_err(unreadable)?;
        if let Some(entry) = settings.games.iter().find(|entry| !is_file_name(&entry.id)) {
            return Err(wrong(format!("{:?} is not the name of a game; {RESTORE}", entry.id)));
        }
        settings.check().map_err(|problem| {
            wrong(format!("{problem}; the file is damaged: restore the results folder"))
        })?;
        let subjects = settings.games.iter().map(|entry| entry.read(folder)).collect::<Result<_, _>>()?;
        Ok(Evaluation { folder: folder.to_owned(), settings, subjects, _lock: None })
    }

    /// Deletes the results folder if it contains neither decisions nor answers, so that a different player
    /// can use it. Returns `true` if the folder was deleted.
    ///
    /// # Errors
    /// Returns an error if a log cannot be read, or if the folder cannot be deleted.
    pub fn delete_if_unplayed(self) -> Result<bool, EvaluationError> {
        for task in self.tasks() {
            let is_of_play = |event: &Event| {
                !matches!(
                    event,
                    Event::Start { .. } | Event::Message { .. } | Event::Request { .. } | Event::Halt { .. }
                )
            };
            if self.events(&task)?.iter().any(is_of_play) {
                return Ok(false);
            }
        }
        drop(self._lock);
        fs::remove_dir_all(&self.folder).map_err(EvaluationError::io("delete", &self.folder))?;
        Ok(true)
    }

    /// Returns the games' entries in the settings.
    pub fn entries(subjects: &[Subject]) -> Vec<SubjectEntry> {
        subjects.iter().map(SubjectEntry::of).collect()
    }

    /// Returns all of the evaluation's episodes, in the order of [`tasks`].
    pub fn tasks(&self) -> Vec<Task<'_>> {
        tasks(&self.settings, &self.subjects)
    }

    /// Returns an episode's events so far, or an empty list if the episode was not started.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or is not a log.
    pub fn events(&self, task: &Task<'_>) -> Result<Vec<Event>, EvaluationError> {
        let path = self.log_path(task);
        if is_there(&path)? { crate::log::read(&path) } else { Ok(Vec::new()) }
    }

    /// Checks that the folder contains no logs from other episodes. Otherwise, settings that list fewer runs
    /// or games than were played would hide results.
    ///
    /// # Errors
    /// Returns an error if there is a log from a different episode, or if the folder cannot be listed.
    pub(crate) fn check_logs(&self, tasks: &[Task<'_>]) -> Result<(), EvaluationError> {
        let folder = self.folder.join("episodes");
        let names: BTreeSet<String> = tasks.iter().map(Task::file_name).collect();
        if !is_there(&folder)? {
            return Ok(());
        }
        let found = names_in(&folder)?;
        let others = found.iter().map(|name| name.to_string_lossy().into_owned());
        let other = others.filter(|name| name.ends_with(".jsonl") && !names.contains(name)).min();
        other.map_or(Ok(()), |name| {
            let what = format!(
                "{SETTINGS_FILE} does not list this episode, so the file is damaged or was changed: restore the results folder"
            );
            Err(EvaluationError::malformed(&folder.join(name), what))
        })
    }

    /// Checks that a log belongs to the given episode, and then calls `read`.
    ///
    /// # Errors
    /// Returns an error if the log belongs to a different episode, or if `read` fails. The message contains
    /// the file, the line and the next step.
    pub(crate) fn checked<T>(
        &self,
        task: &Task<'_>,
        log: &[Event],
        read: impl FnOnce() -> Result<T, EvaluationError>,
    ) -> Result<T, EvaluationError> {
        let place = self.log_path(task);
        let wrong = |what: String| EvaluationError::malformed(&place, what);
        let found = read().map_err(|error| wrong(error.to_string()))?;
        let start = log.first().map_or(Ok(()), |start| task.compare_start(start));
        start.map_err(|what| wrong(format!("line 1: {what}; {NEXT_STEP}")))?;
        Ok(found)
    }

    /// Replays the ended episodes from their logs, because an episode that a report would reject must not
    /// count as played.
    fn check_ended(&self, tasks: &[Task<'_>]) -> Result<(), EvaluationError> {
        self.check_logs(tasks)?;
        tasks.par_iter().try_for_each(|task| {
            let log = self.events(task)?;
            if !matches!(log.last(), Some(Event::End { .. })) {
                return Ok(());
            }
            self.checked(task, &log, || replay_course(task.subject, &log)).map(drop)
        })
    }

    pub(crate) fn log_path(&self, task: &Task<'_>) -> PathBuf {
        self.folder.join("episodes").join(task.file_name())
    }

    /// Plays the open episodes on the threads of the current rayon pool. `contestant` creates an episode's
    /// player.
    ///
    /// # Errors
    /// Returns an error in the same cases as [`Evaluation::run_chosen`].
    pub fn run(
        &self,
        contestant: impl Fn(&Task<'_>) -> Result<Contestant, Halt> + Sync,
        progress: &impl Progress,
    ) -> Result<Tally, EvaluationError> {
        let mut all = Some((0..self.tasks().len()).collect());
        self.run_chosen(contestant, progress, |_| all.take().unwrap_or_default())
    }

    /// Plays episodes like [`Evaluation::run`], but in batches.
    ///
    /// `choose` receives the episodes that have ended since its last call, each with `true` if it was won. It
    /// returns the next episodes' indices in [`Evaluation::tasks`], or an empty list to finish. Episodes that
    /// ended in an earlier run keep their results.
    ///
    /// The remaining episodes are left open if a cap is reached, if the server rejects a request, if no server accepts
    /// the first connection, or if environment failures abort `FAILURES_IN_A_ROW` consecutive episodes.
    ///
    /// # Errors
    /// Returns an error if a log cannot be read or written, or if the log of an ended episode contradicts the
    /// game.
    pub fn run_chosen(
        &self,
        contestant: impl Fn(&Task<'_>) -> Result<Contestant, Halt> + Sync,
        progress: &impl Progress,
        mut choose: impl FnMut(&[(usize, bool)]) -> Vec<usize>,
    ) -> Result<Tally, EvaluationError> {
        let (stopped, failures) = (AtomicBool::new(false), AtomicU64::new(0));
        let (watch, answers) = (Watch::default(), Mutex::new(Answers::default()));
        let first = Mutex::new(None);
        let unfit = Mutex::new(BTreeSet::new());
        let is_unfit = |task: &Task<'_>| unfit.lock().expect("no holder panics").contains(&task.subject.id);
        let tasks = self.tasks();
        self.check_ended(&tasks)?;
        // Threads take the next episode from a common list, rather than each taking a part of the list. Therefore,
        // every level has been played about equally often if the run is aborted.
        let is_stopped = || stopped.load(Ordering::Relaxed) || watch.halt().is_some();
        let watched = |validity| {
            let halt = watch.decided(validity, |answers, is_all| progress.unusable(answers, is_all));
            halt.iter().for_each(|halt| progress.stopped(halt));
            halt
        };
        let played = |task: &Task<'_>, result: &PlayResult, journal: &Journal| {
            match result {
                PlayResult::Ended(_) => failures.store(0, Ordering::Relaxed),
                PlayResult::Halted(halt) => {
                    let many = failures.fetch_add(1, Ordering::Relaxed) + 1 >= FAILURES_IN_A_ROW;
                    if let Halt::Unfit(_) = halt {
                        unfit.lock().expect("no holder panics").insert(task.subject.id.clone());
                    }
                    if many || !matches!(halt, Halt::Infrastructure(_) | Halt::Unfit(_)) {
                        stopped.store(true, Ordering::Relaxed);
                        progress.stopped(halt);
                    }
                    first.lock().expect("no holder panics").get_or_insert_with(|| halt.clone());
                }
            }
            for validity in decisions(journal.events()) {
                answers.lock().expect("no holder panics").add(validity);
            }
            progress.episode(task, result);
        };
        let (mut tally, mut stops) = (Tally::default(), BTreeMap::<_, u64>::new());
        let mut ended: Vec<(usize, bool)> = Vec::new();
        while !is_stopped() {
            let chosen = choose(&ended);
            if chosen.is_empty() {
                break;
            }
            let due: Vec<Task<'_>> = chosen.iter().map(|&at| tasks[at]).collect();
            tally.episodes += due.len() as u64;
            tally.practice += due.iter().filter(|task| task.is_practice()).count() as u64;
            let mut started = 0;
            let series = series_of(&due).into_iter().map(|tasks| {
                started += tasks.len();
                (started - tasks.len(), tasks)
            });
            let series: Vec<(usize, &[Task<'_>])> = series.collect();
            let results = series.into_iter().par_bridge().map(|(first, tasks)| {
                if is_stopped() || is_unfit(&tasks[0]) {
                    return Ok((first, Vec::new()));
                }
                let open = |task: &Task<'_>| Journal::open(&self.log_path(task));
                let series = Series { tasks, watch: &watched, is_stopped: &is_stopped };
                Ok((first, play_series(&series, &contestant, open, &played)?))
            });
            let results: Vec<(usize, Vec<(bool, PlayResult)>)> =
                results.collect::<Result<_, EvaluationError>>()?;
            ended.clear();
            for (first, results) in results {
                for (&at, (is_practice, result)) in chosen[first..].iter().zip(results) {
                    if let PlayResult::Ended(outcome) = result {
                        let won = outcome == Outcome::Won;
                        ended.push((at, won));
                        tally.ended += 1;
                        tally.won += u64::from(won && !is_practice);
                        if let Outcome::Stopped(limit) = outcome {
                            *stops.entry((tasks[at].subject.id.clone(), limit.to_string())).or_default() += 1;
                        }
                    }
                }
            }
            ended.sort_unstable();
            if ended.len() < chosen.len() {
                break;
            }
        }
        let halted: Option<Halt> = first.into_inner().expect("no holder panics").or_else(|| watch.halt());
        Ok(Tally {
            answers: answers.into_inner().expect("no holder panics"),
            open: tally.episodes - tally.ended,
            infrastructure: matches!(
                halted,
                Some(
                    Halt::Infrastructure(_)
                        | Halt::Unreachable(_)
                        | Halt::Rejected(_)
                        | Halt::Unfit(_)
                        | Halt::Log(_)
                )
            ),
            stopped: stops
                .into_iter()
                .map(|((game, reason), episodes)| StoppedEpisodes { game, reason, episodes })
                .collect(),
            unfit: unfit.into_inner().expect("no holder panics"),
            halted: halted.map(|halt| halt.to_string()),
            ..tally
        })
    }
}

/// Returns all of an evaluation's episodes, sorted by run, so that all levels have been played about equally
/// often if the evaluation is aborted.
pub fn tasks<'a>(settings: &'a Settings, subjects: &'a [Subject]) -> Vec<Task<'a>> {
    let (seed, max_steps) = (Seed::from_text(&settings.seed), settings.max_steps);
    let on = |run: u64| {
        let levels = |subject: &'a Subject| {
            let places = SeriesPlace::all(subject.levels.len(), settings.series);
            subject.levels.iter().zip(places).map(move |(level, place)| (subject, level, place))
        };
        subjects.iter().flat_map(levels).map(move |(subject, level, place)| Task {
            subject,
            level,
            run,
            seed,
            max_steps,
            commit: settings.commit,
            max_output_tokens: settings.max_output_tokens,
            track: settings.track.as_deref(),
            series: place,
        })
    };
    (0..settings.runs).flat_map(on).collect()
}

/// Locks the folder against other writers. The operating system releases the lock when the program exits for
/// any reason.
fn lock(folder: &Path) -> Result<Lock, EvaluationError> {
    let path = folder.join(LOCK_FILE);
    Lock::take(&path).map_err(EvaluationError::io("lock", &path))?.ok_or_else(|| {
        EvaluationError::malformed(
            folder,
            "another `arcade evaluate` is writing to this folder; wait until it ends, or choose another folder",
        )
    })
}

fn names_in(folder: &Path) -> Result<Vec<OsString>, EvaluationError> {
    let entries =
        fs::read_dir(folder).and_then(|entries| entries.map(|entry| Ok(entry?.file_name())).collect());
    entries.map_err(EvaluationError::io("list", folder))
}

/// Returns `true` if a folder is empty, or if its creation was interrupted before the settings were written.
fn is_free(folder: &Path) -> Result<bool, EvaluationError> {
    let begun = [LOCK_FILE, "games", "episodes"];
    let episodes = folder.join("episodes");
    let is_ours = names_in(folder)?
        .iter()
        .all(|name| begun.iter().any(|ours| name == ours) || disk::is_unfinished(name));
    Ok(is_ours && (!is_there(&episodes)? || names_in(&episodes)?.is_empty()))
}

/// Returns the name of the first field that differs between two evaluations; `None` if no field differs. The model's
/// server is ignored, because it does not affect the model's answers.
fn difference(recorded: &Settings, requested: &Settings) -> Option<String> {
    let fields = |settings: &Settings| {
        let mut fields = serde_json::to_value(settings).expect("settings are plain data");
        if let Some(server) = fields.pointer_mut("/entrant/details/model/server") {
            server.take();
        }
        fields
    };
    let (recorded, requested) = (fields(recorded), fields(requested));
    let (recorded, requested) = (recorded.as_object()?, requested.as_object()?);
    let differs = |name: &&String| recorded.get(*name) != requested.get(*name);
    recorded.keys().chain(requested.keys()).find(differs).map(|name| match name.as_str() {
        "entrant" => "player, model, prompt or decoding".to_owned(),
        "games" => "choice of games or levels".to_owned(),
        "max_steps" => "--max-steps".to_owned(),
        "max_output_tokens" => "--max-output-tokens".to_owned(),
        "runs" | "seed" | "commit" | "track" => format!("--{name}"),
        "adaptive" => "scale, --target-error, --episodes or --batch".to_owned(),
        "suite" | "semantics" => "version of arcade".to_owned(),
        other => other.to_owned(),
    })
}

/// Returns `true` if the error means that the file does not exist.
fn is_absent(error: &std::io::Error) -> bool {
    matches!(error.kind(), std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory)
}

/// Returns `true` if an ID from a results folder is safe to use as a file name and cannot lead outside the
/// folder.
fn is_file_name(id: &str) -> bool {
    !id.is_empty()
        && !id.starts_with('.')
        && id.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' '))
}
