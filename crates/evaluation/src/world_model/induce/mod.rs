//! The reference player for world-model examinations. It induces a game's rules from the recordings by trying changes.
//!
//! The player begins with a game in which nothing happens, except that the episode is lost if the avatar disappears. It
//! looks at the earliest deviation of an episode, and tries all classes, rules and terminations for the sprite types
//! near that deviation. It keeps the change that explains the most transitions before the first deviations. Ties are
//! broken by the fewest differences at the first deviations, and then by the fewest words. The search stops if no
//! single change is an improvement. Like any examined player, it uses only the question's content.

mod changes;
mod clues;
mod fit;
mod guess;

use super::prompt;
use super::task::{Words, WorldModelTask, candidates};
use changes::changes;
use clues::Clues;
use fit::{Deviation, Fit, Quality};
use guess::Guess;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// The maximum number of guesses to try in total.
const MAX_GUESSES: usize = 100_000;

/// Returns the text of a game that explains many of the task's recordings. Cost: at most 100,000 guesses, each of which
/// is compiled and replays some of the recordings. The result does not depend on the number of threads.
pub fn induce(task: &WorldModelTask) -> String {
    let words = task.words().unwrap_or_else(candidates);
    let avatars = prompt::players(task);
    let mut search = Search { task, words, visible: visible(task), avatars, tried: 0 };
    let mut best = search.first();
    let mut stuck = BTreeSet::new();
    while let Some((episode, deviation)) = search.earliest(&best, &stuck) {
        match search.improve(&best, episode, &deviation) {
            Some(better) => {
                best = better;
                stuck.clear();
            }
            None => drop(stuck.insert(episode)),
        }
        if search.tried >= MAX_GUESSES {
            break;
        }
    }
    best.source(task)
}

struct Search<'a> {
    task: &'a WorldModelTask,
    words: Words,
    /// The names of the types that occur in the LevelMapping, on boards or as resources.
    visible: Vec<String>,
    /// The names of the types that the player controls at the start of the levels.
    avatars: BTreeSet<String>,
    tried: usize,
}

impl<'a> Search<'a> {
    /// Returns the first guess: nothing happens, except that the episode is lost if the avatar disappears.
    fn first(&self) -> Guess {
        let task = self.task;
        let shown = shown(task);
        let health = task.recorded.first().map_or(0, |recording| recording.seen[0].health);
        let resource = |name: &String| {
            task.recorded
                .iter()
                .flat_map(|recording| &recording.seen)
                .any(|seen| seen.resources.iter().any(|(held, _)| task.names[usize::from(*held)] == *name))
        };
        let class = |name: &String| match () {
            () if self.avatars.contains(name) => {
                let health = if health > 0 { format!(" healthPoints={health}") } else { String::new() };
                format!("MovingAvatar{health}")
            }
            () if resource(name) => "Resource limit=9".to_owned(),
            () if !shown.contains(name) => "Immovable hidden=True".to_owned(),
            () => "Immovable".to_owned(),
        };
        let lost = |name: &String| format!("SpriteCounter stype={name} limit=0 win=False");
        let ends =
            self.avatars.iter().filter(|_| self.words.terminations.contains("SpriteCounter")).map(lost);
        let ends = ends.chain(["Timeout limit=2000 win=False".to_owned()]).collect();
        let types = self.visible.iter().map(|name| (name.clone(), class(name))).collect();
        Guess { types, rules: Vec::new(), ends }
    }

    /// Returns the episode with the earliest deviation, ignoring the episodes in `stuck`.
    fn earliest(&self, guess: &Guess, stuck: &BTreeSet<usize>) -> Option<(usize, Deviation<'a>)> {
        let fit = Fit::new(self.task, guess)?;
        let followed = self.task.recorded.iter().enumerate().filter(|(at, _)| !stuck.contains(at));
        let deviating = followed.filter_map(|(at, recording)| match fit.follow(recording) {
            (number, Some(deviation)) => Some((number, at, deviation)),
            _ => None,
        });
        deviating.min_by_key(|(number, at, _)| (*number, *at)).map(|(_, at, deviation)| (at, deviation))
    }

    /// Returns the best of the changed guesses that explain an episode better, if its total quality is also better.
    fn improve(&mut self, guess: &Guess, episode: usize, deviation: &Deviation<'_>) -> Option<Guess> {
        let level = self.task.recorded[episode].level;
        let columns = self.task.masked.levels[level].level.columns() as u32;
        let clues = Clues::of(self.task, &self.visible, columns, deviation);
        let is_avatar = |name: &str| self.avatars.contains(name);
        let mut changed = changes(guess, &self.words, &clues, &is_avatar);
        changed.truncate(MAX_GUESSES - self.tried);
        self.tried += changed.len();
        let (quality, before) = self.quality(guess, episode, None)?;
        let judged = changed.into_par_iter().enumerate().filter_map(|(at, guess)| {
            let (quality, _) = self.quality(&guess, episode, Some(before))?;
            Some((quality, Reverse((guess.words(), at)), guess))
        });
        let best = judged.max_by_key(|(quality, order, _)| (*quality, *order))?;
        (best.0 > quality).then_some(best.2)
    }

    /// Returns the quality of a guess over all episodes, and its quality on the given episode. Returns `None` if the
    /// guess does not compile, or does not explain that episode better than the given quality.
    fn quality(&self, guess: &Guess, episode: usize, least: Option<Quality>) -> Option<(Quality, Quality)> {
        let (fit, recorded) = (Fit::new(self.task, guess)?, &self.task.recorded);
        let own = fit.quality(&recorded[episode]);
        if least.is_some_and(|least| own <= least) {
            return None;
        }
        Some((recorded.iter().map(|recording| fit.quality(recording)).sum(), own))
    }
}

/// Returns the names of the types that occur on boards or as resources.
fn shown(task: &WorldModelTask) -> BTreeSet<String> {
    let seen = task.recorded.iter().flat_map(|recording| &recording.seen);
    let numbers: BTreeSet<u16> = seen
        .flat_map(|seen| {
            seen.board.iter().map(|entry| entry.1).chain(seen.resources.iter().map(|held| held.0))
        })
        .collect();
    numbers.into_iter().filter_map(|number| task.names.get(usize::from(number)).cloned()).collect()
}

fn visible(task: &WorldModelTask) -> Vec<String> {
    let mapped = task.masked.mapping.iter().flat_map(|line| line.split(' ').skip(2).map(str::to_owned));
    let all: BTreeSet<String> = mapped.chain(shown(task)).collect();
    all.into_iter().collect()
}
