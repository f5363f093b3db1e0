//! One level in the report.

use crate::survey::SurveyedLevel;
use base::Digest;
use report::{Table, TableCell};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use validators::{Criterion, Difficulty, Verdict};

/// One level in the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelRow {
    /// The digest of the level's text.
    pub digest: Digest,
    /// The number of columns of the board.
    pub columns: u64,
    /// The number of rows of the board.
    pub rows: u64,
    /// `true` if the level meets every requested criterion.
    pub passes: bool,
    /// The first unmet criterion; `None` if all requested criteria are met.
    pub obstacle: Option<Criterion>,
    /// The result of the search for a win: `solved`, `impossible` or `unknown`.
    pub solved: &'static str,
    /// The requested difficulty; `None` if none was requested.
    pub asked: Option<Difficulty>,
    /// The measured difficulty; `None` if it was not measured.
    pub label: Option<Difficulty>,
    /// The ease measured by the ladder (reference players of increasing strength), from 0 to 1; `None` if it was not
    /// measured.
    pub ease: Option<f64>,
    /// The number of ticks in the shortest win, if the win is proved to be the shortest.
    pub shortest: Option<u64>,
    /// The play and layout measures, by name.
    pub measures: BTreeMap<String, f64>,
    /// The distance to the nearest other level of the set, if there is one, from 0 (equal) to 1.
    pub nearest: Option<f64>,
}

/// The names of the play measures, in report order. In the report, the board measures follow them.
const OF_PLAY: [&str; 6] = ["ticks", "pushes", "branching", "mechanics", "pressure", "skill"];

impl LevelRow {
    pub(super) fn of(surveyed: &SurveyedLevel, nearest: Option<f64>) -> LevelRow {
        let SurveyedLevel { level, report, ladder, measures, layout, asked } = surveyed;
        let winnable = report.finding(Criterion::Winnable).map(|found| &found.verdict);
        let solved = match (&report.witness, winnable) {
            (Some(_), _) => "solved",
            (None, Some(Verdict::Fail { .. })) => "impossible",
            _ => "unknown",
        };
        let names = OF_PLAY.into_iter().chain(layout.iter().map(|(name, _)| name.as_str()));
        let named = |name: &str| Some((name.to_owned(), surveyed.measure(name)?));
        LevelRow {
            digest: level.digest(),
            columns: level.columns() as u64,
            rows: level.rows() as u64,
            passes: report.passes(),
            obstacle: report.first_obstacle().map(|obstacle| obstacle.criterion),
            solved,
            asked: *asked,
            label: surveyed.label(),
            ease: ladder.as_ref().and_then(|ladder| ladder.ease),
            shortest: measures.as_ref().and_then(|measures| measures.shortest).map(|ticks| ticks as u64),
            measures: names.filter_map(named).collect(),
            nearest,
        }
    }

    /// Returns the verdict in a word or two.
    fn verdict(&self) -> String {
        match self.obstacle {
            None if self.passes => "passes".to_owned(),
            None | Some(Criterion::Winnable) => self.solved.to_owned(),
            Some(obstacle) => format!("{obstacle} not passed"),
        }
    }

    /// Returns the measured difficulty, with the requested difficulty if the two differ: `hard (requested: easy)`.
    /// Returns an empty text if neither difficulty is known.
    pub fn difficulty(&self) -> String {
        match (self.label, self.asked) {
            (Some(label), Some(asked)) if label != asked => format!("{label} (requested: {asked})"),
            (Some(label), _) => label.to_string(),
            (None, Some(asked)) => format!("requested: {asked}"),
            (None, None) => String::new(),
        }
    }

    /// Describes the level in one line: `34 ticks (shortest), 12 pushes, length not passed`. If `proofs` is `true`, the
    /// line states what is proved.
    pub fn remark(&self, proofs: bool) -> String {
        let ticks = match self.measures.get("ticks") {
            Some(ticks) if proofs && self.shortest.is_some() => format!("{ticks} ticks (shortest)"),
            Some(ticks) => format!("{ticks} ticks"),
            None if self.solved == "solved" => "solved".to_owned(),
            None => format!("{}!", self.solved),
        };
        let pushes = self.measures.get("pushes").filter(|pushes| **pushes > 0.0);
        let pushes = pushes.map(|pushes| format!("{pushes:.0} pushes"));
        let obstacle = self.obstacle.filter(|obstacle| *obstacle != Criterion::Winnable);
        let parts = [Some(ticks), pushes, obstacle.map(|obstacle| format!("{obstacle} not passed"))];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// Returns the table of all levels, with play measures before board measures.
pub(super) fn table(rows: &[LevelRow]) -> Table {
    let known: BTreeSet<&str> = rows.iter().flat_map(|row| row.measures.keys()).map(String::as_str).collect();
    let play: Vec<&str> = OF_PLAY.into_iter().filter(|name| known.contains(name)).collect();
    let board: Vec<&str> = known.into_iter().filter(|name| !OF_PLAY.contains(name)).collect();
    let some_asked = rows.iter().any(|row| row.asked.is_some());
    let some_label = rows.iter().any(|row| row.label.is_some());
    let mut columns = vec!["", "size", "verdict"];
    columns.extend(some_asked.then_some("asked"));
    columns.extend(some_label.then_some("measured"));
    columns.extend(play.iter().chain(&["shortest", "nearest"]).chain(&board).chain(&["digest"]));
    let mut table = Table::new("levels", "Every level", "", &columns);
    let label = |label: Option<Difficulty>| {
        label.map_or(TableCell::Missing, |label| TableCell::Figure(label.to_string()))
    };
    for (at, row) in rows.iter().enumerate() {
        let size = TableCell::Figure(format!("{} × {}", row.columns, row.rows));
        let mut cells = vec![TableCell::Count(at as u64), size, TableCell::text(row.verdict())];
        cells.extend(some_asked.then(|| label(row.asked)));
        cells.extend(some_label.then(|| label(row.label)));
        let value = |name: &&str| TableCell::short(row.measures.get(*name).copied());
        cells.extend(play.iter().map(value));
        cells.extend([TableCell::count(row.shortest), TableCell::short(row.nearest)]);
        cells.extend(board.iter().map(value));
        cells.push(TableCell::Figure(row.digest.short()));
        table.push(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_tell_what_matters() {
        let mut row = LevelRow {
            digest: Digest::of(b""),
            columns: 8,
            rows: 8,
            passes: true,
            obstacle: None,
            solved: "solved",
            asked: Some(Difficulty::Hard),
            label: Some(Difficulty::Medium),
            ease: None,
            shortest: Some(34),
            measures: BTreeMap::from([("ticks".to_owned(), 34.0), ("pushes".to_owned(), 12.0)]),
            nearest: None,
        };
        assert_eq!(row.difficulty(), "medium (requested: hard)");
        assert_eq!(row.remark(true), "34 ticks (shortest), 12 pushes");
        assert_eq!(row.remark(false), "34 ticks, 12 pushes");
        row.asked = row.label;
        row.obstacle = Some(Criterion::Length);
        assert_eq!((row.difficulty().as_str(), row.verdict().as_str()), ("medium", "length not passed"));
        assert_eq!(row.remark(true), "34 ticks (shortest), 12 pushes, length not passed");
        row.measures.clear();
        (row.solved, row.obstacle) = ("impossible", Some(Criterion::Winnable));
        assert_eq!((row.remark(true).as_str(), row.verdict().as_str()), ("impossible!", "impossible"));
    }
}
