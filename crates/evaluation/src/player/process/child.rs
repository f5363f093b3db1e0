//! A child process that communicates through lines of text.

#[cfg(unix)]
use super::running::running;
use crate::run::clock::Stopwatch;
use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// The maximum length of a line from a process, in bytes (1 MiB).
pub(super) const MAX_LINE: usize = 1 << 20;

/// The number of bytes to keep from the end of standard error.
const STDERR_TAIL: usize = 2000;

/// The number of unread lines after which a process's writes block.
const MAX_QUEUED_LINES: usize = 16;

/// The time allowed for a process to exit after it is notified that the episode has ended.
pub(super) const EXIT_TIME: Duration = Duration::from_secs(2);

/// The time allowed for the reader threads to deliver a dead process's remaining output.
const DRAIN_TIME: Duration = Duration::from_millis(500);

/// The maximum number of times to check whether a guard (the supervising process) has killed its program and exited.
/// Including the pauses between checks, this takes at most ten seconds.
const POLLS: u32 = 2000;
/// The pause between two checks on a guard (the supervising process).
const PAUSE: Duration = Duration::from_millis(5);

/// The environment variables that every process inherits if they are set. They specify the locations of
/// programs, libraries and caches, and the language. None of them contains an API key.
const ENVIRONMENT: &[&str] = &[
    "PATH",
    "HOME",
    "LANG",
    "LC_ALL",
    "LC_CTYPE",
    "TZ",
    "VIRTUAL_ENV",
    "PYTHONPATH",
    "LD_LIBRARY_PATH",
    "DYLD_LIBRARY_PATH",
    "SYSTEMROOT",
];

/// A running process with its own empty folder. Dropping the value kills the process and all its descendants,
/// and removes the folder.
#[derive(Debug)]
pub(super) struct LineProcess {
    /// The player's process, or its guard (the supervising process) if it has one.
    child: Child,
    is_guarded: bool,
    /// The channel for sending lines, or `None` once the input is closed.
    input: Option<Sender<Vec<u8>>>,
    output: Receiver<Output>,
    stderr_tail: Receiver<String>,
    /// The process's folder, removed on drop.
    _folder: TempDir,
    ended: bool,
}

#[derive(Debug)]
enum Output {
    Line(Vec<u8>),
    TooLong,
}

/// The reason why no line was received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoLine {
    /// No line arrived before the timeout.
    TimedOut,
    /// The process closed its standard output, so it is dead or about to exit.
    Closed,
    /// The line is longer than [`MAX_LINE`].
    TooLong,
    /// The process sent too many answers to earlier questions.
    Stale,
}

impl LineProcess {
    /// Starts a player's program. If `guard` is not empty, it is a command that runs the program and stops it when
    /// `arcade` ends. File names in the command are made absolute, because the process runs in a different folder.
    ///
    /// # Errors
    /// Returns an error if the process cannot be started. The error kind `Interrupted` means that `arcade` itself is
    /// about to exit.
    pub(super) fn start(
        words: &[String],
        inherited: &[String],
        guard: &[OsString],
    ) -> std::io::Result<LineProcess> {
        let place = std::path::absolute(std::env::temp_dir())?;
        let mut builder = tempfile::Builder::new();
        // Files that players write to the folder must not be readable by other users.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let folder = builder.prefix("arcade-player-").tempdir_in(place)?;
        let (program, arguments) = words.split_first().expect("a command has a first word");
        let own = resolved(program, program.contains(std::path::is_separator));
        let mut command = match guard.split_first() {
            None => Command::new(own),
            Some((guard, before)) => {
                let mut command = Command::new(guard);
                command.args(before).arg(folder.path()).arg("--").arg(own);
                command
            }
        };
        command
            .args(arguments.iter().map(|word| resolved(word, true)))
            .current_dir(folder.path())
            .env_clear()
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let names = ENVIRONMENT.iter().copied().chain(inherited.iter().map(String::as_str));
        command.envs(names.filter_map(|name| Some((name, std::env::var_os(name)?))));
        command.env("TMPDIR", folder.path());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = spawn(&mut command, !guard.is_empty())?;

        let (input, lines) = channel();
        let (sender, output) = sync_channel(MAX_QUEUED_LINES);
        let (tail_sender, stderr_tail) = channel();
        let stdin = child.stdin.take().expect("standard input is piped");
        let stdout = child.stdout.take().expect("standard output is piped");
        let stderr = child.stderr.take().expect("standard error is piped");
        thread::spawn(move || write(stdin, &lines));
        thread::spawn(move || read(stdout, &sender));
        thread::spawn(move || tail_sender.send(tail(stderr)));
        Ok(LineProcess {
            child,
            is_guarded: !guard.is_empty(),
            input: Some(input),
            output,
            stderr_tail,
            _folder: folder,
            ended: false,
        })
    }

    /// Sends a line without waiting for the process to read it.
    pub(super) fn send_line(&self, mut line: Vec<u8>) {
        line.push(b'\n');
        if let Some(input) = &self.input {
            // A process that does not read the line will not answer it either.
            let _ = input.send(line);
        }
    }

