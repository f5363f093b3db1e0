//! How large and how hard levels are to be.

/// What a level generator is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelConfig {
    /// Columns, from and to, both included; the border counts.
    pub columns: (usize, usize),
    /// Rows, from and to, both included; the border counts.
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
            if low < 4 || low > high || high > engine::MAX_SIDE {
                let most = engine::MAX_SIDE;
                return Some(format!(
                    "{name} from {low} to {high} asked; both lie between 4 and {most}, in order"
                ));
            }
        }
        if !(0.0..=1.0).contains(&self.difficulty) {
            return Some(format!("difficulty {} asked; it lies between 0 and 1", self.difficulty));
        }
        None
    }
}
