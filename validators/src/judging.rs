//! Requests to a panel of judges.

use crate::report::{Judgement, Report};
use agents::Stopped;
use base::SeedPath;
use engine::{Episode, Game, Level};

/// A subject for a [`Panel`](crate::Panel), with the settings for judging it.
pub struct Judging<'a, S> {
    /// The subject to judge.
    pub subject: S,
    /// The source of all of the judges' randomness.
    pub seed: SeedPath,
    /// `true` to stop after the first unmet criterion, without explaining failures. Used for minting, which judges
    /// many candidates.
    pub stop_at_first: bool,
    /// The receiver of each judgement on the level, or on the game as a whole.
    pub observer: Option<Observer<'a>>,
}

/// A receiver of judgements, which can cancel the judging.
pub struct Observer<'a> {
    /// Receives each judgement as soon as it is made, and again if it changes later. The judging ends if the receiver
    /// returns `false`.
    pub hear: &'a mut (dyn FnMut(&Judgement) -> bool + 'a),
    /// Cancels the judging, which ends soon after this function returns `true`. The last judgement is then
    /// meaningless, and is not passed to `hear`.
    pub stopped: Stopped<'a>,
}

/// A level to judge.
pub struct LevelSubject<'a> {
    /// The level's game.
    pub game: &'a Game,
    /// The level to judge.
    pub level: &'a Level,
    /// A known win. The criterion `winnable` searches for a win even if one is known.
    pub witness: Option<Episode>,
}

/// A game with its levels.
pub struct GameSubject<'a> {
    /// The game to judge.
    pub game: &'a Game,
    /// The game's levels, in the game's order.
    pub levels: &'a [Level],
}

/// A game to be judged as a whole, after each level has been judged alone.
pub struct TogetherSubject<'a> {
    /// The game to judge.
    pub game: &'a Game,
    /// The game's levels, in the game's order.
    pub levels: &'a [Level],
    /// The findings about each level.
    pub reports: &'a [Report],
}

impl<'a> Judging<'_, LevelSubject<'a>> {
    /// Creates a request to judge a level by the level criteria.
    pub fn level(game: &'a Game, level: &'a Level, seed: impl Into<SeedPath>) -> Self {
        Judging::of(LevelSubject { game, level, witness: None }, seed)
    }

    /// Adds a known win of the level.
    #[must_use]
    pub fn won_by(mut self, witness: impl Into<Option<Episode>>) -> Self {
        self.subject.witness = witness.into();
        self
    }
}

impl<'a> Judging<'_, GameSubject<'a>> {
    /// Creates a request to judge each level by the level criteria, and the game by the game criteria.
    pub fn game(game: &'a Game, levels: &'a [Level], seed: impl Into<SeedPath>) -> Self {
        Judging::of(GameSubject { game, levels }, seed)
    }
}

impl<'a> Judging<'_, TogetherSubject<'a>> {
    /// Creates a request to judge a game as a whole by the game criteria. Each level comes with its report.
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

    /// Makes the judging stop at the first unmet criterion, without explaining failures.
    #[must_use]
    pub fn until_failure(self) -> Self {
        Judging { stop_at_first: true, ..self }
    }

    /// Passes each judgement to `hear`, and ends the judging once `stopped` returns `true`.
    #[must_use]
    pub fn watched_by(
        self,
        hear: &'a mut (dyn FnMut(&Judgement) -> bool + 'a),
        stopped: Stopped<'a>,
    ) -> Self {
        Judging { observer: Some(Observer { hear, stopped }), ..self }
    }
}
