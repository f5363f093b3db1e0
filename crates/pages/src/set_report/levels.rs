//! The report on a set of levels.

use super::{MOST, Sheet, Shot, Showcase, cell, failed, files, made_in};
use crate::page::{Figure, plots, words};
use crate::{File, PageError};
use base::Seed;
use engine::{Analysis, Level};
use forge::levels::report::{BINS, LevelSetReport};
use render::{Looks, Picture, Style, picture};

/// The approximate length of a board's longer side, in pixels.
const SIDE: u32 = 320;

/// Returns the report files for a set of levels. The new levels must be in the order of the report's rows.
/// They are shown next to the game's own levels. `title` is the game's title. The page shows the elapsed
/// time, but the JSON omits it.
///
/// # Errors
///
/// Returns an error if an image or the page cannot be rendered.
pub fn level_report(
    report: &LevelSetReport,
    analysis: &Analysis,
    [levels, own]: [&[Level]; 2],
    (title, method, seconds): (&str, &str, Option<f64>),
) -> Result<Vec<File>, PageError> {
    let (looks, game) = (Looks::of(analysis), analysis.game());
    // Levels are drawn in their initial state.
    let drawn = |level: &Level| -> Result<Picture, PageError> {
        let style = Style::bare(cell(level, SIDE, 32));
        picture(&looks, &game.start(level, Seed::from_text("picture")), &style).map_err(failed)
    };
    let shot = |level: &Level, head: String, line: String| -> Result<(Picture, Shot), PageError> {
        let picture = drawn(level)?;
        let figure = Some(Figure::of(&picture, format!("{head}: {line}")).map_err(failed)?);
        Ok((picture, Shot { figure, head, goal: String::new(), line, chips: Vec::new() }))
    };
    let (mut entries, mut shots) = (Vec::new(), Vec::new());
    for ((at, row), level) in report.levels.iter().enumerate().zip(levels).take(MOST) {
        let difficulty = row.difficulty();
        let comma = if difficulty.is_empty() { "" } else { ", " };
        let (picture, shot) = shot(level, format!("{at}{comma}{difficulty}"), row.remark(true))?;
        let label = row.label.map_or(String::new(), |label| format!(" {label}"));
        entries.push((picture, format!("{at}{label}, {}", row.remark(false))));
        shots.push(shot);
    }
    let example = |(at, level): (usize, &Level)| {
        let line = format!("{} × {}", level.columns(), level.rows());
        Ok(shot(level, format!("level {at}"), line)?.1)
    };
    let examples = own.iter().enumerate().map(example).collect::<Result<_, PageError>>()?;
    let ranges = report.ranges.iter().map(|range| {
        let caption = format!("{} of {} cells hold a level", range.occupied, BINS * BINS);
        (plots::range(range), caption)
    });
    let (count, left_out) = (report.levels.len() as u64, report.levels.len() - shots.len());
    let more = if left_out > 0 { format!(" {left_out} more are in the table below.") } else { String::new() };
    let showcase = Showcase {
        title: format!("{title}: {method} levels"),
        subtitle: format!(
            "{} · rules {} · semantics {}, generation {}{}",
            words::many(count, "level"),
            game.digest().short(),
            engine::SEMANTICS,
            generators::GENERATION,
            made_in(seconds)
        ),
        manual: "generate-levels",
        items: ["The levels".to_owned(), format!("The levels in their first tick.{more}")],
        pictures: shots,
        examples,
        ranges: ranges.collect(),
        costs: None,
        grids: &["asked"],
        sheet: Sheet(entries, 5, 300),
    };
    files(&report.set, &showcase)
}
