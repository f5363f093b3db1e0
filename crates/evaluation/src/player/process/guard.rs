//! The guard of an external player. A guard is a process between `arcade` and the player's program. The guard
//! terminates the program when `arcade` has exited.
//!
//! `arcade` can be killed by a signal that it cannot handle, and a program can start processes that leave its
//! process group (`setsid`). Therefore, the guard relays messages from `arcade` to the program. When the
//! episode is over or `arcade` no longer exists, the message stream closes. The guard then kills the program
//! and all its descendants, and removes the folder in which the program ran. The program's standard output
//! and standard error go directly to `arcade`.
//!
//! On Linux, the guard is the reaper of its descendants (`PR_SET_CHILD_SUBREAPER`). A process that outlives
//! its parent remains a descendant of the guard in any group or session, so it can be found. On other
//! systems, processes that have left the program's group escape. A control group would not catch more
//! processes: processes started through an external service (`systemd-run`, `docker`) escape both mechanisms.

use super::child::EXIT_TIME;
use rustix::io::Errno;
use rustix::process::{Pid, Signal, WaitOptions, getpid, kill_process, kill_process_group, wait};
use signal_hook::consts::{SIGCHLD, SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use signal_hook::iterator::Signals;
use std::ffi::OsString;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

/// The guard's exit status if its program could not be started.
pub(super) const NOT_STARTED: i32 = 126;

/// The beginning of the guard's last message if its program could not be started. The reason follows it.
pub(super) const NOT_STARTED_BECAUSE: &str = "arcade player-guard: not started: ";

/// The maximum number of rounds in which all remaining descendants are killed.
const ROUNDS: u32 = 1000;

/// The pause after each round of killing descendants.
const PAUSE: Duration = Duration::from_millis(5);

enum Event {
    /// A signal: `SIGCHLD`, or a request to exit.
    Signal(i32),
    InputEnded,
    /// The time allowed for the program to exit voluntarily is over.
    TimeUp,
}

/// Runs a program until the program and all its descendants have exited, or until they must be killed. The
/// program must exit within two seconds after standard input closes, or immediately on `SIGTERM`, `SIGINT`,
/// `SIGHUP` or `SIGQUIT`. Removes `folder` at the end.
///
/// Returns the program's exit status, 128 plus the number of the signal that killed the program, or 126 if
/// the program could not be started. A guard that has to kill its program also kills itself with `SIGKILL`,
/// together with its process group. The guard should be the group's leader.
pub fn guard(folder: &Path, program: &OsString, arguments: &[OsString]) -> i32 {
    let (sender, events) = channel();
    let started = Signals::new([SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT]).and_then(|signals| {
        // On systems without subreapers, the guard can kill only the process group.
        #[cfg(target_os = "linux")]
        let _ = rustix::process::set_child_subreaper(Some(getpid()));
        let child = Command::new(program).args(arguments).stdin(Stdio::piped()).spawn()?;
        Ok((signals, child))
    });
    let (mut signals, mut child) = match started {
        Ok(started) => started,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "{NOT_STARTED_BECAUSE}{error}");
            let _ = std::fs::remove_dir_all(folder);
            return NOT_STARTED;
        }
    };
    release_output();
    relay(child.stdin.take().expect("standard input is piped"), sender.clone());
    let signal_sender = sender.clone();
    thread::spawn(move || signals.forever().all(|signal| signal_sender.send(Event::Signal(signal)).is_ok()));
    let mut program = Program { child, status: None };
    let exited = program.wait_for_end(&events, &sender);
    program.kill();
    let _ = std::fs::remove_dir_all(folder);
    match program.status {
        Some(status) if exited => status,
        _ => {
            let _ = kill_process_group(rustix::process::getpgrp(), Signal::KILL);
            unreachable!("SIGKILL ends every process")
        }
    }
}

/// The guarded program, with its exit status once it has exited.
struct Program {
    child: Child,
    status: Option<i32>,
}

impl Program {
    fn pid(&self) -> Pid {
        Pid::from_child(&self.child)
    }

    /// Waits until all processes have exited or must be killed. Returns `true` if the caller may need the
    /// exit status.
    fn wait_for_end(&mut self, events: &Receiver<Event>, sender: &Sender<Event>) -> bool {
        loop {
            match events.recv().expect("this thread holds a sender") {
                Event::Signal(SIGCHLD) => {
                    if !self.reap() {
                        return true;
                    }
                }
                Event::Signal(_) => {
                    // If the program has exited by itself, its own exit status is kept.
                    self.reap();
                    return true;
                }
                Event::InputEnded => {
                    let sender = sender.clone();
                    thread::spawn(move || {
                        thread::sleep(EXIT_TIME);
                        sender.send(Event::TimeUp)
                    });
                }
                Event::TimeUp => return false,
            }
        }
    }

