//! The report on a set of levels as files: `report.json`, `report.html` (one page that needs nothing else) and `sheet.png`.

mod boards;
mod page;
mod plots;
mod sections;

use crate::failure::Failure;
use crate::verbs::verify::failure;
use engine::{Analysis, Level};
use forge::levels::report::LevelSetReport;
use snapshots::Draft;

/// What the report does not hold, and its pictures need.
pub(crate) struct Pictures<'a> {
    /// The game, as people call it.
    pub(crate) title: &'a str,
    /// What its rules mean.
    pub(crate) analysis: &'a Analysis,
    /// The levels, in the order of the report's rows.
    pub(crate) levels: &'a [Level],
    /// The game's own levels.
    pub(crate) examples: &'a [Level],
    /// How long it took; shown on the page, and nowhere in the JSON.
    pub(crate) seconds: Option<f64>,
}

/// Writes `report.json`, `report.html` and `sheet.png`. The JSON depends on the report alone.
pub(crate) fn write_level_report(
    draft: Draft,
    report: &LevelSetReport,
    pictures: &Pictures<'_>,
) -> Result<(), Failure> {
    let json = report.to_json().map_err(|error| Failure::environment(error, "the report"))?;
    let boards = boards::Boards::draw(report, pictures)?;
    let html = page::render(report, pictures, &boards)?;
    for (name, bytes) in
        [("report.json", json.as_bytes()), ("report.html", html.as_bytes()), ("sheet.png", &boards.sheet)]
    {
        draft.write(name, bytes).map_err(failure)?;
    }
    draft.commit().map_err(failure)
}

#[cfg(test)]
mod tests;
