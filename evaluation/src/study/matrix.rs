//! Heat maps as data: a number for each player on each game or level.

use crate::study::Study;
use crate::study::player::{CONTEXTUAL, Player, ZERO_SHOT};
use crate::study::scores::{Estimate, Scores, StudyEpisode};
use crate::study::table::{Table, TableCell};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a heat map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Wins by episodes.
    WinRate,
    /// The overall score.
    Overall,
    /// Mean normalised reward.
    NormalisedReward,
    /// Mean meaningful step ratio.
    Meaningful,
    /// Mean steps.
    Steps,
    /// Mean bump rate.
    BumpRate,
}

impl Measure {
    /// All.
    pub const ALL: [Measure; 6] = [
        Measure::WinRate,
        Measure::Overall,
        Measure::NormalisedReward,
        Measure::Meaningful,
        Measure::Steps,
        Measure::BumpRate,
    ];

    /// Its name in headings.
    pub fn title(self) -> &'static str {
        match self {
            Measure::WinRate => "Win rate",
            Measure::Overall => "Overall score",
            Measure::NormalisedReward => "Normalised reward",
            Measure::Meaningful => "Meaningful step ratio",
            Measure::Steps => "Steps",
            Measure::BumpRate => "Bump rate",
        }
    }

    /// Its name in file names.
    pub fn id(self) -> &'static str {
        match self {
            Measure::WinRate => "win-rate",
            Measure::Overall => "overall",
            Measure::NormalisedReward => "normalised-reward",
            Measure::Meaningful => "meaningful",
            Measure::Steps => "steps",
            Measure::BumpRate => "bump-rate",
        }
    }

    /// Whether more is better; `None` where neither is.
    pub fn higher_is_better(self) -> Option<bool> {
        match self {
            Measure::Steps => None,
            Measure::BumpRate => Some(false),
            _ => Some(true),
        }
    }

    /// Whether it is a share, within 0..=1.
    pub fn is_share(self) -> bool {
        self != Measure::Steps
    }

    /// Its value among the numbers of some episodes.
    pub fn of(self, scores: &Scores) -> Option<f64> {
        match self {
            Measure::WinRate => scores.win_rate.map(|rate| rate.value),
            Measure::Overall => scores.overall,
            Measure::NormalisedReward => scores.normalised_reward,
            Measure::Meaningful => scores.meaningful,
            Measure::Steps => scores.steps,
            Measure::BumpRate => scores.bump_rate,
        }
    }
}

/// Which players a heat map shows. Those that are no models are in all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// Models in zero-shot mode.
    ZeroShot,
    /// Models in contextual mode.
    Contextual,
    /// Models, the episodes of both modes together.
    Both,
}

impl Scope {
    /// All.
    pub const ALL: [Scope; 3] = [Scope::ZeroShot, Scope::Contextual, Scope::Both];

    /// Its name in headings and file names.
    pub fn id(self) -> &'static str {
        match self {
            Scope::ZeroShot => ZERO_SHOT,
            Scope::Contextual => CONTEXTUAL,
            Scope::Both => "both",
        }
    }

    /// The row that a player belongs to, if it is shown at all.
    fn row(self, player: &Player) -> Option<String> {
        match (self, player.mode.as_deref()) {
            (_, None) | (Scope::Both, _) => Some(player.short_label()),
            (Scope::ZeroShot, Some(mode)) => (mode == ZERO_SHOT).then(|| player.short_label()),
            (Scope::Contextual, Some(mode)) => (mode == CONTEXTUAL).then(|| player.short_label()),
        }
    }
}

/// Scores of all players on all games or levels, from which every heat map is read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Matrix {
    /// Whose episodes.
    pub scope: Scope,
    /// Its rows.
    pub rows: Vec<MatrixRow>,
    /// Its columns.
    pub columns: Vec<MatrixColumn>,
    /// Row-major: the numbers of a row's players on a column's levels; `None` if none was played.
    pub cells: Vec<Vec<Option<Scores>>>,
}

/// A row of a [`Matrix`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MatrixRow {
    /// What it is called.
    pub label: String,
    /// Whether it is no model but a mark to compare with.
    pub reference: bool,
    /// Indices into the players of the study: two in [`Scope::Both`].
    pub players: Vec<usize>,
}

