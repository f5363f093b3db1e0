//! External agents: processes that communicate through lines of JSON (`docs/how-to/agents.md`).
//!
//! An agent's process receives only facts that a player may know. It does not receive the level source, the forward
//! model, the seed, or the path to a witness (a recorded winning episode). The process runs in its own empty folder,
//! with a reduced environment.

mod answer;
mod child;
#[cfg(unix)]
mod guard;
mod message;
#[cfg(unix)]
mod program;
#[cfg(unix)]
mod running;

#[cfg(unix)]
pub use guard::guard;
pub use message::PROTOCOL;
#[cfg(unix)]
pub use running::end_all;

use crate::client::{ChatReply, Finish, Usage};
use crate::encoding;
use crate::legend::{Legend, LegendOptions};
use crate::log::{Event, Journal, Reply, ReplyClass};
use crate::mask::Mask;
use crate::player::{Agent, Choice, Halt, Said, Validity};
use crate::prompt::limited;
use crate::run::Task;
use crate::run::clock::Stopwatch;
use crate::thought::AnswerLimit;
use crate::track::Track;
use crate::turn::{Turn, is_of_use};
use answer::{Addressed, Thought, read, read_predictions};
use child::{LineProcess, NoLine};
use engine::describe::Guide;
use engine::{Action, Analysis, Observation};
use message::{Message, Past, Seen, Tick};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::sync::Arc;
use std::time::Duration;

/// The maximum number of characters recorded from an invalid answer.
const MAX_RECORDED: usize = 500;

/// The maximum number of times that a question is repeated after an invalid answer.
const MAX_REASKS: u32 = 1;

/// The time to wait for an answer to an `invalid` message before a notice is shown.
const NOTICE_AFTER: Duration = Duration::from_secs(10);

/// The maximum total size, in bytes, of stale answers (answers to earlier turns) skipped while waiting for an
/// answer (1 MiB).
const MAX_STALE: usize = 1 << 20;

/// The configuration of an external process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProcessConfig {
    /// The time limit for an answer. For the first answer, the limit includes the time to start the process.
    pub timeout: Duration,
    /// The names of environment variables that the process inherits in addition to the default variables.
    pub inherited: Vec<String>,
    /// The command for a guard, which supervises the player: a program that calls [`guard`](guard()) with its remaining
    /// arguments. The arguments are the folder, `--`, and the words of the player's command. If the guard command is
    /// empty, the player's process is started directly, and survives if the calling program is killed.
    pub guard: Vec<OsString>,
}

impl Default for ProcessConfig {
    fn default() -> ProcessConfig {
        ProcessConfig { timeout: Duration::from_secs(300), inherited: Vec::new(), guard: Vec::new() }
    }
}

/// A player implemented as an external program. The program is started at the first turn of an episode, and
/// killed at the end of the episode.
#[derive(Debug)]
pub struct Process {
    command: String,
    words: Vec<String>,
    config: ProcessConfig,
    running: Option<Running>,
    notices: Notices,
    /// The track (bundle of prompt settings), which determines the information sent to the process.
    track: Track,
    /// The maximum number of output tokens per answer, including reasoning, if there is a limit.
    max_output_tokens: Option<u32>,
    /// `true` if the process has received the `hello` message for this level.
    is_greeted: bool,
}

/// A function that shows notices to the user.
struct Notices(Arc<dyn Fn(&str) + Send + Sync>);

impl std::fmt::Debug for Notices {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Notices")
    }
}

#[derive(Debug)]
struct Running {
    process: LineProcess,
    shown: Shown,
}

impl Process {
    /// Creates a player from a command line. The command line is split into words as in a shell, but no shell
    /// is run.
    ///
    /// # Errors
    /// Returns an error if the command line is empty, or if its quotes do not match.
    pub fn new(command: &str, config: ProcessConfig) -> Result<Process, String> {
        let words = shlex::split(command).filter(|words| words.first().is_some_and(|word| !word.is_empty()));
        let words = words.ok_or_else(|| {
            format!("`cmd:{command}` is not a command line; write the program and its arguments, quoted as in a shell")
        })?;
        let notices = Notices(Arc::new(|_| ()));
        let (track, is_greeted) = (Track::Told, false);
        Ok(Process {
            command: command.to_owned(),
            words,
            config,
            running: None,
            notices,
            track,
            max_output_tokens: None,
            is_greeted,
        })
    }

