//! A mint's progress, shown as a bar on a terminal, or otherwise as one line per tenth of the jobs.

use super::cost::{LONG, forecast, words as forecast_words};
use crate::console::{Console, Stopwatch};
use crate::interrupt;
use indicatif::ProgressBar;
use snapshots::mint::{Job, Plan, Progress, Remark};
use snapshots::{Corpus, FrozenGame};
use std::sync::{Mutex, OnceLock};

pub(crate) struct ProgressBars<'a> {
    bar: ProgressBar,
    console: &'a Console,
    started: Stopwatch,
    last_report: Mutex<LastReport>,
}

/// The most recently reported progress, for output without a bar.
#[derive(Default)]
struct LastReport {
    jobs: u64,
    found: u64,
    made: u64,
    tenths: u64,
}

impl<'a> ProgressBars<'a> {
    pub(crate) fn new(console: &'a Console) -> ProgressBars<'a> {
        let bar = console.progress(0, "minting");
        ProgressBars { bar, console, started: Stopwatch::start(), last_report: Mutex::default() }
    }

    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for ProgressBars<'_> {
    fn begin(&self, jobs: usize, made: usize) {
        self.bar.set_length(jobs as u64);
        self.bar.set_position(made as u64);
        // Jobs finished in an earlier run say nothing about the time for the remaining jobs.
        self.bar.reset_eta();
        if let Ok(mut last_report) = self.last_report.lock() {
            *last_report = LastReport { jobs: jobs as u64, found: made as u64, ..LastReport::default() };
        }
        if made > 0 {
            self.console.remark(format_args!("{made} of {jobs} jobs were already finished"));
        }
    }

    fn made(&self, name: &str, games: &[FrozenGame]) {
        let titles: Vec<&str> = games.iter().map(|game| game.card.title.as_str()).collect();
        let what = if titles.is_empty() { "no candidate passed".to_owned() } else { titles.join(", ") };
        self.bar.set_message(format!("{name}: {what}"));
        self.bar.inc(1);
        let Ok(mut last_report) = self.last_report.lock() else { return };
        last_report.made += 1;
        let open = last_report.jobs - last_report.found;
        let tenths = 10 * last_report.made / open.max(1);
        if self.bar.is_hidden() && tenths > last_report.tenths {
            last_report.tenths = tenths;
            let left = self.started.seconds() / last_report.made as f64 * (open - last_report.made) as f64;
            let done = last_report.found + last_report.made;
            self.console
                .remark(format_args!("{done} of {} jobs; about {:.0} s left", last_report.jobs, left));
        }
    }
}

/// A reporter that prints only a mint's notes.
pub(crate) struct Remarks<'a>(pub(crate) &'a Console);

impl Progress for Remarks<'_> {
    fn remark(&self, remark: &Remark) {
        self.0.remark(format_args!("note: {remark}"));
    }
}

/// A reporter for a mint. Prints notes and the command that resumes the mint, and shows bars.
pub(crate) struct Reporter<'a> {
    console: &'a Console,
    corpus: &'a Corpus,
    /// The command that resumes the mint.
    resumed: &'a str,
    /// The progress bars. Empty until the jobs have started.
    bars: OnceLock<ProgressBars<'a>>,
}

impl<'a> Reporter<'a> {
    pub(crate) fn new(console: &'a Console, corpus: &'a Corpus, resumed: &'a str) -> Reporter<'a> {
        Reporter { console, corpus, resumed, bars: OnceLock::new() }
    }

    /// Returns the seconds since the jobs started, or `None` if they have not started.
    pub(crate) fn seconds(&self) -> Option<f64> {
        self.bars.get().map(|bars| bars.started.seconds())
    }
}

impl Progress for Reporter<'_> {
    fn remark(&self, remark: &Remark) {
        Remarks(self.console).remark(remark);
    }

    fn start(&self, plan: &Plan<'_>, left: &[Job]) {
        let (cost, _) = forecast(plan, left, self.corpus);
        if cost.median >= LONG {
            self.console.remark(format_args!("if interrupted, continue with: {}", self.resumed));
        }
        self.console.remark(format_args!("minting takes {}", forecast_words(cost)));
        interrupt::watch(|| (), format!("interrupted; continue with: {}", self.resumed));
        self.bars.get_or_init(|| ProgressBars::new(self.console));
    }

    fn begin(&self, jobs: usize, made: usize) {
        self.bars.get().inspect(|bars| bars.begin(jobs, made));
    }

    fn made(&self, name: &str, games: &[FrozenGame]) {
        self.bars.get().inspect(|bars| bars.made(name, games));
    }

    fn finish(&self) {
        self.bars.get().inspect(|bars| bars.clear());
        interrupt::defer();
    }
}
