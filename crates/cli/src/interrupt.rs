//! Signal handling. On Ctrl-C and similar signals, resumable work prints a hint before the program ends.
//!
//! A subcommand that stores its work on disk calls [`watch`] before the work starts, and [`defer`] when the
//! work is done. The first of SIGINT, SIGTERM, SIGHUP and SIGQUIT then prints a hint about `--resume` and
//! ends the program with status 128 + signal, as in shells. A second signal ends the program immediately. A
//! signal that was ignored when the program started, as with `nohup`, stays ignored. SIGKILL cannot be
//! caught, so the files on disk must always suffice to resume.

#[cfg(unix)]
mod unix {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::io::{IsTerminal, Write};
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;

    /// `true` if a signal is about to end the program.
    static ENDING: AtomicBool = AtomicBool::new(false);

    /// Starts handling the signals. On a signal, `last` runs first and may take several seconds. Then `hint`
    /// is written to standard error.
    pub(crate) fn watch(last: impl FnOnce() + Send + 'static, hint: String) {
        let ignored = ignored();
        let caught =
            [SIGINT, SIGTERM, SIGHUP, SIGQUIT].into_iter().filter(|signal| !ignored.contains(signal));
        // If no handler can be installed, a signal ends the program as usual.
        let Ok(mut signals) = Signals::new(caught) else { return };
        thread::spawn(move || {
            let mut first = Some((last, hint));
            for signal in signals.forever() {
                let status = 128 + signal;
                ENDING.store(true, Ordering::SeqCst);
                let Some((last, hint)) = first.take() else { std::process::exit(status) };
                thread::spawn(move || {
                    last();
                    let mut stderr = std::io::stderr();
                    // A progress bar may occupy the current line.
                    let gap = if stderr.is_terminal() { "\n" } else { "" };
                    let _ = writeln!(stderr, "{gap}{hint}");
                    std::process::exit(status)
                });
            }
        });
    }

    /// Blocks if a signal is about to end the program, so that nothing more is printed or written.
    pub(crate) fn defer() {
        while ENDING.load(Ordering::SeqCst) {
            thread::park();
        }
    }

    /// Returns the signals that are already ignored. If the system does not report ignored signals, returns
    /// the signals that shells ignore for background programs.
    fn ignored() -> Vec<i32> {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        match mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
            Some(mask) => (1..=64).filter(|signal| mask & (1 << (signal - 1)) != 0).collect(),
            None => vec![SIGHUP, SIGQUIT],
        }
    }
}

#[cfg(unix)]
pub(crate) use unix::{defer, watch};

/// Does nothing on non-Unix systems, where a signal ends the program silently.
#[cfg(not(unix))]
pub(crate) fn watch(_: impl FnOnce() + Send + 'static, _: String) {}

/// Does nothing on non-Unix systems.
#[cfg(not(unix))]
pub(crate) fn defer() {}
