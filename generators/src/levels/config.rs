//! The configuration of level generators: size, difficulty and contents.

use super::examples::Examples;
use engine::SpriteType;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The minimum number of columns and rows. Smaller boards have no room inside the border.
const MIN_SIDE: usize = 4;
/// The maximum number of columns and rows. The cost of generating a level grows with the square of its number of cells.
const MAX_SIDE: usize = 64;

base::with_defaults! {
    /// The configuration of a level generator.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct LevelConfig {
        /// The minimum and maximum number of columns, including the border, from 4 to 64.
        pub columns: (usize, usize) = (10, 18),
        /// The minimum and maximum number of rows, including the border, from 4 to 64.
        pub rows: (usize, usize) = (8, 11),
        /// The difficulty, from 0.0 (easiest) to 1.0 (hardest). Harder levels have more dangers, longer paths and fewer
        /// aids.
        pub difficulty: f64 = 0.5,
        /// The minimum and maximum fraction of cells that contain more than floor, from 0.0 to 1.0. The limits are met
        /// only as far as there is space for sprites.
        pub cover: Option<(f64, f64)> = None,
        /// The exact numbers of sprites for some types, as far as there is room.
        #[serde(skip)]
        pub counts: Vec<(SpriteType, usize)> = Vec::new(),
        /// The examples that new levels should resemble.
        #[serde(skip)]
        pub like: Option<Arc<Examples>> = None,
    }
}

impl LevelConfig {
    /// Returns a configuration for levels that resemble the examples in size, cover, the number of each type, placement
    /// and walls.
    pub fn like(examples: Arc<Examples>) -> LevelConfig {
        let side =
            |(low, high): (usize, usize)| (low.clamp(MIN_SIDE, MAX_SIDE), high.clamp(MIN_SIDE, MAX_SIDE));
        LevelConfig {
            columns: side(examples.columns()),
            rows: side(examples.rows()),
            cover: Some(examples.cover()),
            like: Some(examples),
            ..LevelConfig::default()
        }
    }

    /// Describes the first problem with the configuration; `None` if the configuration is valid.
    pub(crate) fn problem(&self) -> Option<String> {
        for (name, (low, high)) in [("columns", self.columns), ("rows", self.rows)] {
            if low < MIN_SIDE || low > high || high > MAX_SIDE {
                return Some(format!(
                    "{name} from {low} to {high}: both must be between {MIN_SIDE} and {MAX_SIDE}, in ascending order"
                ));
            }
        }
        if !(0.0..=1.0).contains(&self.difficulty) {
            return Some(format!("difficulty {}: it must be between 0 and 1", self.difficulty));
        }
        if let Some((low, high)) = self.cover
            && !(0.0 <= low && low <= high && high <= 1.0)
        {
            return Some(format!(
                "cover from {low} to {high}: both must be between 0 and 1, in ascending order"
            ));
        }
        None
    }
}
