//! The table: a row for each game, and one for the total.

use super::Made;
use super::judged::{Found, Judged};
use engine::Digest;
use std::collections::BTreeSet;
use std::fmt;

/// The counts over the levels of a game.
#[derive(Clone, Default)]
pub(super) struct Row {
    name: String,
    levels: usize,
    made: usize,
    won: usize,
    impossible: usize,
    unknown: usize,
    hard: usize,
    whole: usize,
    size: usize,
    cover: usize,
    same: usize,
    /// The maximum for one level.
    milliseconds: f64,
    /// The things that were missing or went wrong.
    notes: BTreeSet<String>,
}

impl Row {
    /// The columns of a row; percentages except the time and the number of duplicates.
    pub(super) const HEAD: &str = "game               levels  made   won impossible unknown  hard whole  size cover    ms same  missing";

    pub(super) fn of(name: &str, made: &[Made], judged: &[Judged], known: &[Digest]) -> Row {
        let count = |test: &dyn Fn(&Judged) -> bool| judged.iter().filter(|judged| test(judged)).count();
        let mut seen: BTreeSet<Digest> = known.iter().copied().collect();
        let fresh = judged.iter().filter_map(|judged| judged.form).filter(|form| seen.insert(*form));
        let made_count = count(&|judged| judged.made);
        Row {
            name: name.to_owned(),
            levels: made.len(),
            made: made_count,
            won: count(&|judged| judged.found == Found::Won),
            impossible: count(&|judged| judged.found == Found::Impossible),
            unknown: count(&|judged| judged.found == Found::Unknown),
            hard: count(&Judged::is_hard),
            whole: count(&|judged| judged.made && judged.missing.is_empty()),
            size: count(&|judged| judged.fits_size),
            cover: count(&|judged| judged.fits_cover),
            same: made_count - fresh.count(),
            milliseconds: made.iter().map(|made| made.milliseconds).fold(0.0, f64::max),
            notes: judged.iter().flat_map(|judged| judged.missing.iter().cloned()).collect(),
        }
    }

    /// The sum of all rows.
    pub(super) fn together(rows: &[Row]) -> Row {
        let sum = |of: &dyn Fn(&Row) -> usize| rows.iter().map(of).sum();
        Row {
            name: format!("{} games", rows.len()),
            levels: sum(&|row| row.levels),
            made: sum(&|row| row.made),
            won: sum(&|row| row.won),
            impossible: sum(&|row| row.impossible),
            unknown: sum(&|row| row.unknown),
            hard: sum(&|row| row.hard),
            whole: sum(&|row| row.whole),
            size: sum(&|row| row.size),
            cover: sum(&|row| row.cover),
            same: sum(&|row| row.same),
            milliseconds: rows.iter().map(|row| row.milliseconds).fold(0.0, f64::max),
            notes: BTreeSet::new(),
        }
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |count: usize| 100.0 * count as f64 / self.levels.max(1) as f64;
        write!(
            f,
            "{:<18} {:>6} {:>5.0} {:>5.0} {:>10.0} {:>7.0} {:>5.0} {:>5.0} {:>5.0} {:>5.0} {:>5.1} {:>4}  {}",
            self.name,
            self.levels,
            share(self.made),
            share(self.won),
            share(self.impossible),
            share(self.unknown),
            share(self.hard),
            share(self.whole),
            share(self.size),
            share(self.cover),
            self.milliseconds,
            self.same,
            self.notes.iter().cloned().collect::<Vec<_>>().join(", ")
        )
    }
}