    /// Sets the function that shows notices to the user. For example, a notice reports that the process has
    /// been silent since its answer was rejected.
    #[must_use]
    pub fn with_notices(mut self, notices: Arc<dyn Fn(&str) + Send + Sync>) -> Process {
        self.notices = Notices(notices);
        self
    }

    /// Sets the track (bundle of prompt settings). On [`Track::Discover`], the process plays all levels in a series,
    /// and must make predictions at the end.
    #[must_use]
    pub fn on_track(mut self, track: Track) -> Process {
        self.track = track;
        self
    }

    /// Sets the maximum number of output tokens per answer. Answers that report more count as no answer.
    #[must_use]
    pub fn with_max_output_tokens(mut self, most: Option<u32>) -> Process {
        self.max_output_tokens = most;
        self
    }

    /// Checks that the command line's program exists. If the second word looks like a script, checks that the
    /// script exists too. Call this before any other work depends on the program.
    ///
    /// # Errors
    /// Returns an error if the check shows that the program cannot be started. The message suggests a similar
    /// name, if there is one.
    #[cfg(unix)]
    pub fn find(&self) -> Result<(), String> {
        program::find(&self.words).map_err(|problem| format!("`cmd:{}`: {problem}", self.command))
    }

    /// Returns the command line.
    pub fn command(&self) -> &str {
        &self.command
    }

    /// Returns the process. Starts it and sends the `hello` message if necessary.
    fn running(&mut self, turn: &Turn<'_>) -> Result<&mut Running, Halt> {
        let running = match self.running.take() {
            Some(running) => running,
            None => {
                let started = LineProcess::start(&self.words, &self.config.inherited, &self.config.guard);
                let process = started.map_err(|error| match error.kind() {
                    std::io::ErrorKind::Interrupted => Halt::Interrupted,
                    _ => self.not_started(&error.to_string()),
                })?;
                self.is_greeted = false;
                Running { process, shown: Shown::of(turn, self.track) }
            }
        };
        if !std::mem::replace(&mut self.is_greeted, true) {
            running.process.send_line(line(&running.shown.hello(turn, self.max_output_tokens)));
        }
        Ok(self.running.insert(running))
    }

    /// Returns the notice about a process that does not respond to `invalid` messages.
    fn silence(&self, turn: &Turn<'_>) -> String {
        let (command, number, seconds) = (&self.command, turn.number, self.config.timeout.as_secs_f64());
        format!(
            "`{command}` has not answered since its answer at step {number} was rejected as `invalid`: each \
             `invalid` message requires a new answer; waiting for up to {seconds} s"
        )
    }

    /// Records the thought that a usable answer reports, if any. Returns `true` if the thought exceeds the limit.
    fn record_thought(
        &self,
        journal: &mut Journal,
        turn: &Turn<'_>,
        attempt: u32,
        Thought { output_tokens, reasoning }: Thought,
    ) -> Result<bool, Halt> {
        let id = (turn.number, attempt);
        // An interrupted run may have recorded the answer that the process has now given again.
        let recorded = journal.pending().iter().find_map(|event| match event {
            Event::Reply(reply) if (reply.step, reply.attempt) == id => Some(reply.class),
            _ => None,
        });
        if let Some(class) = recorded {
            return Ok(class == ReplyClass::Truncated);
        }
        if output_tokens.is_none() && reasoning.is_none() {
            return Ok(false);
        }
        let usage = Usage { output_tokens, ..Usage::default() };
        let reply = ChatReply { reasoning, usage, ..ChatReply::new(String::new(), Finish::Stop) };
        let limit = self.max_output_tokens.map(AnswerLimit::Tokens);
        let is_excess = limit.is_some_and(|limit| limit.is_exceeded(&reply));
        let (class, finish) = match is_excess {
            true => (ReplyClass::Truncated, Finish::Excess),
            false => (ReplyClass::Strict, Finish::Stop),
        };
        let reply = Reply::of(turn.number, attempt, class, ChatReply { finish, ..reply });
        journal.push(Event::Reply(reply)).map_err(|error| Halt::Log(error.to_string()))?;
        Ok(is_excess)
    }

