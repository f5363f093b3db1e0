//! Players' predictions about the rules after the last level in a series.

use crate::study::episodes::scores::mean;
use crate::study::{Player, Study};
use report::{Table, TableCell};
use serde::Serialize;

/// A player's prediction results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PredictionRow {
    /// The player who made the predictions.
    pub player: Player,
    /// The number of answers, including unusable answers.
    pub answers: u64,
    /// The number of correct predictions.
    pub right: u64,
    /// The number of predictions that can be graded: the pairs of sprite types and facts that the rules
    /// determine.
    pub of: u64,
    /// The mean insight of the answers ([`Grade::insight`](crate::predictions::Grade::insight)). Answers
    /// without an insight are excluded.
    pub insight: Option<f64>,
}

/// Returns one row per player with predictions, sorted by descending insight (agreement with the rules).
pub(in crate::study) fn rows(study: &Study) -> Vec<PredictionRow> {
    let row = |(number, player): (usize, &Player)| {
        let ended = study.on(number, None, None).iter().filter(|episode| episode.metrics.counts());
        let grades: Vec<_> = ended.filter_map(|episode| episode.metrics.predictions.as_ref()).collect();
        (!grades.is_empty()).then(|| PredictionRow {
            player: player.clone(),
            answers: grades.len() as u64,
            right: grades.iter().map(|grade| grade.right).sum(),
            of: grades.iter().map(|grade| grade.of).sum(),
            insight: mean(grades.iter().filter_map(|grade| grade.insight)),
        })
    };
    let mut rows: Vec<PredictionRow> = study.players.iter().enumerate().filter_map(row).collect();
    let insight = |row: &PredictionRow| row.insight.unwrap_or(-2.0);
    rows.sort_by(|a, b| insight(b).total_cmp(&insight(a)));
    rows
}

/// Returns the predictions table, or `None` if there are no predictions.
pub(in crate::study) fn table(study: &Study) -> Option<Table> {
    (!study.predictions.is_empty()).then(|| {
        Table::of(
            "predictions",
            "Predictions about the rules",
            "The question after the last level of a series: which kinds kill, stop, go or score when they are touched. Right: correct predictions, out of all pairs of a kind and a fact that the rules determine. Insight: the fraction of kinds named among those for which a fact is true, \
             minus the fraction named among the other kinds, averaged over facts and answers. \
             Naming kinds at random gives 0, and a perfect answer gives 1.",
            &study.predictions,
            &[
                ("player", &|row| TableCell::text(row.player.label())),
                ("answers", &|row| TableCell::Count(row.answers)),
                ("right", &|row| TableCell::text(format!("{}/{}", row.right, row.of))),
                ("insight", &|row| TableCell::number(row.insight, 2)),
            ],
        )
    })
}