    /// Returns the next line without its line ending.
    pub(super) fn receive(&self, timeout: Duration) -> Result<Vec<u8>, NoLine> {
        match self.output.recv_timeout(timeout) {
            Ok(Output::Line(line)) => Ok(line),
            Ok(Output::TooLong) => Err(NoLine::TooLong),
            Err(RecvTimeoutError::Timeout) => Err(NoLine::TimedOut),
            Err(RecvTimeoutError::Disconnected) => Err(NoLine::Closed),
        }
    }

    /// Closes the process's input, and gives the process a moment to exit by itself. Ignores its output.
    pub(super) fn close(mut self) {
        self.input = None;
        let closed = Stopwatch::start();
        while let Some(left) = EXIT_TIME.checked_sub(closed.elapsed()) {
            if self.receive(left).is_err() {
                return;
            }
        }
    }

    /// Kills the process and all its descendants. Returns the exit status if the process had already exited,
    /// and also the last part of its standard error.
    pub(super) fn kill(mut self) -> (Option<ExitStatus>, String) {
        if matches!(self.receive(Duration::ZERO), Err(NoLine::Closed)) {
            // The process is already exiting, so its own exit status will be available in a moment.
            thread::sleep(DRAIN_TIME / 10);
        }
        let status = self.end().filter(|status| status.code().is_some());
        (status, self.stderr_tail.recv_timeout(DRAIN_TIME).unwrap_or_default())
    }

    /// Kills the remaining processes, and reaps the child.
    fn end(&mut self) -> Option<ExitStatus> {
        if std::mem::replace(&mut self.ended, true) {
            return None;
        }
        #[cfg(unix)]
        let _held = self.end_group();
        let _ = self.child.kill();
        self.child.wait().ok()
    }

    /// Makes the guard terminate its program, and kills the remaining process group. While the returned lock
    /// is held, `end_all` waits, so the process ID cannot be reused before the process is reaped.
    #[cfg(unix)]
    fn end_group(&self) -> Option<std::sync::MutexGuard<'static, super::running::Running>> {
        use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, kill_process_group, waitid};
        let id = Pid::from_child(&self.child);
        if self.is_guarded {
            let _ = kill_process(id, Signal::TERM);
            let how = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
            for _ in 0..POLLS {
                if !matches!(waitid(WaitId::Pid(id), how), Ok(None)) {
                    break;
                }
                thread::sleep(PAUSE);
            }
        }
        let mut running = running();
        running.players.remove(&self.child.id());
        let _ = kill_process_group(id, Signal::KILL);
        Some(running)
    }

    /// Returns the process's working directory.
    #[cfg(test)]
    pub(super) fn folder(&self) -> &Path {
        self._folder.path()
    }

    #[cfg(test)]
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }
}

impl Drop for LineProcess {
    fn drop(&mut self) {
        self.end();
    }
}

/// Starts a process and registers it as running, atomically.
fn spawn(command: &mut Command, is_guarded: bool) -> std::io::Result<Child> {
    #[cfg(unix)]
    {
        let mut running = running();
        if running.is_over {
            return Err(std::io::ErrorKind::Interrupted.into());
        }
        let child = command.spawn()?;
        running.players.insert(child.id(), is_guarded);
        Ok(child)
    }
    #[cfg(not(unix))]
    {
        let _ = is_guarded;
        command.spawn()
    }
}

/// Resolves a word so that it has the same meaning in any folder: returns the absolute path if the word names
/// an existing file.
fn resolved(word: &str, may_be_file: bool) -> OsString {
    let path = Path::new(word);
    let absolute = || std::path::absolute(path).ok();
    let named = may_be_file && !word.is_empty() && path.is_relative() && path.exists();
    named.then(absolute).flatten().map_or_else(|| word.into(), Into::into)
}

fn write(mut stdin: impl Write, lines: &Receiver<Vec<u8>>) {
    while let Ok(line) = lines.recv() {
        if stdin.write_all(&line).and_then(|()| stdin.flush()).is_err() {
            return;
        }
    }
}

fn read(stdout: impl Read, sender: &SyncSender<Output>) {
    let mut stdout = BufReader::new(stdout);
    loop {
        let mut line = Vec::new();
        match stdout.by_ref().take(MAX_LINE as u64 + 1).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
        let ended = line.pop_if(|&mut last| last == b'\n').is_some();
        let output = if ended || line.len() <= MAX_LINE { Output::Line(line) } else { Output::TooLong };
        if sender.send(output).is_err() || !ended {
            return;
        }
    }
}

/// Reads a stream to its end, and returns its last [`STDERR_TAIL`] bytes as text.
fn tail(mut stderr: impl Read) -> String {
    let (mut kept, mut bytes) = (VecDeque::new(), [0; 4096]);
    while let Ok(length @ 1..) = stderr.read(&mut bytes) {
        kept.extend(&bytes[..length]);
        kept.drain(..kept.len().saturating_sub(STDERR_TAIL));
    }
    String::from_utf8_lossy(kept.make_contiguous()).trim().to_owned()
}
