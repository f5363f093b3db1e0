//! Heat map data, with one value per player and game or level.

use crate::study::Study;
use crate::study::episodes::scores::{Estimate, Scores, StudyEpisode};
use crate::study::players::player::Player;
use report::{Table, TableCell};
use serde::Serialize;
use std::collections::BTreeMap;

base::named_enum! {
    /// A measure shown in heat maps.
    pub enum Measure {
        /// The number of wins divided by the number of episodes.
        WinRate = "win_rate",
        /// The paper's overall score.
        Overall = "overall",
        /// The mean normalised reward.
        NormalisedReward = "normalised_reward",
        /// The mean meaningful step ratio.
        Meaningful = "meaningful",
        /// The mean number of steps.
        Steps = "steps",
        /// The mean bump rate.
        BumpRate = "bump_rate",
    }
}

impl Measure {
    /// Returns the measure's name for use in headings.
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

    /// Returns `true` if higher values are better, `false` if lower values are better, and `None` if neither
    /// is better.
    pub fn higher_is_better(self) -> Option<bool> {
        match self {
            Measure::Steps => None,
            Measure::BumpRate => Some(false),
            _ => Some(true),
        }
    }

    /// Returns `true` if the measure is always between 0 and 1.
    pub fn is_fraction(self) -> bool {
        self != Measure::Steps
    }

    /// Returns the measure's value for a set of episodes with the given scores.
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

base::named_enum! {
    /// The modes whose models are shown in a heat map. Players that are not models are shown in all heat
    /// maps.
    pub enum Scope {
        /// Models in zero-shot mode only.
        ZeroShot = "zero-shot",
        /// Models in contextual mode only.
        Contextual = "contextual",
        /// All models, with the episodes of both modes pooled.
        Both = "both",
    }
}

impl Scope {
    /// Returns the label for the player's row, or `None` if the player is not shown.
    fn row(self, player: &Player) -> Option<String> {
        match (self, player.mode.as_deref()) {
            (_, None) | (Scope::Both, _) => Some(player.short_label()),
            (_, Some(mode)) => (mode == self.name()).then(|| player.short_label()),
        }
    }
}

/// The scores of all players on all games or levels. Every heat map is drawn from these scores.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Matrix {
    /// The scope, which determines which players are included.
    pub scope: Scope,
    /// The matrix rows.
    pub rows: Vec<MatrixRow>,
    /// The matrix columns.
    pub columns: Vec<MatrixColumn>,
    /// The scores of each row's players on each column's levels, in row-major order. `None` if no episodes
    /// were played.
    pub cells: Vec<Vec<Option<Scores>>>,
}

/// A [`Matrix`] row.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MatrixRow {
    /// The row label.
    pub label: String,
    /// `true` if the row shows a baseline rather than a model.
    pub reference: bool,
    /// The indices of the row's players in the study. With [`Scope::Both`], a row can have two players.
    pub players: Vec<usize>,
}

/// A [`Matrix`] column: a level, or a game with all its levels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MatrixColumn {
    /// The column label.
    pub label: String,
    /// The game's index in the study.
    pub game: usize,
    /// The level number, or `None` for all levels of the game.
    pub level: Option<usize>,
    /// The length of the shortest win in ticks, if it was proved to be optimal.
    pub optimal_ticks: Option<usize>,
}

impl Matrix {
    /// Builds the matrix for a scope, by level or by game.
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

    /// Returns a measure's values, in row-major order.
    pub fn values(&self, measure: Measure) -> Vec<Vec<Option<f64>>> {
        let value = |scores: &Option<Scores>| scores.as_ref().and_then(|scores| measure.of(scores));
        self.cells.iter().map(|row| row.iter().map(value).collect()).collect()
    }

    /// Returns a measure's values as a table, with games or levels as rows and players as columns. `grain`
    /// becomes part of the table's file name.
    pub(crate) fn table(&self, measure: Measure, grain: &str) -> Table {
        let digits = if measure.is_fraction() { 2 } else { 1 };
        let scope = self.scope.name();
        let id = format!("{}-by-{grain}-{scope}", measure.name().replace('_', "-"));
        let title = format!("{} by {grain}, {scope}", measure.title());
        let note = if measure == Measure::WinRate { "With Wilson's 95% interval." } else { "" };
        let names = self.rows.iter().map(|row| row.label.as_str());
        // The table of steps by level also has a column with the optimum.
        let with_optimum =
            measure == Measure::Steps && self.columns.iter().any(|column| column.level.is_some());
        let optimum = with_optimum.then_some("fewest steps to win (proven)");
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

/// Returns a scope's rows in the order of the study. Models come before reference players.
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
