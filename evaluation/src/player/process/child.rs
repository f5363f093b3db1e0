//! A child process that is spoken to in lines.

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

/// Bytes of a line that a process may say, 1 MiB.
pub(super) const MAX_LINE: usize = 1 << 20;

/// What is kept of the last words of standard error, bytes.
const MAX_LAST_WORDS: usize = 2000;

/// Lines that a process may be ahead of us, until its writes wait.
const AHEAD: usize = 16;

/// How long a process that has been told of the end may take to leave.
pub(super) const LEAVING: Duration = Duration::from_secs(2);

/// How long the threads may take to hand over what a dead process has said.
const SETTLING: Duration = Duration::from_millis(500);

/// Looks, until a guard has killed what it guards and has left, and the pause between them: ten seconds at most.
const LOOKS: u32 = 2000;
const PAUSE: Duration = Duration::from_millis(5);

/// What every process inherits of the environment, as far as it is set: where programs, libraries and their caches are, and
/// the language. No key of a provider is among them.
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

/// A running process with an empty folder of its own. Dropping it kills it, with all that it has started, and removes the
/// folder.
#[derive(Debug)]
pub(super) struct Talker {
    /// The process, or its guard.
    child: Child,
    is_guarded: bool,
    /// None once nothing more will be said.
    says: Option<Sender<Vec<u8>>>,
    hears: Receiver<Heard>,
    last_words: Receiver<String>,
    /// Removed when this is dropped.
    _folder: TempDir,
    ended: bool,
}

/// What came over standard output.
#[derive(Debug)]
enum Heard {
    Line(Vec<u8>),
    TooLong,
}

/// Why there is no line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Silence {
    /// None came in time.
    TimedOut,
    /// The process has closed its standard output: it is dead or dying.
    Closed,
    /// A line longer than [`MAX_LINE`].
    Flood,
    /// Nothing but answers to earlier questions, and too many of them.
    Stale,
}

impl Talker {
    /// Starts a program, behind a guard if there is a command for one. Words of the command that name files from here are made
    /// absolute, because the process is somewhere else.
    ///
    /// # Errors
    /// It cannot be started; of kind `Interrupted`: this program is about to end.
    pub(super) fn start(
        words: &[String],
        inherited: &[String],
        guard: &[OsString],
    ) -> std::io::Result<Talker> {
        let place = std::path::absolute(std::env::temp_dir())?;
        let folder = tempfile::Builder::new().prefix("arcade-player-").tempdir_in(place)?;
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

        let (says, lines) = channel();
        let (heard, hears) = sync_channel(AHEAD);
        let (words, last_words) = channel();
        let stdin = child.stdin.take().expect("it is piped");
        let stdout = child.stdout.take().expect("it is piped");
        let stderr = child.stderr.take().expect("it is piped");
        thread::spawn(move || write(stdin, &lines));
        thread::spawn(move || read(stdout, &heard));
        thread::spawn(move || words.send(tail(stderr)));
        Ok(Talker {
            child,
            is_guarded: !guard.is_empty(),
            says: Some(says),
            hears,
            last_words,
            _folder: folder,
            ended: false,
        })
    }

    /// Says a line, without waiting until it is read.
    pub(super) fn say(&self, mut line: Vec<u8>) {
        line.push(b'\n');
        if let Some(says) = &self.says {
            // If nobody reads it, the silence that follows tells.
            let _ = says.send(line);
        }
    }

    /// The next line, without its end.
    pub(super) fn hear(&self, timeout: Duration) -> Result<Vec<u8>, Silence> {
        match self.hears.recv_timeout(timeout) {
            Ok(Heard::Line(line)) => Ok(line),
            Ok(Heard::TooLong) => Err(Silence::Flood),
            Err(RecvTimeoutError::Timeout) => Err(Silence::TimedOut),
            Err(RecvTimeoutError::Disconnected) => Err(Silence::Closed),
        }
    }

