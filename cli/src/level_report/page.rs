//! The page: one HTML file that needs nothing else.

use super::boards::{Board, Boards};
use super::{Pictures, plots, sections};
use crate::failure::Failure;
use crate::page::facts::{Fact, Section};
use crate::page::{Figure, words};
use forge::levels::report::{BINS, Control, LevelRow, LevelSetReport, OF_PLAY, Range};
use serde::Serialize;
use std::collections::BTreeSet;

const TEMPLATE: &str = include_str!("page.html");

/// A heat map in the page.
#[derive(Serialize)]
struct Heat {
    svg: String,
    caption: String,
}

/// Asked against measured.
#[derive(Serialize)]
struct Confusion {
    labels: Vec<String>,
    /// Label, its levels by measured label, those without one.
    rows: Vec<(String, Vec<u64>, u64)>,
    /// Whether some are without one.
    some_unmeasured: bool,
    pool: Vec<u64>,
}

impl Confusion {
    /// The labels that were asked for, as rows.
    fn of(control: &Control) -> Confusion {
        let labels: Vec<String> = control.labels.iter().map(ToString::to_string).collect();
        let each = labels.iter().cloned().zip(&control.table).zip(&control.unmeasured);
        let rows: Vec<(String, Vec<u64>, u64)> = each
            .map(|((label, got), none)| (label, got.clone(), *none))
            .filter(|(_, got, none)| got.iter().sum::<u64>() + none > 0)
            .collect();
        let some_unmeasured = rows.iter().any(|(_, _, none)| *none > 0);
        Confusion { rows, some_unmeasured, pool: control.pool.clone(), labels }
    }
}

/// The table of all levels.
#[derive(Serialize)]
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn of(rows: &[LevelRow]) -> Table {
        // What is told of play comes first, then what is told of the board.
        let of_play = |name: &str| OF_PLAY.contains(&name);
        let known: BTreeSet<&str> =
            rows.iter().flat_map(|row| row.measures.keys()).map(String::as_str).collect();
        let play: Vec<&str> = OF_PLAY.into_iter().filter(|name| known.contains(name)).collect();
        let board: Vec<&str> = known.into_iter().filter(|name| !of_play(name)).collect();
        let (some_asked, some_label) =
            (rows.iter().any(|row| row.asked.is_some()), rows.iter().any(|row| row.label.is_some()));
        let mut columns: Vec<String> = ["", "size", "verdict"].map(str::to_owned).to_vec();
        columns.extend(some_asked.then(|| "asked".to_owned()));
        columns.extend(some_label.then(|| "measured".to_owned()));
        let names = play.iter().chain(&["shortest", "nearest"]).chain(&board).chain(&["digest"]);
        columns.extend(names.map(|&name| name.to_owned()));
        let row = |(at, row): (usize, &LevelRow)| {
            let verdict = match &row.obstacle {
                None if row.passes => "passes".to_owned(),
                None => row.solved.clone(),
                Some(obstacle) if obstacle == "winnable" => row.solved.clone(),
                Some(obstacle) => words::not_passed(obstacle),
            };
            let none = || words::NONE.to_owned();
            let mut cells = vec![at.to_string(), format!("{} × {}", row.columns, row.rows), verdict];
            cells.extend(some_asked.then(|| words::label(row.asked)));
            cells.extend(some_label.then(|| words::label(row.label)));
            let value = |name: &&str| row.measures.get(*name).map_or_else(none, |value| words::short(*value));
            cells.extend(play.iter().map(value));
            cells.push(row.shortest.map_or_else(none, |ticks| ticks.to_string()));
            cells.push(row.nearest.map_or_else(none, words::short));
            cells.extend(board.iter().map(value));
            cells.push(row.digest.short());
            cells
        };
        Table { columns, rows: rows.iter().enumerate().map(row).collect() }
    }
}

/// All that the template shows.
#[derive(Serialize)]
struct Page<'a> {
    title: &'a str,
    method: &'a str,
    count: u64,
    digest: String,
    semantics: u32,
    generation: u32,
    seconds: Option<String>,
    headlines: Vec<Fact>,
    levels: Vec<Figure<'a>>,
    /// Levels without a picture.
    left_out: u64,
    examples: Vec<Figure<'a>>,
    heats: Vec<Heat>,
    confusion: Option<Confusion>,
    sections: Vec<Section>,
    table: Table,
}

/// The page. The same arguments give the same bytes.
pub(super) fn render(
    report: &LevelSetReport,
    pictures: &Pictures<'_>,
    boards: &Boards,
) -> Result<String, Failure> {
    let heat = |range: &Range| {
        let caption = format!("{} of {} cells hold a level", range.occupied, BINS * BINS);
        Heat { svg: plots::heat_map(range), caption }
    };
    let page = Page {
        title: pictures.title,
        method: &report.method,
        count: report.count,
        digest: report.game.short(),
        semantics: report.semantics,
        generation: report.generation,
        seconds: pictures.seconds.map(words::short),
        headlines: sections::headlines(report),
        levels: boards.levels.iter().map(Board::figure).collect(),
        left_out: report.count - boards.levels.len() as u64,
        examples: boards.examples.iter().map(Board::figure).collect(),
        heats: report.ranges.iter().map(heat).collect(),
        confusion: report.control.as_ref().map(Confusion::of),
        sections: sections::all(report),
        table: Table::of(&report.levels),
    };
    crate::page::render(TEMPLATE, &page)
}
