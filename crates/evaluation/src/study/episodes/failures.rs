//! Compares the movement in won episodes with the movement in all other episodes (`spec/06` §2.7 and §5.4).

use crate::metrics::EpisodeMetrics;
use crate::study::Study;
use crate::study::episodes::scores::{StudyEpisode, mean};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{bonferroni, quantile, welch};
use std::collections::BTreeMap;

base::named_enum! {
    /// A failure-mode metric, computed per episode.
    pub enum FailureMeasure {
        /// The fraction of steps that were not meaningful.
        BumpRate = "bump_rate",
        /// The length of the longest sequence of steps that were not meaningful.
        MaxBumps = "max_bumps",
        /// The bump rate in the last quarter of the steps.
        LateBumpRate = "late_bump_rate",
        /// The fraction of steps that returned to the cell where the avatar was two steps earlier.
        OscillationRate = "oscillation_rate",
        /// The number of distinct cells visited by the avatar.
        UniqueCells = "unique_cells",
        /// The number of distinct cells visited, divided by the area of their bounding rectangle.
        Coverage = "coverage",
    }
}

impl FailureMeasure {
    /// Returns the metric's name for use in headings.
    pub fn title(self) -> &'static str {
        match self {
            FailureMeasure::BumpRate => "bump rate",
            FailureMeasure::MaxBumps => "longest run of bumps",
            FailureMeasure::LateBumpRate => "late bump rate",
            FailureMeasure::OscillationRate => "oscillation rate",
            FailureMeasure::UniqueCells => "unique cells",
            FailureMeasure::Coverage => "coverage density",
        }
    }

    /// Returns the metric's value for an episode.
    pub fn of(self, episode: &EpisodeMetrics) -> Option<f64> {
        let movement = &episode.movement;
        match self {
            FailureMeasure::BumpRate => movement.bump_rate,
            FailureMeasure::MaxBumps => movement.max_bumps.map(|count| count as f64),
            FailureMeasure::LateBumpRate => movement.late_bump_rate,
            FailureMeasure::OscillationRate => movement.oscillation_rate,
            FailureMeasure::UniqueCells => movement.unique_cells.map(|count| count as f64),
            FailureMeasure::Coverage => movement.coverage,
        }
    }
}

/// A metric's values in the won episodes and in the other episodes of models. If there are no models, all
/// players are included.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailureMode {
    /// The failure-mode metric.
    pub measure: FailureMeasure,
    /// The values in won episodes.
    pub won: Vec<f64>,
    /// The values in all other episodes.
    pub lost: Vec<f64>,
    /// The number of episodes excluded because they have no value for the metric.
    pub excluded: u64,
    /// Welch's test of the difference between the means (won episodes minus other episodes). `None` if either
    /// side has fewer than two values, or if there is no variance.
    pub welch: Option<WelchTest>,
}

/// The result of Welch's t test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WelchTest {
    /// The t statistic: the difference between the means, in standard errors.
    pub t: f64,
    /// The degrees of freedom.
    pub df: f64,
    /// The two-sided p-value. It treats episodes as independent.
    pub p: f64,
    /// The p-value corrected for the six metrics (Bonferroni). The paper makes no such correction.
    pub adjusted: f64,
}

pub(crate) fn failures(study: &Study) -> Vec<FailureMode> {
    let of = |measure: FailureMeasure| {
        let values = |won: bool| {
            let episodes = study.tested().filter(move |episode| episode.metrics.won() == won);
            episodes.filter_map(move |episode| measure.of(&episode.metrics)).collect::<Vec<f64>>()
        };
        let (won, lost) = (values(true), values(false));
        let excluded = (study.tested().count() - won.len() - lost.len()) as u64;
        let test = welch(&won, &lost);
        let welch = test.map(|test| WelchTest { t: test.t, df: test.df, p: test.p, adjusted: test.p });
        FailureMode { measure, won, lost, excluded, welch }
    };
    let mut modes: Vec<FailureMode> = FailureMeasure::ALL.into_iter().map(of).collect();
    let adjusted =
        bonferroni(&modes.iter().map(|mode| mode.welch.map_or(1.0, |test| test.p)).collect::<Vec<f64>>());
    for (mode, adjusted) in modes.iter_mut().zip(adjusted) {
        mode.welch.iter_mut().for_each(|test| test.adjusted = adjusted);
    }
    modes
}