    fn not_started(&self, why: &str) -> Halt {
        Halt::Rejected(format!("`{}` cannot be started: {why}", self.command))
    }

    /// Handles a failure of the player: kills the process, and reports its last output.
    fn failed(&mut self, no_line: NoLine, turn: &Turn<'_>, attempt: u32) -> Halt {
        let number = turn.number;
        let what = match no_line {
            NoLine::TimedOut => {
                let seconds = self.config.timeout.as_secs_f64();
                let refused = if attempt > 0 { " after its answer was rejected as `invalid`" } else { "" };
                format!("did not answer at step {number} within {seconds} s{refused}")
            }
            NoLine::Closed => format!("exited at step {number}"),
            NoLine::TooLong => {
                let limit = child::MAX_LINE / 1024;
                format!("wrote a line of more than {limit} KiB at step {number}")
            }
            NoLine::Stale => {
                let limit = MAX_STALE / 1024;
                format!("wrote more than {limit} KiB of outdated answers (to earlier steps) at step {number}")
            }
        };
        let (status, words) = self.running.take().map_or((None, String::new()), |it| it.process.kill());
        #[cfg(unix)]
        if running::running().is_over {
            return Halt::Interrupted;
        }
        #[cfg(unix)]
        if status.and_then(|status| status.code()) == Some(guard::NOT_STARTED)
            && let Some(why) = words.strip_prefix(guard::NOT_STARTED_BECAUSE)
        {
            return self.not_started(why);
        }
        let status = status.map_or_else(String::new, |status| format!(" ({status})"));
        let words = if words.is_empty() {
            ", and its standard error is empty"
        } else {
            "; the end of its standard error: "
        }
        .to_owned()
            + &words;
        Halt::Infrastructure(format!("`{}` {what}{status}{words}", self.command))
    }
}

impl Agent for Process {
    fn begin(&mut self, _: &Task<'_>) {
        self.is_greeted = false;
    }

    fn predict(
        &mut self,
        last: &Turn<'_>,
        kinds: &[String],
        journal: &mut Journal,
    ) -> Result<Option<Said>, Halt> {
        if self.track != Track::Discover {
            return Ok(None);
        }
        let timeout = self.config.timeout;
        let running = self.running(last)?;
        let names: BTreeMap<String, String> =
            kinds.iter().map(|own| (running.shown.name(own).to_owned(), own.clone())).collect();
        let asked = Message::Predict { turn: last.number, kinds: names.keys().map(String::as_str).collect() };
        running.process.send_line(line(&asked));
        for attempt in 0..=MAX_REASKS {
            self.running(last)?;
            let process = &self.running.as_ref().expect("the process was started").process;
            let answer = match receive(process, timeout, last.number, None, || ()) {
                Ok(answer) => answer,
                Err(no_line) => return Err(self.failed(no_line, last, attempt)),
            };
            match read_predictions(&answer, &names) {
                Ok(predicted) => {
                    return Ok(Some(Said { predicted: Some(predicted), validity: Validity::Valid }));
                }
                Err(message) => {
                    record(journal, last, attempt, &answer)?;
                    if attempt < MAX_REASKS {
                        let again = Message::Invalid { turn: last.number, message };
                        self.running(last)?.process.send_line(line(&again));
                    }
                }
            }
        }
        Ok(Some(Said { predicted: None, validity: Validity::Invalid }))
    }

