//! The verdicts in progress. Only a few run at a time, and newer verdicts take precedence.

use crate::lines::Lines;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The maximum number of concurrent verdicts of one kind.
const MOST: usize = 2;

/// The subject of a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// A level that is being edited.
    Level,
    /// A game with all its levels, which has lower priority.
    Game,
}

/// The running verdicts, from oldest to newest.
#[derive(Default)]
pub(crate) struct Running(Mutex<Vec<Entry>>);

struct Entry {
    work: Work,
    page: Option<String>,
    switch: Arc<AtomicBool>,
}

impl Entry {
    fn is_live(&self) -> bool {
        !self.switch.load(Ordering::Relaxed)
    }

    fn end(&self) {
        self.switch.store(true, Ordering::Relaxed);
    }
}

/// The registration of a running verdict, which ends when this value is dropped.
pub(crate) struct Place<'a> {
    running: &'a Running,
    switch: Arc<AtomicBool>,
}

impl Running {
    /// Begins a verdict. It supersedes the previous verdict of the same page and kind. If there are then too many
    /// verdicts of that kind, it also supersedes the oldest ones. A verdict on a level supersedes the same page's
    /// verdict on the whole game, too, because the game has changed or its verdict can wait.
    pub(crate) fn begin(&self, work: Work, page: Option<String>, lines: &Lines) -> Place<'_> {
        let mut entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let switch = lines.switch();
        let gives_way = |entry: &&Entry| {
            page.is_some() && entry.page == page && (entry.work == work || work == Work::Level)
        };
        entries.iter().filter(gives_way).for_each(Entry::end);
        entries.push(Entry { work, page, switch: switch.clone() });
        let live = || entries.iter().filter(|entry| entry.work == work && entry.is_live());
        let surplus = live().count().saturating_sub(MOST);
        live().take(surplus).for_each(Entry::end);
        Place { running: self, switch }
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        let mut entries = self.running.0.lock().unwrap_or_else(PoisonError::into_inner);
        entries.retain(|entry| !Arc::ptr_eq(&entry.switch, &self.switch));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_come_before_games() {
        let running = Running::default();
        let page = || Some("page".to_owned());
        let ask = || Lines::new();
        let is_ended = |lines: &Lines| lines.switch().load(Ordering::Relaxed);
        let ((game, _one), (level, _two), (other, _three)) = (ask(), ask(), ask());
        let _game = running.begin(Work::Game, page(), &game);
        let _other = running.begin(Work::Game, Some("other".to_owned()), &other);
        let _level = running.begin(Work::Level, page(), &level);
        assert_eq!([&game, &level, &other].map(is_ended), [true, false, false]);
        // A verdict on a game does not end the verdict on a level, and a page has only one verdict on a game at a time.
        let ((again, _four), (newest, _five)) = (ask(), ask());
        let _again = running.begin(Work::Game, page(), &again);
        let _newest = running.begin(Work::Game, page(), &newest);
        assert_eq!([&level, &again, &newest, &other].map(is_ended), [false, true, false, false]);
        // Among the verdicts of other pages, the oldest is ended.
        let (last, _six) = ask();
        let _last = running.begin(Work::Game, None, &last);
        assert_eq!([&other, &newest, &last, &level].map(is_ended), [true, false, false, false]);
    }
}
