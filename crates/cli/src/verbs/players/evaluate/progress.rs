//! An evaluation's progress on the terminal.

use super::useless;
use crate::console::Console;
use engine::Outcome;
use evaluation::Halt;
use evaluation::player::mailbox::Mailbox;
use evaluation::run::{Answers, PlayResult, Progress, Task};
use indicatif::ProgressBar;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A progress bar that counts the played and won episodes.
pub(super) struct Bar<'a> {
    pub(super) bar: ProgressBar,
    pub(super) won: AtomicU64,
    /// The number of episodes that reached the step limit.
    pub(super) limited: AtomicU64,
    /// `true` if a request has been rejected.
    pub(super) refused: AtomicBool,
    pub(super) console: &'a Console,
    pub(super) keep_going: bool,
    /// The folder with the logs.
    pub(super) logs: PathBuf,
    /// The mailbox whose episodes are waiting, or `None` if the player has no mailbox.
    pub(super) mailbox: Option<Arc<Mailbox>>,
}

impl Bar<'_> {
    /// Returns `true` if a request has been rejected.
    pub(super) fn is_refused(&self) -> bool {
        self.refused.load(Ordering::Relaxed)
    }
}

impl Progress for Bar<'_> {
    fn unusable(&self, answers: &Answers, is_all: bool) -> bool {
        self.bar.suspend(|| self.console.remark(useless(answers, &self.logs)));
        let goes_on = !is_all || self.keep_going;
        if !goes_on {
            self.bar.suspend(|| {
                self.console.remark(
                    "no answer is usable, so no more requests are sent; --resume --keep-going continues anyway",
                );
            });
        }
        goes_on
    }

    fn stopped(&self, halt: &Halt) {
        self.mailbox.iter().for_each(|mailbox| mailbox.stop(halt));
    }

    fn episode(&self, task: &Task<'_>, result: &PlayResult) {
        if *result == PlayResult::Ended(Outcome::Won) {
            self.won.fetch_add(1, Ordering::Relaxed);
        }
        if *result == PlayResult::Ended(Outcome::Ongoing) {
            self.limited.fetch_add(1, Ordering::Relaxed);
        }
        if let PlayResult::Halted(halt) = result {
            if matches!(halt, Halt::Rejected(_) | Halt::Unfit(_)) {
                self.refused.store(true, Ordering::Relaxed);
            }
            // All episodes that have begun find no server, and the evaluation's error says so once.
            if !matches!(halt, Halt::Unreachable(_)) {
                self.bar.println(format!("{}: {halt}", task.file_name()));
            }
        }
        self.bar.set_message(format!("{} won", self.won.load(Ordering::Relaxed)));
        self.bar.inc(1);
    }
}
