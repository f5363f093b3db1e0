//! Progress of a mint: a bar on a terminal, a line now and then elsewhere.

use crate::console::{Console, Stopwatch};
use indicatif::ProgressBar;
use snapshots::mint::{FrozenGame, Progress};
use std::sync::Mutex;

/// Receives the progress of the jobs.
pub(crate) struct Bars<'a> {
    bar: ProgressBar,
    console: &'a Console,
    started: Stopwatch,
    said: Mutex<Said>,
}

/// The progress last reported where there is no bar.
#[derive(Default)]
struct Said {
    lots: u64,
    found: u64,
    made: u64,
    tenths: u64,
}

impl<'a> Bars<'a> {
    pub(crate) fn new(console: &'a Console) -> Bars<'a> {
        let bar = console.progress(0, "minting");
        Bars { bar, console, started: Stopwatch::start(), said: Mutex::default() }
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bars<'_> {
    fn begin(&self, lots: usize, made: usize) {
        self.bar.set_length(lots as u64);
        self.bar.set_position(made as u64);
        // Jobs finished earlier say nothing about the time of the rest.
        self.bar.reset_eta();
        if let Ok(mut said) = self.said.lock() {
            *said = Said { lots: lots as u64, found: made as u64, ..Said::default() };
        }
        if made > 0 {
            self.console.remark(format_args!("{made} of {lots} jobs were finished before"));
        }
    }

    fn made(&self, name: &str, games: &[FrozenGame]) {
        let titles: Vec<&str> = games.iter().map(|game| game.card.title.as_str()).collect();
        let what = if titles.is_empty() { "nothing passed".to_owned() } else { titles.join(", ") };
        self.bar.set_message(format!("{name}: {what}"));
        self.bar.inc(1);
        let Ok(mut said) = self.said.lock() else { return };
        said.made += 1;
        let open = said.lots - said.found;
        let tenths = 10 * said.made / open.max(1);
        // A few jobs are soon done.
        if self.bar.is_hidden() && open >= 20 && tenths > said.tenths {
            said.tenths = tenths;
            let left = self.started.seconds() / said.made as f64 * (open - said.made) as f64;
            let done = said.found + said.made;
            self.console.remark(format_args!("{done} of {} jobs; about {:.0} s left", said.lots, left));
        }
    }
}
