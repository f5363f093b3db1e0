//! The results of examinees, which state how many episodes each examinee played and won on each level.

/// The kind of ability that an examinee has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dimension {
    /// The ability of programs that search with the forward model.
    Planner,
    /// The ability of players that read a prompt, such as language models, and programs that get no other
    /// input.
    Reader,
}

/// A player that takes part in a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examinee {
    /// The examinee's dimension.
    pub dimension: Dimension,
    /// The number of a planner's family. Planners of the same family find the same games hard. The number is
    /// not used for readers.
    pub family: usize,
}

/// The results of one examinee on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plays {
    /// The index of the examinee in the calibration.
    pub examinee: usize,
    /// The index of the level in the game.
    pub level: usize,
    /// The number of won episodes.
    pub won: f64,
    /// The number of episodes played.
    pub of: f64,
}

/// The results of all examinees on one game.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GamePlays {
    /// The number of levels in the game.
    pub levels: usize,
    /// The results of the examinees, with at most one entry for each examinee and level.
    pub plays: Vec<Plays>,
}

impl GamePlays {
    /// Returns `true` if every entry refers to an existing level and to an examinee below `examinees`, and
    /// has no more wins than episodes.
    pub(super) fn is_valid(&self, examinees: usize) -> bool {
        self.plays.iter().all(|plays| {
            plays.level < self.levels
                && plays.examinee < examinees
                && plays.of.is_finite()
                && (0.0..=plays.of).contains(&plays.won)
        })
    }
}
