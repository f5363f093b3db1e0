//! How large and how hard levels are to be.

use super::examples::Examples;
use engine::SpriteType;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Columns and rows at least: below, a border leaves no room.
const LEAST: usize = 4;
/// Columns and rows at most: the cost of a level grows with the square of its cells.
const MOST: usize = 64;

/// What a level generator is asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelConfig {
    /// Columns, from and to, both included; the border counts. Between 4 and 64.
    pub columns: (usize, usize),
    /// Rows, from and to, both included; the border counts. Between 4 and 64.
    pub rows: (usize, usize),
    /// From 0.0, the easiest, to 1.0, the hardest: more that harms, longer ways, fewer helps.
    pub difficulty: f64,
    /// The share of cells with more than floor, from and to, from 0.0 to 1.0: met where the rules leave room for it.
    pub cover: Option<(f64, f64)>,
    /// So many sprites of a type, neither more nor fewer, where there is room for them.
    #[serde(skip)]
    pub counts: Vec<(SpriteType, usize)>,
    /// Levels that new ones are to be like.
    #[serde(skip)]
    pub like: Option<Arc<Examples>>,
}

impl Default for LevelConfig {
    fn default() -> LevelConfig {
        LevelConfig {
            columns: (10, 18),
            rows: (8, 11),
            difficulty: 0.5,
            cover: None,
            counts: Vec::new(),
            like: None,
        }
    }
}

impl LevelConfig {
    /// Levels like these: of their size and cover, with as many of each type, in such places, between such walls.
    pub fn like(examples: Arc<Examples>) -> LevelConfig {
        let side = |(low, high): (usize, usize)| (low.clamp(LEAST, MOST), high.clamp(LEAST, MOST));
        LevelConfig {
            columns: side(examples.columns()),
            rows: side(examples.rows()),
            cover: Some(examples.cover()),
            like: Some(examples),
            ..LevelConfig::default()
        }
    }

    /// What is wrong with it, if anything is.
    pub(crate) fn problem(&self) -> Option<String> {
        for (name, (low, high)) in [("columns", self.columns), ("rows", self.rows)] {
            if low < LEAST || low > high || high > MOST {
                return Some(format!(
                    "{name} from {low} to {high} asked; both lie between {LEAST} and {MOST}, in order"
                ));
            }
        }
        if !(0.0..=1.0).contains(&self.difficulty) {
            return Some(format!("difficulty {} asked; it lies between 0 and 1", self.difficulty));
        }
        if let Some((low, high)) = self.cover
            && !(0.0 <= low && low <= high && high <= 1.0)
        {
            return Some(format!("cover from {low} to {high} asked; both lie between 0 and 1, in order"));
        }
        None
    }
}