    fn act(&mut self, turn: &Turn<'_>, journal: &mut Journal) -> Result<Choice, Halt> {
        let actions = of_use(turn);
        let turn = &Turn { actions: &actions, ..*turn };
        let timeout = self.config.timeout;
        let running = self.running(turn)?;
        running.process.send_line(running.shown.turn(turn, None));
        for attempt in 0..=MAX_REASKS {
            let notice_after = (attempt > 0).then(|| NOTICE_AFTER.min(timeout / 2));
            self.running(turn)?;
            let process = &self.running.as_ref().expect("the process was started").process;
            let notice = || (self.notices.0)(&self.silence(turn));
            let answer = match receive(process, timeout, turn.number, notice_after, notice) {
                Ok(answer) => answer,
                Err(no_line) => return Err(self.failed(no_line, turn, attempt)),
            };
            match read(&answer, turn) {
                Ok((actions, thought)) => {
                    let is_excess = self.record_thought(journal, turn, attempt, thought)?;
                    let excess = || Choice::nothing(Validity::Truncated);
                    return Ok(if is_excess { excess() } else { Choice::plan(actions) });
                }
                Err(message) => {
                    record(journal, turn, attempt, &answer)?;
                    if attempt < MAX_REASKS {
                        let again = Message::Invalid { turn: turn.number, message };
                        self.running(turn)?.process.send_line(line(&again));
                    }
                }
            }
        }
        Ok(Choice::nothing(Validity::Invalid))
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, choice: &Choice) -> Result<(), Halt> {
        let actions = of_use(turn);
        let turn = &Turn { actions: &actions, ..*turn };
        let running = self.running(turn)?;
        let past = match turn.commit.is_one() {
            true => Past { past: true, action: Some(choice.action(0)), actions: None },
            false => Past { past: true, action: None, actions: Some(choice.actions.clone()) },
        };
        running.process.send_line(running.shown.turn(turn, Some(past)));
        Ok(())
    }

    fn end(&mut self, last: &Turn<'_>) {
        if let Some(running) = self.running.take() {
            let masked = running.shown.masked(last.observation);
            let seen = running.shown.seen(last, &masked, true);
            let end = Message::End { turn: last.number, seen, outcome: last.observation.outcome };
            running.process.send_line(line(&end));
            // The process plays the next level too.
            if last.series.is_some_and(|series| !series.place.is_last()) {
                self.running = Some(running);
            } else {
                running.process.close();
            }
        }
    }
}

/// Returns the available actions that can have an effect in the game. Model prompts list the same actions.
fn of_use(turn: &Turn<'_>) -> Vec<Action> {
    let analysis = &turn.subject.analysis;
    turn.actions.iter().copied().filter(|&action| is_of_use(analysis, action)).collect()
}

/// The facts about a game that apply to the entire episode.
#[derive(Debug)]
struct Shown {
    rules: String,
    legend: Legend,
    /// The mask with the names sent to the process, or `None` if the game's own names are sent.
    mask: Option<Mask>,
    /// `true` if the score is shown only at the end.
    hides_score: bool,
}

impl Shown {
    fn of(turn: &Turn<'_>, track: Track) -> Shown {
        let game = &turn.subject.game;
        let mask = (track != Track::Told).then(|| Mask::neutral(game));
        let masked = mask.as_ref().map(|mask| Analysis::of(&mask.game));
        let analysis = masked.as_ref().unwrap_or(&turn.subject.analysis);
        let shuffled = mask.as_ref().map(|_| Mask::neutral_characters(game));
        let legend = Legend::new(analysis, &LegendOptions { shuffled, ..LegendOptions::default() });
        let hides_score = track == Track::Discover;
        // The game's own legend is omitted, because the characters of the level files differ from those of
        // the grid.
        let rules = Guide { legend: Vec::new(), ..limited(Guide::from_analysis(analysis), turn.limit) };
        let rules = if hides_score { String::new() } else { rules.to_string() };
        Shown { rules, legend, mask, hides_score }
    }

    /// Returns the name sent to the process for one of the game's own names.
    fn name<'a>(&'a self, own: &'a str) -> &'a str {
        self.mask.as_ref().map_or(own, |mask| mask.name(own))
    }

