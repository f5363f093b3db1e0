//! The results of examinees (reference players that never change): the numbers of episodes that each examinee played
//! and won on each level.

/// A dimension of ability.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dimension {
    /// The ability of programs that search with the forward model.
    Planner,
    /// The ability of players that read a prompt: language models, and programs whose only input is a prompt.
    Reader,
}

/// An examinee: a reference player that never changes, and whose results calibrate the scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examinee {
    /// The examinee's dimension.
    pub dimension: Dimension,
    /// The index of a planner's family. Planners of the same family find the same games hard. The index is unused for
    /// players that see only prompts.
    pub family: usize,
}

/// The results of one examinee (a reference player) on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plays {
    /// The index of the reference player in the calibration.
    pub examinee: usize,
    /// The level's index in the game.
    pub level: usize,
    /// The number of won episodes.
    pub won: f64,
    /// The number of episodes played.
    pub of: f64,
}

/// The results of all examinees (reference players that never change) on one game.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GamePlays {
    /// The number of levels in the game.
    pub levels: usize,
    /// The results, with at most one entry per examinee (reference player) and level.
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
