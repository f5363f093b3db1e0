//! The page's plots, drawn from the study's numbers.

use crate::page::plots::{
    CurvePoint, ForestRow, HeatMap, Label, Violin, curve, forest, group_width, heat_map, matrix, violins,
};
use crate::page::words;
use evaluation::study::{
    CORRELATED, Correlation, FailureMeasure, Horizon, HorizonRow, Matrix, Measure, Scope, Scores, Study,
    Test, ThinkingRow,
};
use serde::Serialize;
use std::fmt::Write;

/// The approximate number of columns per group in a heat map.
const COLUMNS: usize = 6;
/// The width of one group in a heat map, in pixels. It fits a phone screen.
const WIDTH: f64 = 240.0;

#[derive(Serialize)]
pub(super) struct Plot {
    head: String,
    svg: String,
    caption: String,
}

/// A group of plots behind a collapsible heading.
#[derive(Serialize)]
pub(super) struct Group {
    name: String,
    plots: Vec<Plot>,
}

/// The page's heat maps. Only one heat map is visible at a time.
#[derive(Serialize)]
pub(super) struct Heats {
    measures: Vec<String>,
    scopes: Vec<String>,
    panels: Vec<Panel>,
}

/// The heat maps for one measure in one scope, across all games.
#[derive(Serialize)]
struct Panel {
    measure: usize,
    scope: usize,
    svgs: Vec<String>,
    /// The colour scale, with labels at its ends.
    key: String,
    low: String,
    high: String,
    note: &'static str,
}

impl Heats {
    /// Creates the heat maps for all measures in all scopes.
    pub(super) fn of(study: &Study) -> Heats {
        let scopes = study.by_level.iter().map(|matrix| match matrix.scope {
            Scope::ZeroShot | Scope::Contextual => matrix.scope.name().to_owned(),
            Scope::Both => "both modes together".to_owned(),
        });
        let panels = Measure::ALL.into_iter().enumerate().flat_map(|(measure, shown)| {
            let matrices = study.by_level.iter().enumerate();
            matrices.map(move |(scope, matrix)| Panel::of(study, matrix, shown, measure, scope))
        });
        let measures = Measure::ALL.map(|measure| measure.title().to_owned()).to_vec();
        Heats { measures, scopes: scopes.collect(), panels: panels.collect() }
    }

    /// Returns the total size of the page's heat maps, in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.panels.iter().flat_map(|panel| &panel.svgs).map(String::len).sum()
    }

    /// Returns the style rules that show the panel selected by the reader.
    pub(super) fn rules(&self) -> String {
        let mut text = String::new();
        for measure in 0..self.measures.len() {
            let _ = writeln!(
                text,
                "#m{measure}:checked ~ .choice label[for=m{measure}] {{ background: var(--fill); color: var(--page); border-color: var(--fill); }} \
                 #m{measure}:focus-visible ~ .choice label[for=m{measure}] {{ outline: 2px solid var(--warm); }}"
            );
            for scope in 0..self.scopes.len() {
                let _ = writeln!(
                    text,
                    "#m{measure}:checked ~ #s{scope}:checked ~ .m{measure}.s{scope} {{ display: block; }}"
                );
            }
        }
        for scope in 0..self.scopes.len() {
            let _ = writeln!(
                text,
                "#s{scope}:checked ~ .choice label[for=s{scope}] {{ background: var(--fill); color: var(--page); border-color: var(--fill); }}"
            );
        }
        text
    }
}

impl Panel {
    fn of(study: &Study, matrix: &Matrix, shown: Measure, measure: usize, scope: usize) -> Panel {
        let mut values = matrix.values(shown);
        let mut rows: Vec<Label> = matrix.rows.iter().map(|row| label(&row.label, row.reference)).collect();
        let optimal: Vec<Option<f64>> =
            matrix.columns.iter().map(|column| column.optimal_ticks.map(|ticks| ticks as f64)).collect();
        if shown == Measure::Steps && optimal.iter().any(Option::is_some) {
            values.push(optimal);
            rows.push(Label { name: "shortest win".to_owned(), note: "proved".to_owned() });
        }
        let most = values.iter().flatten().flatten().copied().fold(0.0, f64::max);
        let scale = if shown.is_fraction() { [0.0, 1.0] } else { [0.0, most.max(1.0)] };
        let show: fn(f64) -> String = match shown {
            Measure::WinRate => |value| format!("{:.0}", 100.0 * value),
            Measure::Steps => |value| format!("{value:.0}"),
            _ => two_digits,
        };
        let (low, high) = match shown {
            Measure::WinRate => (words::whole_percent(0.0), words::whole_percent(1.0)),
            Measure::Steps => ("0".to_owned(), words::grouped(scale[1] as u64)),
            _ => ("0".to_owned(), "1".to_owned()),
        };
        let svgs = packed(study, matrix).into_iter().map(|columns| {
            let groups: Vec<(String, Vec<String>)> = columns
                .chunk_by(|&one, &other| matrix.columns[one].game == matrix.columns[other].game)
                .map(|levels| {
                    let name = |&at: &usize| {
                        matrix.columns[at].level.map_or(String::new(), |level| level.to_string())
                    };
                    (
                        study.title(matrix.columns[levels[0]].game).to_owned(),
                        levels.iter().map(name).collect(),
                    )
                })
                .collect();
            let cells: Vec<Vec<Option<f64>>> =
                values.iter().map(|row| columns.iter().map(|&at| row[at]).collect()).collect();
            heat_map(&HeatMap {
                label: shown.title(),
                rows: &rows,
                groups: &groups,
                cells: &cells,
                scale,
                show,
            })
        });
        let note = match shown.higher_is_better() {
            Some(true) => "higher is better",
            Some(false) => "lower is better",
            None => "neither more nor fewer is better by itself",
        };
        Panel { measure, scope, svgs: svgs.collect(), key: key(), low, high, note }
    }
}