    /// Says no more, and gives the process a moment to leave by itself, whatever it says meanwhile.
    pub(super) fn let_go(mut self) {
        self.says = None;
        let told = Stopwatch::start();
        while let Some(left) = LEAVING.checked_sub(told.elapsed()) {
            if self.hear(left).is_err() {
                return;
            }
        }
    }

    /// Kills the process, with all that it has started. Its exit status, if it had left before, and the last that it wrote
    /// to standard error.
    pub(super) fn kill(mut self) -> (Option<ExitStatus>, String) {
        if matches!(self.hear(Duration::ZERO), Err(Silence::Closed)) {
            // It is leaving: with a moment more it has a status of its own.
            thread::sleep(SETTLING / 10);
        }
        let status = self.end().filter(|status| status.code().is_some());
        (status, self.last_words.recv_timeout(SETTLING).unwrap_or_default())
    }

    /// Kills what is left of it, and leaves no zombie behind.
    fn end(&mut self) -> Option<ExitStatus> {
        if std::mem::replace(&mut self.ended, true) {
            return None;
        }
        #[cfg(unix)]
        let _held = self.end_group();
        let _ = self.child.kill();
        self.child.wait().ok()
    }

    /// Has the guard end what it guards, and kills what is left of the group. Before the process is waited for, nobody else can
    /// have its number: so whoever ends all players waits until then.
    #[cfg(unix)]
    fn end_group(&self) -> Option<std::sync::MutexGuard<'static, super::running::Running>> {
        use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, kill_process_group, waitid};
        let id = Pid::from_child(&self.child);
        if self.is_guarded {
            let _ = kill_process(id, Signal::TERM);
            let how = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
            for _ in 0..LOOKS {
                if !matches!(waitid(WaitId::Pid(id), how), Ok(None)) {
                    break;
                }
                thread::sleep(PAUSE);
            }
        }
        let mut running = running();
        running.remove(self.child.id());
        let _ = kill_process_group(id, Signal::KILL);
        Some(running)
    }

    /// The folder in which it runs.
    #[cfg(test)]
    pub(super) fn folder(&self) -> &Path {
        self._folder.path()
    }

    /// The process's number.
    #[cfg(test)]
    pub(super) fn id(&self) -> u32 {
        self.child.id()
    }
}

impl Drop for Talker {
    fn drop(&mut self) {
        self.end();
    }
}

/// Starts a process and notes it among those that run, in one go.
fn spawn(command: &mut Command, is_guarded: bool) -> std::io::Result<Child> {
    #[cfg(unix)]
    {
        let mut running = running();
        if running.is_over() {
            return Err(std::io::ErrorKind::Interrupted.into());
        }
        let child = command.spawn()?;
        running.insert(child.id(), is_guarded);
        Ok(child)
    }
    #[cfg(not(unix))]
    {
        let _ = is_guarded;
        command.spawn()
    }
}

/// A word as it means the same from anywhere: the absolute path of the file that it names from here, if it names one.
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

fn read(stdout: impl Read, heard: &SyncSender<Heard>) {
    let mut stdout = BufReader::new(stdout);
    loop {
        let mut line = Vec::new();
        match stdout.by_ref().take(MAX_LINE as u64 + 1).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return,
            Ok(_) => {}
        }
        let ended = line.pop_if(|&mut last| last == b'\n').is_some();
        let said = if ended || line.len() <= MAX_LINE { Heard::Line(line) } else { Heard::TooLong };
        if heard.send(said).is_err() || !ended {
            return;
        }
    }
}

/// The last words of a stream, which is read to its end.
fn tail(mut stderr: impl Read) -> String {
    let (mut kept, mut bytes) = (VecDeque::new(), [0; 4096]);
    while let Ok(length @ 1..) = stderr.read(&mut bytes) {
        kept.extend(&bytes[..length]);
        kept.drain(..kept.len().saturating_sub(MAX_LAST_WORDS));
    }
    String::from_utf8_lossy(kept.make_contiguous()).trim().to_owned()
}
