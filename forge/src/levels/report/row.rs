//! One level in the report.

use super::Judged;
use engine::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::{Difficulty, Verdict};

/// One level in the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelRow {
    /// Of its text.
    pub digest: Digest,
    /// Of its board.
    pub columns: u64,
    /// Of its board.
    pub rows: u64,
    /// Whether it meets every criterion that was asked.
    pub passes: bool,
    /// The first criterion that it does not meet.
    pub obstacle: Option<String>,
    /// Whether it can be won: `solved`, `impossible` or `unknown`.
    pub solved: String,
    /// The difficulty that was asked for.
    pub asked: Option<Difficulty>,
    /// The difficulty that was measured.
    pub label: Option<Difficulty>,
    /// How easy, from 0 to 1.
    pub ease: Option<f64>,
    /// Ticks of the shortest win, where that is proved.
    pub shortest: Option<u64>,
    /// Its measures by name, those of play and those of the layout.
    pub measures: BTreeMap<String, f64>,
    /// Distance to the level of the set that is most like it.
    pub nearest: Option<f64>,
}

/// The names of the measures of play, in the order of telling; those of the board follow.
pub const OF_PLAY: [&str; 6] = ["ticks", "pushes", "branching", "mechanics", "pressure", "skill"];

impl LevelRow {
    pub(super) fn of(judged: &Judged, nearest: Option<f64>) -> LevelRow {
        let Judged { level, report, ladder, measures, layout, asked } = judged;
        let winnable = report.finding("winnable").map(|found| &found.verdict);
        let solved = match (&report.witness, winnable) {
            (Some(_), _) => "solved",
            (None, Some(Verdict::Fail { .. })) => "impossible",
            _ => "unknown",
        };
        let names = OF_PLAY.into_iter().chain(layout.iter().map(|(name, _)| name.as_str()));
        let named = |name: &str| Some((name.to_owned(), judged.measure(name)?));
        LevelRow {
            digest: level.digest(),
            columns: level.columns() as u64,
            rows: level.rows() as u64,
            passes: report.passes(),
            obstacle: report.first_obstacle().map(|obstacle| obstacle.criterion.to_owned()),
            solved: solved.to_owned(),
            asked: *asked,
            label: judged.label(),
            ease: ladder.as_ref().and_then(|ladder| ladder.ease),
            shortest: measures.as_ref().and_then(|measures| measures.shortest).map(|ticks| ticks as u64),
            measures: names.filter_map(named).collect(),
            nearest,
        }
    }
}
