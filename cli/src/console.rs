//! Standard output, standard error and progress bars.

use crate::failure::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Where a verb writes.
pub(crate) struct Console {
    json: bool,
    quiet: bool,
}

impl Console {
    pub(crate) fn new(json: bool, quiet: bool) -> Console {
        Console { json, quiet }
    }

    /// The answer, for people; nothing where JSON is wanted.
    pub(crate) fn say(&self, text: impl Display) {
        if !self.json {
            out(format_args!("{text}\n"));
        }
    }

    /// The answer, for programs; nothing where text is wanted.
    pub(crate) fn document(&self, value: &impl Serialize) -> Result<(), Failure> {
        if self.json {
            let text = serde_json::to_string_pretty(value)
                .map_err(|error| Failure::surroundings(error, "the answer cannot be written as JSON"))?;
            out(format_args!("{text}\n"));
        }
        Ok(())
    }

    /// A line of JSON, for people and programs alike: what a verb says that goes on after its answer.
    pub(crate) fn line(&self, value: &serde_json::Value) {
        out(format_args!("{value}\n"));
    }

    /// Remarks beside the answer.
    pub(crate) fn remark(&self, text: impl Display) {
        if !self.quiet {
            let _ = writeln!(std::io::stderr(), "{text}");
        }
    }

    /// What went wrong: said even when quiet.
    pub(crate) fn error(&self, failure: &Failure) {
        let _ = writeln!(std::io::stderr(), "error: {failure}");
    }

    /// A bar on standard error if that is a terminal.
    pub(crate) fn progress(&self, length: u64, what: &'static str) -> ProgressBar {
        let bar = ProgressBar::with_draw_target(
            Some(length),
            if self.quiet || !std::io::stderr().is_terminal() {
                ProgressDrawTarget::hidden()
            } else {
                ProgressDrawTarget::stderr()
            },
        );
        let style = ProgressStyle::with_template(
            "{prefix:>12} [{wide_bar:.cyan}] {pos}/{len} {elapsed_precise}, {eta} left {msg}",
        );
        bar.set_style(style.expect("the template is well-formed").progress_chars("=> "));
        bar.set_prefix(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}

/// Time spent, for remarks: the one clock of the workspace. No output that is recorded depends on it.
pub(crate) struct Stopwatch(Instant);

impl Stopwatch {
    #[expect(clippy::disallowed_methods, reason = "only remarks for people show it")]
    pub(crate) fn start() -> Stopwatch {
        Stopwatch(Instant::now())
    }

    /// Since the start.
    pub(crate) fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// Writes to standard output. A reader that has left (`arcade … | head`) ends the program quietly.
fn out(text: std::fmt::Arguments<'_>) {
    let mut stdout = std::io::stdout().lock();
    if stdout.write_fmt(text).and_then(|()| stdout.flush()).is_err() {
        std::process::exit(i32::from(crate::failure::SURROUNDINGS));
    }
}