/// A column of a [`Matrix`]: a level, or a game with all its levels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MatrixColumn {
    /// What it is called.
    pub label: String,
    /// Index into the games of the study.
    pub game: usize,
    /// The level's number; none for all levels.
    pub level: Option<usize>,
    /// Ticks of the shortest win, where it is proved.
    pub optimal_ticks: Option<usize>,
}

impl Matrix {
    /// The matrix of a scope, by levels or by games.
    pub(crate) fn of(study: &Study, scope: Scope, by_level: bool) -> Matrix {
        let rows = rows(study, scope);
        let mut columns = Vec::new();
        for (game, facts) in study.games.iter().enumerate() {
            if by_level {
                columns.extend(facts.levels.iter().map(|level| MatrixColumn {
                    label: format!("{}-{}", facts.id, level.number),
                    game,
                    level: Some(level.number),
                    optimal_ticks: level.optimal_ticks,
                }));
            } else {
                let (label, level, optimal_ticks) = (facts.id.clone(), None, None);
                columns.push(MatrixColumn { label, game, level, optimal_ticks });
            }
        }
        let cell = |row: &MatrixRow, column: &MatrixColumn| {
            let on = |&player: &usize| study.on(player, Some(column.game), column.level);
            let episodes: Vec<&StudyEpisode> = row.players.iter().flat_map(on).collect();
            (!episodes.is_empty()).then(|| Scores::of(episodes))
        };
        let cells = rows.iter().map(|row| columns.iter().map(|column| cell(row, column)).collect()).collect();
        Matrix { scope, rows, columns, cells }
    }

    /// The values of a measure, row-major.
    pub fn values(&self, measure: Measure) -> Vec<Vec<Option<f64>>> {
        let value = |scores: &Option<Scores>| scores.as_ref().and_then(|scores| measure.of(scores));
        self.cells.iter().map(|row| row.iter().map(value).collect()).collect()
    }

    /// A measure as a table, games or levels down and players across. `grain` is part of its file name.
    pub(crate) fn table(&self, measure: Measure, grain: &str) -> Table {
        let digits = if measure.is_share() { 2 } else { 1 };
        let id = format!("{}-by-{grain}-{}", measure.id(), self.scope.id());
        let title = format!("{} by {grain}, {}", measure.title(), self.scope.id());
        let note = if measure == Measure::WinRate { "With Wilson's 95 % interval." } else { "" };
        let names = self.rows.iter().map(|row| row.label.as_str());
        // Beside the steps on a level stands how few can win it.
        let with_optimum =
            measure == Measure::Steps && self.columns.iter().any(|column| column.level.is_some());
        let optimum = with_optimum.then_some("fewest to win (proved)");
        let columns: Vec<&str> = [grain].into_iter().chain(names).chain(optimum).collect();
        let mut table = Table::new(&id, &title, note, &columns);
        for (at, column) in self.columns.iter().enumerate() {
            let cell = |row: &Vec<Option<Scores>>| match (&row[at], measure) {
                (Some(scores), Measure::WinRate) => Estimate::cell(scores.win_rate, digits),
                (scores, _) => {
                    TableCell::number(scores.as_ref().and_then(|scores| measure.of(scores)), digits)
                }
            };
            let label = TableCell::text(&column.label);
            let fewest = TableCell::count(column.optimal_ticks.map(|ticks| ticks as u64));
            let fewest = with_optimum.then_some(fewest);
            table.push([label].into_iter().chain(self.cells.iter().map(cell)).chain(fewest).collect());
        }
        table
    }
}

/// The rows of a scope, in the order of the study, models before references.
fn rows(study: &Study, scope: Scope) -> Vec<MatrixRow> {
    let mut rows: Vec<MatrixRow> = Vec::new();
    let mut places: BTreeMap<(bool, String), usize> = BTreeMap::new();
    for (index, player) in study.players.iter().enumerate() {
        let Some(label) = scope.row(player) else { continue };
        let reference = player.is_reference();
        let place = *places.entry((reference, label.clone())).or_insert(rows.len());
        if place == rows.len() {
            rows.push(MatrixRow { label, reference, players: Vec::new() });
        }
        rows[place].players.push(index);
    }
    rows.sort_by_key(|row| row.reference);
    rows
}
