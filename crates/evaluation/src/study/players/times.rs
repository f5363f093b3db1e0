//! The durations of decisions.

use crate::study::Study;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::quantile;

/// The durations of a player's decisions, including decisions in aborted episodes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeRow {
    /// The player's index in the study.
    pub player: usize,
    /// The number of decisions.
    pub decisions: u64,
    /// The median duration of a decision, in milliseconds.
    pub median_ms: Option<f64>,
    /// The 90th percentile of the duration, in milliseconds.
    pub p90_ms: Option<f64>,
    /// The median number of forward-model calls per decision, for players that use the forward model.
    pub median_calls: Option<f64>,
    /// The 90th percentile of forward-model calls per decision.
    pub p90_calls: Option<f64>,
}

impl TimeRow {
    pub(crate) fn of(study: &Study, player: usize) -> TimeRow {
        let all = |of: fn(&crate::metrics::EpisodeMetrics) -> Vec<f64>| {
            study.on(player, None, None).iter().flat_map(|episode| of(&episode.metrics)).collect::<Vec<f64>>()
        };
        let times = all(|metrics| metrics.decision_ms.clone());
        let calls = all(|metrics| metrics.calls.iter().map(|&calls| calls as f64).collect());
        TimeRow {
            player,
            decisions: times.len() as u64,
            median_ms: quantile(&times, 0.5),
            p90_ms: quantile(&times, 0.9),
            median_calls: quantile(&calls, 0.5),
            p90_calls: quantile(&calls, 0.9),
        }
    }
}

pub(crate) fn table(study: &Study) -> Table {
    Table::of(
        "times",
        "Decision times",
        "Time from the observation to the action, including waits and repeated questions. Calls: forward-model calls of planners. Times \
         depend on the machine and its load.",
        &study.times,
        &[
            ("player", &|row| TableCell::text(study.players[row.player].label())),
            ("decisions", &|row| TableCell::Count(row.decisions)),
            ("median, ms", &|row| TableCell::number(row.median_ms, 1)),
            ("90%, ms", &|row| TableCell::number(row.p90_ms, 1)),
            ("median calls", &|row| TableCell::number(row.median_calls, 0)),
            ("90% calls", &|row| TableCell::number(row.p90_calls, 0)),
        ],
    )
}
