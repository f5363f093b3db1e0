//! The verdicts that are being worked out: few at a time, and the newest first.

use crate::lines::Lines;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The most verdicts at a time.
const MOST: usize = 2;

/// The running verdicts, the oldest first.
#[derive(Default)]
pub(crate) struct Running(Mutex<Vec<Entry>>);

struct Entry {
    page: Option<String>,
    switch: Arc<AtomicBool>,
}

/// A running verdict; it ends when this is dropped.
pub(crate) struct Place<'a> {
    running: &'a Running,
    switch: Arc<AtomicBool>,
}

impl Running {
    /// Begins a verdict. It supersedes the one of the same page, and the oldest if there are too many.
    pub(crate) fn begin(&self, page: Option<String>, lines: &Lines) -> Place<'_> {
        let mut entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let switch = lines.switch();
        for entry in entries.iter().filter(|entry| page.is_some() && entry.page == page) {
            entry.switch.store(true, Ordering::Relaxed);
        }
        entries.push(Entry { page, switch: switch.clone() });
        let live = entries.iter().filter(|entry| !entry.switch.load(Ordering::Relaxed)).count();
        for entry in entries
            .iter()
            .filter(|entry| !entry.switch.load(Ordering::Relaxed))
            .take(live.saturating_sub(MOST))
        {
            entry.switch.store(true, Ordering::Relaxed);
        }
        Place { running: self, switch }
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        let mut entries = self.running.0.lock().unwrap_or_else(PoisonError::into_inner);
        entries.retain(|entry| !Arc::ptr_eq(&entry.switch, &self.switch));
    }
}