    /// Returns the observation with the names sent to the process.
    fn masked<'a>(&self, seen: &'a Observation) -> Cow<'a, Observation> {
        self.mask.as_ref().map_or(Cow::Borrowed(seen), |mask| Cow::Owned(mask.observation(seen)))
    }

    fn hello<'a>(&'a self, turn: &'a Turn<'_>, max_output_tokens: Option<u32>) -> Message<'a> {
        let mut legend: BTreeMap<char, Vec<&str>> = BTreeMap::new();
        for entry in self.legend.entries() {
            legend.entry(entry.symbol).or_default().push(&entry.name);
        }
        Message::Hello {
            protocol: PROTOCOL,
            rules: &self.rules,
            legend,
            actions: turn.actions,
            columns: turn.observation.columns,
            rows: turn.observation.rows,
            step_limit: turn.limit,
            commit: turn.commit,
            max_output_tokens,
            series: turn.series.map(|series| series.place),
        }
    }

    /// Returns the message for a turn, as a line of JSON.
    fn turn(&self, turn: &Turn<'_>, past: Option<Past>) -> Vec<u8> {
        let masked = self.masked(turn.observation);
        let played = (!turn.commit.is_one()).then(|| turn.played.iter().map(Tick::of).collect());
        let seen = self.seen(turn, &masked, !self.hides_score);
        line(&Message::Turn { turn: turn.number, seen, actions: turn.actions, played, past })
    }

    fn seen<'a>(&self, turn: &Turn<'_>, masked: &'a Observation, is_scored: bool) -> Seen<'a> {
        let grid = encoding::grid(masked, &self.legend);
        let reward = is_scored.then(|| turn.played.iter().map(|played| played.reward).sum());
        Seen::of(masked, grid.lines().map(str::to_owned).collect(), reward)
    }
}

/// Returns the next answer to the given turn.
///
/// Answers to an earlier turn are skipped, so an agent that states its turns cannot get out of sync. Skipped
/// answers count towards the timeout. Calls `notice` once if no answer has arrived after `notice_after`.
fn receive(
    process: &LineProcess,
    timeout: Duration,
    turn: u64,
    mut notice_after: Option<Duration>,
    notice: impl Fn(),
) -> Result<Vec<u8>, NoLine> {
    let (asked, mut stale) = (Stopwatch::start(), 0);
    loop {
        let left = timeout.checked_sub(asked.elapsed()).ok_or(NoLine::TimedOut)?;
        let quiet = notice_after.map(|after| after.saturating_sub(asked.elapsed()));
        let answer = match process.receive(quiet.map_or(left, |quiet| quiet.min(left))) {
            Err(NoLine::TimedOut) if quiet.is_some_and(|quiet| quiet < left) => {
                notice_after = None;
                notice();
                continue;
            }
            answer => answer?,
        };
        if !serde_json::from_slice::<Addressed>(&answer).is_ok_and(|addressed| addressed.turn < turn) {
            return Ok(answer);
        }
        stale += answer.len() + 1;
        if stale > MAX_STALE {
            return Err(NoLine::Stale);
        }
    }
}

/// Records an invalid answer, unless an interrupted run has already recorded it.
fn record(journal: &mut Journal, turn: &Turn<'_>, attempt: u32, answer: &[u8]) -> Result<(), Halt> {
    let id = (turn.number, attempt);
    let known = |event: &Event| matches!(event, Event::Reply(reply) if (reply.step, reply.attempt) == id);
    if journal.pending().iter().any(known) {
        return Ok(());
    }
    let text = String::from_utf8_lossy(answer).chars().take(MAX_RECORDED).collect();
    let Thought { output_tokens, reasoning } = serde_json::from_slice(answer).unwrap_or_default();
    let usage = Usage { output_tokens, ..Usage::default() };
    let reply = ChatReply { reasoning, usage, ..ChatReply::new(text, Finish::Other) };
    let reply = Reply::of(turn.number, attempt, ReplyClass::Invalid, reply);
    journal.push(Event::Reply(reply)).map_err(|error| Halt::Log(error.to_string()))
}

fn line(message: &Message<'_>) -> Vec<u8> {
    serde_json::to_vec(message).expect("messages are plain data")
}

#[cfg(all(test, unix))]
mod tests;
