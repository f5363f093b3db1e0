//! The report on a set of levels or games as files: `report.json`, `report.html` (one page that needs nothing else) and
//! `sheet.png`.

mod games;
mod levels;
mod page;

pub(crate) use games::game_report;
pub(crate) use levels::level_report;

use crate::failure::Failure;
use crate::page::Figure;
use render::{Picture, RenderError, png, sheet};
use report::SetReport;
use serde::Serialize;
use snapshots::Draft;

/// The parts of a page that a [`SetReport`] does not hold.
#[derive(Serialize)]
pub(crate) struct Showcase<'a> {
    title: String,
    /// The line under it.
    subtitle: String,
    /// The page of the manual that explains the figures.
    manual: &'static str,
    /// The heading of the pictures, and a remark on them.
    items: [String; 2],
    pictures: Vec<Shot>,
    /// The game's own levels.
    examples: Vec<Shot>,
    /// Expressive ranges as SVG, each with its caption.
    ranges: Vec<(String, String)>,
    /// The cost of the judges as SVG, and the figure's caption.
    costs: Option<(String, String)>,
    /// Tables beside the pictures, by their names.
    #[serde(skip)]
    grids: &'a [&'static str],
    #[serde(skip)]
    sheet: Sheet,
}

/// The contact sheet: pictures with their captions, pictures in a row, and pixels of a picture's place.
struct Sheet(Vec<(Picture, String)>, usize, u32);

/// A level or a game in a picture.
#[derive(Serialize)]
struct Shot {
    figure: Option<Figure>,
    head: String,
    /// The way to win a game.
    goal: String,
    line: String,
    /// The difficulties of a game's levels: class and words.
    chips: Vec<(String, String)>,
}

/// Items that are drawn at most; the tables tell of all.
const MOST: usize = 120;

/// Writes `report.json`, `report.html` and `sheet.png`. The JSON depends on the report alone, and time is no part of it.
fn write(draft: Draft, report: &SetReport, showcase: &Showcase<'_>) -> Result<(), Failure> {
    let json = report.to_json().map_err(|error| Failure::environment(error, "the report"))?;
    let html = page::render(report, showcase)?;
    let Sheet(entries, columns, place) = &showcase.sheet;
    let sheet = sheet(entries, *columns, *place).and_then(|sheet| png(&sheet)).map_err(failed)?;
    for (name, bytes) in
        [("report.json", json.as_bytes()), ("report.html", html.as_bytes()), ("sheet.png", &sheet)]
    {
        draft.write(name, bytes)?;
    }
    draft.commit().map_err(Failure::from)
}

/// The side of a cell in pixels where a board's longer side is about so many pixels.
fn cell(level: &engine::Level, side: u32, most: u32) -> u32 {
    let longest = u32::try_from(level.columns().max(level.rows())).unwrap_or(u32::MAX);
    (side / longest.max(1)).clamp(8, most)
}

fn failed(error: RenderError) -> Failure {
    Failure::environment(error, "the pictures of the report")
}

/// `, made in 3.5 s`; nothing of sets whose making was not timed.
fn made_in(seconds: Option<f64>) -> String {
    seconds.map_or(String::new(), |seconds| format!(" · made in {} s", crate::page::words::short(seconds)))
}

#[cfg(test)]
mod tests;
