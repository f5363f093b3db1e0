//! Plays on one scale: who played which level of which game, and how often the player won.

/// The kind of ability that an examinee shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dimension {
    /// Programs that search with the forward model.
    Planner,
    /// Players that read a prompt: language models, and programs that see nothing else.
    Reader,
}

/// An examinee: a player that takes part in a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examinee {
    /// Its dimension.
    pub dimension: Dimension,
    /// The family of a planner, a number: planners of one family find the same games hard. Not used for readers.
    pub family: usize,
}

/// The plays of one examinee on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plays {
    /// The index of the examinee.
    pub examinee: usize,
    /// The index of the level in its game.
    pub level: usize,
    /// The plays that were won.
    pub won: f64,
    /// All plays.
    pub of: f64,
}

/// All plays on a game.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GamePlays {
    /// The number of levels.
    pub levels: usize,
    /// The plays: at most one entry for each examinee and level.
    pub plays: Vec<Plays>,
}

impl GamePlays {
    /// Returns `true` if every entry has a level, an examinee below `examinees`, and no more wins than plays.
    pub(super) fn is_valid(&self, examinees: usize) -> bool {
        self.plays.iter().all(|plays| {
            plays.level < self.levels
                && plays.examinee < examinees
                && plays.of.is_finite()
                && (0.0..=plays.of).contains(&plays.won)
        })
    }
}
