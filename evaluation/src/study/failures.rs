//! How won and lost episodes were walked (`spec/06` §2.7 and §5.4).

use crate::metrics::EpisodeMetrics;
use crate::study::Study;
use crate::study::scores::{StudyEpisode, mean};
use crate::study::table::{Table, TableCell};
use serde::Serialize;
use statistics::{bonferroni, quantile, welch};
use std::collections::BTreeMap;

/// The failure-mode measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureMeasure {
    /// The share of steps that were not meaningful.
    BumpRate,
    /// The longest run of such steps.
    MaxBumps,
    /// The bump rate of the last quarter.
    LateBumpRate,
    /// The share of steps that went straight back.
    OscillationRate,
    /// Different cells of the avatar.
    UniqueCells,
    /// These, by the area of the rectangle around them.
    Coverage,
}

impl FailureMeasure {
    /// All.
    pub const ALL: [FailureMeasure; 6] = [
        FailureMeasure::BumpRate,
        FailureMeasure::MaxBumps,
        FailureMeasure::LateBumpRate,
        FailureMeasure::OscillationRate,
        FailureMeasure::UniqueCells,
        FailureMeasure::Coverage,
    ];

    /// Its name in headings.
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

    /// Its value for an episode.
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

/// A measure over the won and over the other episodes of models (of all players, if there is no model).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailureMode {
    /// Which.
    pub measure: FailureMeasure,
    /// Its values in won episodes.
    pub won: Vec<f64>,
    /// Its values in all others.
    pub lost: Vec<f64>,
    /// Episodes for which it is missing.
    pub excluded: u64,
    /// Welch's test of the means, won minus lost; missing with fewer than two values on a side, or without any spread.
    pub welch: Option<WelchTest>,
}

/// Welch's t test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WelchTest {
    /// The difference of the means in standard errors.
    pub t: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Two-sided, episodes taken for independent.
    pub p: f64,
    /// Corrected for the six measures, by Bonferroni. (The paper corrects nothing here.)
    pub adjusted: f64,
}

/// All failure modes.
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

/// How a player oscillates on a level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OscillationRow {
    /// Index into the players of the study.
    pub player: usize,
    /// Index into the games of the study.
    pub game: usize,
    /// The level's number.
    pub level: usize,
    /// Mean oscillation rate.
    pub rate: f64,
    /// Episodes.
    pub episodes: u64,
    /// Of these, won.
    pub wins: u64,
}

/// Where models (all players, if there is no model) oscillate, the most first; where they never do is left out.
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
    let mut rows: Vec<OscillationRow> = groups.into_iter().filter_map(row).collect();
    rows.sort_by(|a, b| b.rate.total_cmp(&a.rate));
    rows
}

/// Rows of the oscillation table.
const TOP: usize = 10;

pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let mut modes = Table::new(
        "failure-modes",
        "Failure modes",
        "Means, medians and Welch's t test of won against other episodes, taken for independent; corrected by Bonferroni for six \
         measures. A bump is a step that was not meaningful; late: in the last quarter.",
        &[
            "measure",
            "won",
            "episodes",
            "median",
            "not won",
            "episodes not won",
            "median not won",
            "t",
            "df",
            "p",
            "corrected p",
            "missing",
        ],
    );
    for mode in &study.failures {
        let mut row = vec![TableCell::text(mode.measure.title())];
        for values in [&mode.won, &mode.lost] {
            row.push(TableCell::number(mean(values.iter().copied()), 3));
            row.push(TableCell::Count(values.len() as u64));
            row.push(TableCell::number(quantile(values, 0.5), 3));
        }
        row.push(TableCell::number(mode.welch.map(|test| test.t), 2));
        row.push(TableCell::number(mode.welch.map(|test| test.df), 1));
        row.push(TableCell::probability(mode.welch.map(|test| test.p)));
        row.push(TableCell::probability(mode.welch.map(|test| test.adjusted)));
        row.push(TableCell::Count(mode.excluded));
        modes.push(row);
    }
    let mut top = Table::new(
        "oscillation",
        "Oscillation",
        "The levels on which players went back and forth most: mean share of steps that return to the cell of two steps ago.",
        &["player", "level", "oscillation rate", "episodes", "wins"],
    );
    for row in study.oscillations.iter().take(TOP) {
        top.push(vec![
            TableCell::text(study.players[row.player].label()),
            TableCell::text(study.place(row.game, Some(row.level))),
            TableCell::number(row.rate, 3),
            TableCell::Count(row.episodes),
            TableCell::Count(row.wins),
        ]);
    }
    vec![modes, top]
}