/// A player's oscillation rate on a level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OscillationRow {
    /// The player's index in the study.
    pub player: usize,
    /// The game's index in the study.
    pub game: usize,
    /// The level number.
    pub level: usize,
    /// The mean oscillation rate over the episodes.
    pub rate: f64,
    /// The number of episodes.
    pub episodes: u64,
    /// The number of won episodes.
    pub wins: u64,
}

/// Returns the levels on which models oscillate, highest rate first. If there are no models, all players are
/// included. Levels with a rate of zero are omitted.
pub(crate) fn oscillations(study: &Study) -> Vec<OscillationRow> {
    let mut groups: BTreeMap<(usize, usize, usize), Vec<&StudyEpisode>> = BTreeMap::new();
    for episode in study.tested() {
        groups.entry((episode.player, episode.game, episode.metrics.level)).or_default().push(episode);
    }
    let row = |((player, game, level), episodes): ((usize, usize, usize), Vec<&StudyEpisode>)| {
        let rates: Vec<f64> = episodes.iter().filter_map(|e| e.metrics.movement.oscillation_rate).collect();
        let wins = episodes.iter().filter(|episode| episode.metrics.won()).count() as u64;
        let rate = mean(rates.iter().copied()).filter(|rate| *rate > 0.0)?;
        Some(OscillationRow { player, game, level, rate, episodes: rates.len() as u64, wins })
    };
    groups.into_iter().filter_map(row).sorted_by(|a, b| b.rate.total_cmp(&a.rate)).collect_vec()
}

/// The maximum number of rows in the oscillation table.
const TOP: usize = 10;

pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let average = |values: &[f64]| TableCell::number(mean(values.iter().copied()), 3);
    let modes = Table::of(
        "failure-modes",
        "Failure modes",
        "Means, medians and Welch's t test for won episodes against other episodes, which are treated as independent. Corrected: by \
         Bonferroni, for six measures. A bump is a step that was not meaningful. Late: in the last quarter of the episode.",
        &study.failures,
        &[
            ("measure", &|mode| TableCell::text(mode.measure.title())),
            ("won", &|mode| average(&mode.won)),
            ("episodes", &|mode| TableCell::Count(mode.won.len() as u64)),
            ("median won", &|mode| TableCell::number(quantile(&mode.won, 0.5), 3)),
            ("not won", &|mode| average(&mode.lost)),
            ("episodes not won", &|mode| TableCell::Count(mode.lost.len() as u64)),
            ("median not won", &|mode| TableCell::number(quantile(&mode.lost, 0.5), 3)),
            ("t", &|mode| TableCell::number(mode.welch.map(|test| test.t), 2)),
            ("df", &|mode| TableCell::number(mode.welch.map(|test| test.df), 1)),
            ("p", &|mode| TableCell::probability(mode.welch.map(|test| test.p))),
            ("corrected p", &|mode| TableCell::probability(mode.welch.map(|test| test.adjusted))),
            ("missing", &|mode| TableCell::Count(mode.excluded)),
        ],
    );
    let top = Table::of(
        "oscillation",
        "Oscillation",
        "The levels with the most oscillation. Oscillation rate: the mean fraction of steps that return \
         to the cell of two steps earlier.",
        &study.oscillations[..study.oscillations.len().min(TOP)],
        &[
            ("player", &|row| TableCell::text(study.players[row.player].label())),
            ("level", &|row| TableCell::text(study.place(row.game, Some(row.level)))),
            ("oscillation rate", &|row| TableCell::number(row.rate, 3)),
            ("episodes", &|row| TableCell::Count(row.episodes)),
            ("wins", &|row| TableCell::Count(row.wins)),
        ],
    );
    vec![modes, top]
}
