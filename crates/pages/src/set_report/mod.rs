//! The report on a set of levels or games as files: `report.json`, `report.html` (one page that needs nothing else) and
//! `sheet.png`.

mod games;
mod levels;
mod page;

pub use games::game_report;
pub use levels::level_report;

use crate::page::Figure;
use crate::{File, PageError};
use render::{Picture, RenderError, png, sheet};
use report::SetReport;
use serde::Serialize;

/// The parts of a page that a [`SetReport`] does not hold.
#[derive(Serialize)]
struct Showcase<'a> {
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

/// Returns `report.json`, `report.html` and `sheet.png`. The JSON depends on the report alone, and time is no part of it.
fn files(report: &SetReport, showcase: &Showcase<'_>) -> Result<Vec<File>, PageError> {
    let json = report.to_json().map_err(PageError::failed("the report"))?;
    let html = page::render(report, showcase)?;
    let Sheet(entries, columns, place) = &showcase.sheet;
    let sheet = sheet(entries, *columns, *place).and_then(|sheet| png(&sheet)).map_err(failed)?;
    let file = |(name, bytes): (&str, Vec<u8>)| File { name: name.to_owned(), bytes };
    Ok([("report.json", json.into_bytes()), ("report.html", html.into_bytes()), ("sheet.png", sheet)]
        .map(file)
        .into())
}

/// The side of a cell in pixels where a board's longer side is about so many pixels.
fn cell(level: &engine::Level, side: u32, most: u32) -> u32 {
    let longest = u32::try_from(level.columns().max(level.rows())).unwrap_or(u32::MAX);
    (side / longest.max(1)).clamp(8, most)
}

fn failed(error: RenderError) -> PageError {
    PageError::failed("the pictures of the report")(error)
}

/// `, made in 3.5 s`; nothing of sets whose making was not timed.
fn made_in(seconds: Option<f64>) -> String {
    seconds.map_or(String::new(), |seconds| format!(" · made in {} s", crate::page::words::short(seconds)))
}

#[cfg(test)]
mod tests;
