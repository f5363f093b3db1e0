//! How large and how hard levels are to be.

use serde::{Deserialize, Serialize};

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
}

impl Default for LevelConfig {
    fn default() -> LevelConfig {
        LevelConfig { columns: (10, 18), rows: (8, 11), difficulty: 0.5 }
    }
}

impl LevelConfig {
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
        None
    }
}
