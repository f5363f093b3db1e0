//! The question to a panel.

use crate::report::{Judgement, Report};
use agents::Stopped;
use base::SeedPath;
use engine::{Episode, Game, Level};

/// A subject for a [`Panel`](crate::Panel), and the manner of judging it.
pub struct Judging<'a, S> {
    /// The subject.
    pub subject: S,
    /// The source of all randomness of the judges.
    pub seed: SeedPath,
    /// Stops after the first criterion that is not met, and explains no failure: for minting, where candidates are many.
    pub stop_at_first: bool,
    /// Receives each judgement on the level, or on the game over all its levels.
    pub observer: Option<Observer<'a>>,
}

/// Receives judgements, and can cancel the judging.
pub struct Observer<'a> {
    /// Receives each judgement when it is made, and once more if it changes later. The judging ends if it returns `false`.
    pub hear: &'a mut (dyn FnMut(&Judgement) -> bool + 'a),
    /// Cancels the judging: once it returns `true`, the judging ends soon. The last judgement is then meaningless, and `hear` does
    /// not receive it.
    pub stopped: Stopped<'a>,
}

/// A level.
pub struct LevelSubject<'a> {
    /// The game.
    pub game: &'a Game,
    /// The level.
    pub level: &'a Level,
    /// A win that is known; the criterion `winnable` searches for one regardless.
    pub witness: Option<Episode>,
}

/// A game with its levels.
pub struct GameSubject<'a> {
    /// The game.
    pub game: &'a Game,
    /// Its levels, in order.
    pub levels: &'a [Level],
}

/// A game over all its levels, each of which was judged alone.
pub struct TogetherSubject<'a> {
    /// The game.
    pub game: &'a Game,
    /// Its levels, in order.
    pub levels: &'a [Level],
    /// The findings on each of them.
    pub reports: &'a [Report],
}

impl<'a> Judging<'_, LevelSubject<'a>> {
    /// Judges a level by the criteria of levels.
    pub fn level(game: &'a Game, level: &'a Level, seed: impl Into<SeedPath>) -> Self {
        Judging::of(LevelSubject { game, level, witness: None }, seed)
    }

    /// Gives the judges a win of the level.
    #[must_use]
    pub fn won_by(mut self, witness: impl Into<Option<Episode>>) -> Self {
        self.subject.witness = witness.into();
        self
    }
}

impl<'a> Judging<'_, GameSubject<'a>> {
    /// Judges each level by the criteria of levels, and the game by those of games.
    pub fn game(game: &'a Game, levels: &'a [Level], seed: impl Into<SeedPath>) -> Self {
        Judging::of(GameSubject { game, levels }, seed)
    }
}

impl<'a> Judging<'_, TogetherSubject<'a>> {
    /// Judges a game over all its levels by the criteria of games. Each level has its report.
    pub fn together(
        game: &'a Game,
        levels: &'a [Level],
        reports: &'a [Report],
        seed: impl Into<SeedPath>,
    ) -> Self {
        Judging::of(TogetherSubject { game, levels, reports }, seed)
    }
}

impl<'a, S> Judging<'a, S> {
    fn of(subject: S, seed: impl Into<SeedPath>) -> Self {
        Judging { subject, seed: seed.into(), stop_at_first: false, observer: None }
    }

    /// Stops after the first criterion that is not met.
    #[must_use]
    pub fn until_failure(self) -> Self {
        Judging { stop_at_first: true, ..self }
    }

    /// Streams the judgements to `hear` until `stopped` cancels the judging.
    #[must_use]
    pub fn watched_by(
        self,
        hear: &'a mut (dyn FnMut(&Judgement) -> bool + 'a),
        stopped: Stopped<'a>,
    ) -> Self {
        Judging { observer: Some(Observer { hear, stopped }), ..self }
    }
}
