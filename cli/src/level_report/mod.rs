//! The report on a set of levels as files: `report.json`, `report.html` (one page that needs nothing else) and `sheet.png`.

mod boards;
mod page;
mod plots;
mod sections;
mod words;

use crate::failure::Failure;
use engine::{Analysis, Level};
use snapshots::levels::report::LevelSetReport;
use std::path::Path;

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

/// Writes `report.json`, `report.html` and `sheet.png` into a folder, which is made if it is not there. The JSON depends on
/// the report alone.
pub(crate) fn write_level_report(
    dir: &Path,
    report: &LevelSetReport,
    pictures: &Pictures<'_>,
) -> Result<(), Failure> {
    let failed = |error, path: &Path| Failure::surroundings(error, path.display());
    std::fs::create_dir_all(dir).map_err(|error| failed(error, dir))?;
    let json = report.to_json().map_err(|error| Failure::surroundings(error, "the report"))?;
    let boards = boards::Boards::draw(report, pictures)?;
    let html = page::render(report, pictures, &boards)?;
    for (name, bytes) in
        [("report.json", json.as_bytes()), ("report.html", html.as_bytes()), ("sheet.png", &boards.sheet)]
    {
        let path = dir.join(name);
        std::fs::write(&path, bytes).map_err(|error| failed(error, &path))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