/// Formats a value, such as `.45` or `1`. The zero before the decimal point is omitted, so that the text fits
/// into a cell.
fn two_digits(value: f64) -> String {
    let text = format!("{value:.2}");
    match text.as_str() {
        "0.00" => "0".to_owned(),
        "1.00" => "1".to_owned(),
        _ => text.strip_prefix('0').map_or_else(|| text.clone(), str::to_owned),
    }
}

/// Returns an image of a heat map's colour scale, from the low end to the high end.
fn key() -> String {
    let step =
        |at: usize| format!("<g class=\"q{at}\"><rect x=\"{}\" width=\"12\" height=\"12\"/></g>", 12 * at);
    let steps: String = (0..=10).map(step).collect();
    format!("<svg width=\"132\" height=\"12\" viewBox=\"0 0 132 12\" aria-hidden=\"true\">{steps}</svg>")
}

/// Splits a matrix's columns into groups of about [`COLUMNS`] columns. A game is split only if it has more
/// columns than that. Several games share a group if their titles fit.
fn packed(study: &Study, matrix: &Matrix) -> Vec<Vec<usize>> {
    let mut stretches: Vec<(f64, Vec<usize>)> = Vec::new();
    for game in 0..study.games.len() {
        let columns: Vec<usize> =
            (0..matrix.columns.len()).filter(|&at| matrix.columns[at].game == game).collect();
        let pieces = columns.len().div_ceil(COLUMNS).max(1);
        for piece in columns.chunks(columns.len().div_ceil(pieces).max(1)) {
            let width = group_width(study.title(game), piece.len());
            match stretches.last_mut() {
                Some((taken, last)) if last.len() + piece.len() <= COLUMNS && *taken + width <= WIDTH => {
                    *taken += width;
                    last.extend(piece);
                }
                _ => stretches.push((width, piece.to_vec())),
            }
        }
    }
    stretches.into_iter().map(|(_, columns)| columns).collect()
}

/// Returns a player's label in two parts: the name, and a note that either lists the mode and aids or
/// identifies a reference player.
fn label(name: &str, reference: bool) -> Label {
    match name.split_once(" (") {
        Some((name, note)) => Label { name: name.to_owned(), note: note.trim_end_matches(')').to_owned() },
        None => Label {
            name: name.to_owned(),
            note: if reference { "reference".to_owned() } else { String::new() },
        },
    }
}

/// Plots all players' win rates across all episodes.
pub(super) fn win_rates(study: &Study) -> Plot {
    let rows: Vec<ForestRow> = study
        .leaderboard
        .iter()
        .map(|row| {
            let player = &study.players[row.player];
            let label = label(&player.label(), player.is_reference());
            forest_row(label, &row.scores, player.is_reference())
        })
        .collect();
    Plot {
        head: "Win rates".to_owned(),
        svg: forest("win rates with Wilson intervals", &rows),
        caption: "The intervals are 95% intervals for games like these or, for a single game, for exactly \
                  its levels."
            .to_owned(),
    }
}

/// Plots win rates by commitment, one plot per player and kind of game.
pub(super) fn horizons(study: &Study) -> Vec<Plot> {
    let plot = |row: &HorizonRow| {
        let points: Vec<CurvePoint> = row
            .rates
            .iter()
            .filter_map(|found| {
                let rate = found.rate?;
                let (name, band) = (found.commit.clone(), [rate.low, rate.high]);
                Some(CurvePoint { at: found.ticks, name, share: rate.value, band })
            })
            .collect();
        horizon_plot(row.title(), "commitment", &points, row.horizon, "ticks")
    };
    study.horizons.iter().map(plot).collect()
}

/// Plots win rates by budget of output tokens, one plot per player and tier.
pub(super) fn thinking(study: &Study) -> Vec<Plot> {
    let plot = |row: &ThinkingRow| {
        let points: Vec<CurvePoint> = row
            .rates
            .iter()
            .filter_map(|found| {
                let rate = found.rate?;
                let (at, name) = (f64::from(found.budget), found.budget.to_string());
                Some(CurvePoint { at, name, share: rate.value, band: [rate.low, rate.high] })
            })
            .collect();
        horizon_plot(row.title(), "tokens per answer", &points, row.horizon, "tokens per answer")
    };
    study.thinking.iter().map(plot).collect()
}

