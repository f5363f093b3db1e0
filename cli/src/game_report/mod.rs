//! The report on a set of games as files: `report.json`, `report.html` (one page that needs nothing else) and `sheet.png`.

mod frames;
mod page;
mod sections;

use crate::failure::Failure;
use crate::verbs::verify::failure;
use forge::games::report::{GameSetReport, ReportedGame};
use snapshots::Draft;

/// What the report does not hold, and its page needs.
pub(crate) struct Showcase<'a> {
    /// What the set is called.
    pub(crate) title: &'a str,
    /// The games, in the order of the report's rows.
    pub(crate) games: &'a [ReportedGame],
    /// How long it took; shown on the page, and nowhere in the JSON.
    pub(crate) seconds: Option<f64>,
}

/// Writes `report.json`, `report.html` and `sheet.png`. The JSON depends on the report alone.
///
/// # Errors
/// Writing failed, or the pictures would be too large.
pub(crate) fn write_game_report(
    draft: Draft,
    report: &GameSetReport,
    showcase: &Showcase<'_>,
) -> Result<(), Failure> {
    let json = report.to_json().map_err(|error| Failure::environment(error, "the report"))?;
    let frames = frames::Frames::draw(showcase.games)?;
    let html = page::render(report, showcase, &frames)?;
    for (name, bytes) in
        [("report.json", json.as_bytes()), ("report.html", html.as_bytes()), ("sheet.png", &frames.sheet)]
    {
        draft.write(name, bytes).map_err(failure)?;
    }
    draft.commit().map_err(failure)
}

#[cfg(test)]
mod tests;
