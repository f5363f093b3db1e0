//! The timeline report: a page, and all numbers as JSON, CSV and LaTeX.

mod page;
mod told;

use crate::{File, PageError};
use evaluation::scale::Timeline;

/// Returns the timeline report's files: `timeline.html`, `timeline.json` and the files in `tables/`. The same
/// timeline gives identical bytes.
///
/// # Errors
///
/// Returns an error if the page cannot be rendered.
pub fn timeline_report(timeline: &Timeline) -> Result<Vec<File>, PageError> {
    let json = serde_json::to_string_pretty(timeline);
    let json = json.map_err(PageError::failed("the timeline"))? + "\n";
    let tables = timeline.tables();
    let mut files = vec![
        ("timeline.html".to_owned(), page::render(timeline, &tables)?),
        ("timeline.json".to_owned(), json),
    ];
    for table in &tables {
        files.push((format!("tables/{}.csv", table.id), table.to_csv()));
        files.push((format!("tables/{}.tex", table.id), table.to_latex()));
    }
    Ok(files.into_iter().map(File::text).collect())
}