    /// Kills all remaining descendants in up to [`ROUNDS`] rounds, and waits until they are gone.
    fn kill(&mut self) {
        let had_left = self.status;
        for _ in 0..ROUNDS {
            for pid in descendants() {
                let _ = kill_process(pid, Signal::KILL);
            }
            if had_left.is_none() && self.status.is_none() {
                let _ = kill_process(self.pid(), Signal::KILL);
            }
            if !self.reap() {
                break;
            }
            thread::sleep(PAUSE);
        }
        self.status = had_left;
    }

    /// Reaps all exited processes. Returns `true` if any process is still running.
    fn reap(&mut self) -> bool {
        loop {
            match wait(WaitOptions::NOHANG) {
                Ok(Some((pid, ended))) if pid == self.pid() => {
                    let signal = ended.terminating_signal().map(|signal| 128 + signal);
                    self.status = ended.exit_status().or(signal);
                }
                Ok(Some(_)) | Err(Errno::INTR) => {}
                Ok(None) => return true,
                Err(_) => return false,
            }
        }
    }
}

/// Closes the guard's standard output and standard error, so that `arcade` sees the end of the output as soon
/// as the program closes its own.
fn release_output() {
    if let Ok(nowhere) = std::fs::File::options().write(true).open("/dev/null") {
        let _ = rustix::stdio::dup2_stdout(&nowhere);
        let _ = rustix::stdio::dup2_stderr(&nowhere);
    }
}

/// Relays standard input to the program. Reading never waits for writing, so the guard notices the end of its
/// input even if the program never reads. The buffer stays small, because it contains only messages that
/// `arcade` sent without waiting for an answer.
fn relay(mut to: ChildStdin, sender: Sender<Event>) {
    let (pass, passed) = channel::<Vec<u8>>();
    thread::spawn(move || {
        let mut bytes = vec![0; 1 << 16];
        let mut from = std::io::stdin().lock();
        while let Ok(length @ 1..) = from.read(&mut bytes) {
            // Even if the program no longer reads its input, it may still write output.
            let _ = pass.send(bytes[..length].to_vec());
        }
        drop(pass);
        sender.send(Event::InputEnded)
    });
    thread::spawn(move || passed.iter().try_for_each(|bytes| to.write_all(&bytes)));
}

/// Returns all descendants of the current process, from the process table. Cost: O(processes).
#[cfg(target_os = "linux")]
fn descendants() -> Vec<Pid> {
    let mut children: std::collections::BTreeMap<i32, Vec<i32>> = std::collections::BTreeMap::new();
    for entry in std::fs::read_dir("/proc").into_iter().flatten().flatten() {
        let Some(pid) = entry.file_name().to_str().and_then(|name| name.parse().ok()) else { continue };
        if let Some(parent) = std::fs::read(entry.path().join("stat")).ok().and_then(|stat| parent(&stat)) {
            children.entry(parent).or_default().push(pid);
        }
    }
    let mut found = vec![getpid().as_raw_pid()];
    let mut at = 0;
    while let Some(next) = found.get(at) {
        found.extend(children.remove(next).unwrap_or_default());
        at += 1;
    }
    found.into_iter().skip(1).filter_map(Pid::from_raw).collect()
}

/// Parses the parent process ID in a line of `/proc/<pid>/stat`. It is the second field after the process
/// name, which is in parentheses and may contain any byte.
#[cfg(target_os = "linux")]
fn parent(stat: &[u8]) -> Option<i32> {
    let end = stat.iter().rposition(|&byte| byte == b')')?;
    let rest = std::str::from_utf8(&stat[end + 1..]).ok()?;
    rest.split_whitespace().nth(1)?.parse().ok()
}

/// Returns an empty list, because descendants are unknown without a subreaper.
#[cfg(not(target_os = "linux"))]
fn descendants() -> Vec<Pid> {
    Vec::new()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::io::{BufRead, BufReader};

    #[test]
    fn parents_are_parsed_for_any_process_name() {
        assert_eq!(parent(b"17 (sh) S 4 17 17 0"), Some(4));
        assert_eq!(parent(b"17 (a) S 9 (b)\xff) R 4 17"), Some(4));
        assert_eq!(parent(b"17 (sh"), None);
        assert_eq!(parent(b""), None);
    }

    /// Other tests run concurrently in the same process, so this test identifies descendants by their IDs.
    #[test]
    fn children_are_found() {
        let mut command = Command::new("sh");
        command.args(["-c", "sleep 600 & echo $!; wait"]).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut written = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut written).unwrap();
        let grandchild = Pid::from_raw(written.trim().parse().unwrap()).unwrap();
        let all = descendants();
        child.kill().unwrap();
        child.wait().unwrap();
        kill_process(grandchild, Signal::KILL).unwrap();
        assert!(all.contains(&Pid::from_child(&child)) && all.contains(&grandchild), "{all:?}");
    }
}
