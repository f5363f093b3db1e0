//! An episode in the making that can be taken back tick by tick.

use engine::{Action, Episode, Game, Level, Seed, State};

/// Ticks between two states that are kept: taking back a tick replays at most so many.
const STRIDE: usize = 32;

/// What has been played, and the state that it led to.
pub(crate) struct History {
    episode: Episode,
    state: State,
    /// After 0, [`STRIDE`], 2 × [`STRIDE`] … ticks.
    kept: Vec<State>,
}

impl History {
    pub(crate) fn begin(game: &Game, level: &Level, seed: Seed) -> History {
        let (episode, state) = Episode::begin(game, level, seed);
        History { episode, kept: vec![state.clone()], state }
    }

    pub(crate) fn episode(&self) -> &Episode {
        &self.episode
    }

    pub(crate) fn state(&self) -> &State {
        &self.state
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

    /// Takes back the last tick; nothing at the start. The same action leads to the same state again: chance is taken back,
    /// too.
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
