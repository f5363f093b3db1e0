//! How hard are the levels, and do they get harder?

use super::entry::Judged;
use super::figures::Mean;
use serde::{Deserialize, Serialize};
use validators::Difficulty;

/// All labels, the easiest first.
const LABELS: [Difficulty; 6] = [
    Difficulty::VeryEasy,
    Difficulty::Easy,
    Difficulty::Medium,
    Difficulty::Hard,
    Difficulty::VeryHard,
    Difficulty::Unbeaten,
];

/// How hard the levels are by their place in the game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Difficulties {
    /// The labels, the easiest first: the order of columns.
    pub labels: Vec<Difficulty>,
    /// `[place in the game][label]`: levels.
    pub table: Vec<Vec<u64>>,
    /// Spearman's rank correlation of a level's place in its game with its difficulty (1 − ease), in the mean over games whose
    /// levels are not all alike: 1 if every level is harder than the one before.
    pub rising: Option<Mean>,
}

impl Difficulties {
    pub(super) fn of(judged: &[Judged<'_>]) -> Option<Difficulties> {
        let reports = || judged.iter().map(|judged| &judged.reported.report.levels);
        let most = reports().map(Vec::len).max()?;
        let mut table = vec![vec![0; LABELS.len()]; most];
        for (at, ladder) in reports().flat_map(|levels| {
            levels.iter().enumerate().filter_map(|(at, found)| Some((at, found.ladder()?)))
        }) {
            let label = LABELS.iter().position(|label| *label == ladder.difficulty);
            table[at][label.expect("all labels are listed")] += 1;
        }
        if table.iter().flatten().all(|count| *count == 0) {
            return None;
        }
        let rising: Vec<f64> = reports()
            .filter_map(|levels| {
                let eases = levels.iter().enumerate();
                let eases = eases.filter_map(|(at, found)| Some((at as f64, 1.0 - found.ladder()?.ease?)));
                statistics::spearman(&eases.collect::<Vec<(f64, f64)>>())
            })
            .collect();
        Some(Difficulties { labels: LABELS.to_vec(), table, rising: Mean::of(&rising) })
    }
}
