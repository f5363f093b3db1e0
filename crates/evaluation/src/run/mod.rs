//! Entire evaluations, stored as results folders that contain settings, games and all episode logs.

pub(crate) mod clock;
mod episode;
mod evaluation;
mod series;
mod settings;
pub(crate) mod text;
mod unusable;

pub(crate) use episode::{available, graded};

pub use episode::{PlayResult, Task, play};
pub use evaluation::{Evaluation, Progress, StoppedEpisodes, Tally, tasks};
pub use series::play_together;
pub use settings::{
    Adaptive, Entrant, FORMAT, LevelEntry, MAX_DECISIONS, MAX_EPISODES, SETTINGS_FILE, Settings, SubjectEntry,
};
pub use unusable::Answers;
