//! The report on a set of levels or games. It consists of three files: `report.json`, the self-contained page
//! `report.html`, and `sheet.png`.

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

/// The parts of a page that the [`SetReport`] does not contain.
#[derive(Serialize)]
struct Showcase<'a> {
    title: String,
    /// The line below the title.
    subtitle: String,
    /// The manual page that explains the figures.
    manual: &'static str,
    /// The heading above the images, and a note on the images.
    items: [String; 2],
    pictures: Vec<Shot>,
    /// The images of the levels that the game already had.
    examples: Vec<Shot>,
    /// The expressive range plots as SVG, each with its caption.
    ranges: Vec<(String, String)>,
    /// The plot of the judges' costs as SVG, with its caption.
    costs: Option<(String, String)>,
    /// The IDs of the tables shown next to the images.
    #[serde(skip)]
    grids: &'a [&'static str],
    #[serde(skip)]
    sheet: Sheet,
}

/// A contact sheet. It consists of the images with their captions, the number of images per row, and the side length,
/// in pixels, of the square that each image must fit.
struct Sheet(Vec<(Picture, String)>, usize, u32);

/// An image of a level or a game.
#[derive(Serialize)]
struct Shot {
    figure: Option<Figure>,
    head: String,
    /// A description of how to win the game.
    goal: String,
    line: String,
    /// The difficulty labels of a game's levels, each with its class and text.
    chips: Vec<(String, String)>,
}

/// The maximum number of levels or games to draw. The tables contain all levels or games.
const MOST: usize = 120;

/// Returns `report.json`, `report.html` and `sheet.png`. The JSON depends only on the report, and contains no
/// elapsed times.
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

/// Returns the cell size in pixels, chosen so that the board's longer side has about `side` pixels.
fn cell(level: &engine::Level, side: u32, most: u32) -> u32 {
    let longest = u32::try_from(level.columns().max(level.rows())).unwrap_or(u32::MAX);
    (side / longest.max(1)).clamp(8, most)
}

fn failed(error: RenderError) -> PageError {
    PageError::failed("the pictures of the report")(error)
}

/// Returns a phrase such as ` · made in 3.5 s`, or an empty text if the duration is unknown.
fn made_in(seconds: Option<f64>) -> String {
    seconds.map_or(String::new(), |seconds| format!(" · made in {} s", crate::page::words::short(seconds)))
}

#[cfg(test)]
mod tests;
