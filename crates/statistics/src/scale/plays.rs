//! The results of examinees: the numbers of episodes that each examinee played and won on each level.

/// A dimension of ability.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dimension {
    /// The ability of programs that search with the forward model.
    Planner,
    /// The ability of players that read a prompt: language models, and programs whose only input is a prompt.
    Reader,
}

/// A participant in a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examinee {
    /// The examinee's dimension.
    pub dimension: Dimension,
    /// The index of a planner's family. Planners of the same family find the same games hard. The index is unused for
    /// readers.
    pub family: usize,
}

/// One examinee's results on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plays {
    /// The examinee's index in the calibration.
    pub examinee: usize,
    /// The level's index in the game.
    pub level: usize,
    /// The number of won episodes.
    pub won: f64,
    /// The number of episodes played.
    pub of: f64,
}

/// All examinees' results on one game.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GamePlays {
    /// The number of levels in the game.
    pub levels: usize,
    /// The examinees' results, with at most one entry per examinee and level.
    pub plays: Vec<Plays>,
}

impl GamePlays {
    /// Returns `true` if every entry refers to an existing level and to an examinee with an index below `examinees`,
    /// and has no more wins than episodes.
    pub(super) fn is_valid(&self, examinees: usize) -> bool {
        self.plays.iter().all(|plays| {
            plays.level < self.levels
                && plays.examinee < examinees
                && plays.of.is_finite()
                && (0.0..=plays.of).contains(&plays.won)
        })
    }
}
