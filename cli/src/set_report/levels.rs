//! A set of levels as a page.

use super::{MOST, Sheet, Shot, Showcase, cell, failed, figure, made_in, write};
use crate::failure::Failure;
use crate::page::{plots, words};
use engine::{Analysis, Level, Seed};
use forge::levels::report::{BINS, LevelSetReport};
use render::{Looks, Picture, Style, picture};
use snapshots::Draft;

/// The parts of a page on levels that the report does not hold.
pub(crate) struct Pictures<'a> {
    /// The game, as people call it.
    pub(crate) title: &'a str,
    pub(crate) method: &'a str,
    /// The meaning of the game's rules.
    pub(crate) analysis: &'a Analysis,
    /// The levels, in the order of the report's rows.
    pub(crate) levels: &'a [Level],
    /// The game's own levels.
    pub(crate) examples: &'a [Level],
    /// The time of making; shown on the page, and nowhere in the JSON.
    pub(crate) seconds: Option<f64>,
}

/// Pixels of the longer side of a board, about.
const SIDE: u32 = 320;

pub(crate) fn level_report(
    draft: Draft,
    report: &LevelSetReport,
    pictures: &Pictures<'_>,
) -> Result<(), Failure> {
    let Pictures { title, method, analysis, seconds, .. } = *pictures;
    let (looks, game) = (Looks::of(analysis), analysis.game());
    // As they are in the first tick.
    let drawn = |level: &Level| -> Result<Picture, Failure> {
        let style = Style::bare(cell(level, SIDE, 32));
        picture(&looks, &game.start(level, Seed::from_text("picture")), &style).map_err(failed)
    };
    let shot = |level: &Level, head: String, line: String| -> Result<(Picture, Shot), Failure> {
        let picture = drawn(level)?;
        let figure = Some(figure(&picture, &format!("{head}: {line}"))?);
        Ok((picture, Shot { figure, head, goal: String::new(), line, chips: Vec::new() }))
    };
    let (mut entries, mut shots) = (Vec::new(), Vec::new());
    for ((at, row), level) in report.levels.iter().enumerate().zip(pictures.levels).take(MOST) {
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
    let examples = pictures.examples.iter().enumerate().map(example).collect::<Result<_, Failure>>()?;
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
        items: ["The levels".to_owned(), format!("As they are in the first tick.{more}")],
        pictures: shots,
        examples,
        ranges: ranges.collect(),
        grids: &["asked"],
        sheet: Sheet(entries, 5, 300),
    };
    write(draft, &report.set, &showcase)
}
