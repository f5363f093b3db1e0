//! Progress of a mint: a bar on a terminal, elsewhere a line for each tenth of the jobs.

use crate::console::{Console, Stopwatch};
use indicatif::ProgressBar;
use snapshots::FrozenGame;
use snapshots::mint::Progress;
use std::sync::Mutex;

pub(crate) struct ProgressBars<'a> {
    bar: ProgressBar,
    console: &'a Console,
    started: Stopwatch,
    last_report: Mutex<LastReport>,
}

/// The progress last reported where there is no bar.
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

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for ProgressBars<'_> {
    fn begin(&self, jobs: usize, made: usize) {
        self.bar.set_length(jobs as u64);
        self.bar.set_position(made as u64);
        // Jobs finished earlier say nothing about the time of the rest.
        self.bar.reset_eta();
        if let Ok(mut last_report) = self.last_report.lock() {
            *last_report = LastReport { jobs: jobs as u64, found: made as u64, ..LastReport::default() };
        }
        if made > 0 {
            self.console.remark(format_args!("{made} of {jobs} jobs were finished before"));
        }
    }

    fn made(&self, name: &str, games: &[FrozenGame]) {
        let titles: Vec<&str> = games.iter().map(|game| game.card.title.as_str()).collect();
        let what = if titles.is_empty() { "nothing passed".to_owned() } else { titles.join(", ") };
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