/// Plots win rates by a dose, with the dose at which half of the episodes are won.
fn horizon_plot(head: String, by: &str, points: &[CurvePoint], found: Horizon, unit: &str) -> Plot {
    let marked = found.horizon.map(|horizon| (horizon.value, [horizon.low, horizon.high]));
    let svg = curve(&format!("{head}: win rate by {by}"), points, marked);
    let (value, interval) = (found.told_value(), found.told_interval());
    let caption = match value == interval {
        true => format!("Horizon: {value} {unit}"),
        false => format!("Horizon: {value} {unit}, 95%: {interval}"),
    };
    Plot { head, svg, caption }
}

/// Plots win rates by game, one plot per player.
pub(super) fn win_rates_by_game(study: &Study) -> Vec<Group> {
    let group = |sweep: &evaluation::study::Sweep| {
        let player = &study.players[sweep.player];
        let mut games: Vec<_> = sweep.games.iter().filter(|row| row.scores.episodes > 0).collect();
        games.sort_by(|a, b| {
            let rate = |scores: &Scores| scores.win_rate.map_or(-1.0, |rate| rate.value);
            rate(&b.scores).total_cmp(&rate(&a.scores))
        });
        let rows: Vec<ForestRow> = games
            .into_iter()
            .map(|row| {
                let label = Label { name: study.title(row.game).to_owned(), note: String::new() };
                forest_row(label, &row.scores, player.is_reference())
            })
            .collect();
        let svg = forest("win rates by game", &rows);
        let plot = Plot { head: String::new(), svg, caption: String::new() };
        Group { name: format!("{}: win rate by game", player.label()), plots: vec![plot] }
    };
    study.sweeps.iter().filter(|sweep| !sweep.games.is_empty()).map(group).collect()
}

fn forest_row(label: Label, scores: &Scores, reference: bool) -> ForestRow {
    let share = scores.win_rate.map(|rate| (rate.value, [rate.low, rate.high]));
    let of = format!("{}/{}", scores.wins, scores.episodes);
    ForestRow { label, share, of, reference }
}

/// Plots the failure-mode metrics in won episodes and in all other episodes.
pub(super) fn failures(study: &Study) -> Vec<Plot> {
    let shown = [
        FailureMeasure::BumpRate,
        FailureMeasure::MaxBumps,
        FailureMeasure::LateBumpRate,
        FailureMeasure::OscillationRate,
    ];
    let modes = study.failures.iter().filter(|mode| shown.contains(&mode.measure));
    let plot = |mode: &evaluation::study::FailureMode| {
        let most = mode.won.iter().chain(&mode.lost).copied().fold(1.0, f64::max);
        let scale = if mode.measure == FailureMeasure::MaxBumps { [0.0, most] } else { [0.0, 1.0] };
        let groups =
            [Violin { name: "won", values: &mode.won }, Violin { name: "not won", values: &mode.lost }];
        let svg = violins(mode.measure.title(), &groups, scale);
        Plot { head: mode.measure.title().to_owned(), svg, caption: String::new() }
    };
    modes.map(plot).collect()
}

/// Plots the correlation matrices. Returns no plots without episodes.
pub(super) fn correlations(study: &Study) -> Vec<Plot> {
    if study.correlations.episodes == 0 {
        return Vec::new();
    }
    let plot = |head: &str, of: fn(&Correlation) -> Option<Test>| {
        let mut cells = vec![vec![None; CORRELATED.len()]; CORRELATED.len()];
        for pair in &study.correlations.pairs {
            let [column, row] = pair.pair;
            cells[row][column] = of(pair).map(|test| (test.r, corrected(test.adjusted)));
        }
        let svg = matrix(head, &CORRELATED, &cells);
        Plot { head: head.to_owned(), svg, caption: String::new() }
    };
    vec![plot("Pearson", |pair| pair.pearson), plot("Spearman", |pair| pair.spearman)]
}

/// Formats a p-value, such as `p < 0.001`.
fn corrected(p: f64) -> String {
    if p < 0.001 { "p < 0.001".to_owned() } else { format!("p {p:.3}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_fit_into_a_cell() {
        assert_eq!([0.0, 0.004, 0.456, 1.0].map(two_digits), ["0", "0", ".46", "1"]);
    }

    #[test]
    fn players_are_told_in_two_lines() {
        let check = |name: &str, reference, expect: [&str; 2]| {
            let Label { name, note } = label(name, reference);
            assert_eq!([name.as_str(), note.as_str()], expect);
        };
        check("a-model (zero-shot, coordinates)", false, ["a-model", "zero-shot, coordinates"]);
        check("random", true, ["random", "reference"]);
    }
}
