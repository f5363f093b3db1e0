//! Results of examinees: who played which level of which game, and how many episodes the player won.

/// The kind of ability that an examinee has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dimension {
    /// Programs that search with the forward model.
    Planner,
    /// Players that read a prompt: language models, and programs that get no other input.
    Reader,
}

/// A player that takes part in a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examinee {
    /// The examinee's dimension.
    pub dimension: Dimension,
    /// The number of a planner's family. Planners of one family find the same games hard. Not used for readers.
    pub family: usize,
}

/// The results of one examinee on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plays {
    /// The index of the examinee.
    pub examinee: usize,
    /// The index of the level in the game.
    pub level: usize,
    /// The number of episodes won.
    pub won: f64,
    /// The number of episodes.
    pub of: f64,
}

/// The results of all examinees on one game.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GamePlays {
    /// The number of levels.
    pub levels: usize,
    /// The results, with at most one entry for each examinee and level.
    pub plays: Vec<Plays>,
}

impl GamePlays {
    /// Returns `true` if every entry has an existing level, an examinee below `examinees`, and at most as many wins
    /// as episodes.
    pub(super) fn is_valid(&self, examinees: usize) -> bool {
        self.plays.iter().all(|plays| {
            plays.level < self.levels
                && plays.examinee < examinees
                && plays.of.is_finite()
                && (0.0..=plays.of).contains(&plays.won)
        })
    }
}
