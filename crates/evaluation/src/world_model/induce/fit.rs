//! Compares a guess with the recordings.

use super::guess::Guess;
use crate::world_model::recording::Recording;
use crate::world_model::seen::{Seen, Viewer};
use crate::world_model::task::WorldModelTask;
use engine::{Game, Level};
use std::cmp::Reverse;
use std::iter::Sum;

/// A guess that compiles, ready to be compared with the recordings.
pub(super) struct Fit {
    viewer: Viewer,
    levels: Vec<Level>,
}

/// The quality of a guess. Better guesses compare as greater.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Quality {
    /// The total number of transitions before each episode's first deviation.
    explained: usize,
    /// The number of differences at the first deviations. Several sprites may begin to move in the same step, and a
    /// change that explains only one of them is still progress.
    wrong: Reverse<usize>,
}

impl Sum for Quality {
    fn sum<I: Iterator<Item = Quality>>(all: I) -> Quality {
        all.fold(Quality::default(), |sum, one| Quality {
            explained: sum.explained + one.explained,
            wrong: Reverse(sum.wrong.0 + one.wrong.0),
        })
    }
}

/// An episode's first transition that a guess does not reproduce.
#[derive(Clone, Debug)]
pub(super) struct Deviation<'a> {
    pub(super) before: &'a Seen,
    pub(super) after: &'a Seen,
    /// The observation that the guess yields instead of `after`.
    pub(super) guessed: Seen,
}

impl Deviation<'_> {
    /// Returns the number of differences between the guess and the recording.
    fn size(&self) -> usize {
        let (one, other) = (&self.guessed, self.after);
        let facts = [
            one.score != other.score,
            one.resources != other.resources,
            one.health != other.health,
            one.outcome != other.outcome,
        ];
        difference(&one.board, &other.board).len() + facts.into_iter().filter(|differs| *differs).count()
    }
}

/// Returns the entries that are on only one of two boards.
pub(super) fn difference(one: &Board, other: &Board) -> Vec<(u32, u16)> {
    let missing = |from: &Board, entry: &(u32, u16)| from.binary_search(entry).is_err();
    let first = one.iter().filter(|entry| missing(other, entry));
    first.chain(other.iter().filter(|entry| missing(one, entry))).copied().collect()
}

type Board = [(u32, u16)];

impl Fit {
    /// Compiles a guess. Returns `None` for guesses that do not compile.
    pub(super) fn new(task: &WorldModelTask, guess: &Guess) -> Option<Fit> {
        let game = Game::from_source(&guess.source(task)).ok()?;
        let levels = task.masked.levels.iter().map(|masked| game.level(&masked.text).ok());
        let levels = levels.collect::<Option<_>>()?;
        Some(Fit { viewer: Viewer::new(&game, &task.names), levels })
    }

    /// Returns the quality of the guess on an episode.
    pub(super) fn quality(&self, recording: &Recording) -> Quality {
        let (explained, deviation) = self.follow(recording);
        Quality { explained, wrong: Reverse(deviation.map_or(0, |deviation| deviation.size())) }
    }

    /// Returns the number of transitions of an episode before the first deviation, and the deviation if there is one.
    pub(super) fn follow<'a>(&self, recording: &'a Recording) -> (usize, Option<Deviation<'a>>) {
        let mut deviation = None;
        recording.replay(&self.viewer, &self.levels[recording.level], |number, seen| {
            let after = &recording.seen[number + 1];
            if seen != after {
                let before = &recording.seen[number];
                deviation = Some((number, Deviation { before, after, guessed: seen.clone() }));
            }
            deviation.is_none()
        });
        match deviation {
            Some((number, deviation)) => (number, Some(deviation)),
            None => (recording.actions.len(), None),
        }
    }
}
