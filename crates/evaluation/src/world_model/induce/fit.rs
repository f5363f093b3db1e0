//! Compares a guess with the recordings.

use super::guess::Guess;
use crate::world_model::recording::Recording;
use crate::world_model::seen::{Seen, Viewer};
use crate::world_model::task::WorldModelTask;
use engine::{Game, Level};

/// A guess that compiles, ready to be compared with the recordings.
pub(super) struct Fit {
    viewer: Viewer,
    levels: Vec<Level>,
}

/// The first transition of an episode that a guess does not reproduce.
#[derive(Clone, Debug)]
pub(super) struct Deviation<'a> {
    pub(super) before: &'a Seen,
    pub(super) after: &'a Seen,
    /// The observation that the guess yields instead of `after`.
    pub(super) guessed: Seen,
}

impl Fit {
    /// Compiles a guess. Returns `None` for guesses that do not compile.
    pub(super) fn new(task: &WorldModelTask, guess: &Guess) -> Option<Fit> {
        let game = Game::from_source(&guess.source(task)).ok()?;
        let levels = task.masked.levels.iter().map(|masked| game.level(&masked.text).ok());
        let levels = levels.collect::<Option<_>>()?;
        Some(Fit { viewer: Viewer::new(&game, &task.names), levels })
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
