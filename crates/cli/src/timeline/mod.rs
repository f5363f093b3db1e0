//! The timeline as files: one page for people, and all its numbers as JSON, CSV and LaTeX.

mod page;
mod told;

use crate::failure::Failure;
use evaluation::scale::Timeline;
use snapshots::Draft;

/// Writes `timeline.html`, `timeline.json` and `tables/`, and returns their names. The same timeline gives the same bytes.
pub(crate) fn write_timeline(draft: Draft, timeline: &Timeline) -> Result<Vec<String>, Failure> {
    let json = serde_json::to_string_pretty(timeline);
    let json = json.map_err(|error| Failure::environment(error, "the timeline"))? + "\n";
    let tables = timeline.tables();
    let mut files = vec![
        ("timeline.html".to_owned(), page::render(timeline, &tables)?),
        ("timeline.json".to_owned(), json),
    ];
    for table in &tables {
        files.push((format!("tables/{}.csv", table.id), table.to_csv()));
        files.push((format!("tables/{}.tex", table.id), table.to_latex()));
    }
    for (name, text) in &files {
        draft.write(name, text.as_bytes())?;
    }
    draft.commit()?;
    Ok(files.into_iter().map(|(name, _)| name).collect())
}
