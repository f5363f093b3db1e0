//! An episode in progress, in which single ticks can be undone.

use base::Seed;
use engine::{Action, Episode, Game, Level, State};

/// The number of ticks between two stored states, and thus the maximum number of ticks that an undo replays.
const STRIDE: usize = 32;

/// The actions played so far, and the resulting state.
pub(crate) struct History {
    pub(super) episode: Episode,
    pub(super) state: State,
    /// The states after 0, [`STRIDE`], 2 × [`STRIDE`], … ticks.
    kept: Vec<State>,
}

impl History {
    pub(crate) fn begin(game: &Game, level: &Level, seed: Seed) -> History {
        let (episode, state) = Episode::begin(game, level, seed);
        History { episode, kept: vec![state.clone()], state }
    }

    pub(crate) fn ticks(&self) -> usize {
        self.episode.actions.len()
    }

    pub(crate) fn play(&mut self, game: &Game, action: Action) {
        self.episode.play(game, &mut self.state, action);
        if self.ticks().is_multiple_of(STRIDE) {
            self.kept.push(self.state.clone());
        }
    }

    /// Undoes the last tick. Does nothing at the start. The random state is restored as well, so the same
    /// action leads to the same state again.
    pub(crate) fn take_back(&mut self, game: &Game) {
        let Some(ticks) = self.ticks().checked_sub(1) else { return };
        self.kept.truncate(ticks / STRIDE + 1);
        self.state = self.kept.last().expect("the start is kept").clone();
        for &action in &self.episode.actions[ticks / STRIDE * STRIDE..ticks] {
            game.step(&mut self.state, action);
        }
        self.episode.actions.truncate(ticks);
        self.episode.hashes.truncate(ticks);
        (self.episode.outcome, self.episode.score) = (self.state.outcome(), self.state.score());
    }
}
