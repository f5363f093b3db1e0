//! The evaluation report: a self-contained page, Markdown, JSON, and every table as CSV and LaTeX.

mod page;
mod plots;
mod replay;
mod sections;
mod told;

use crate::{File, PageError};
use evaluation::study::Study;
use evaluation::{Entrant, Evaluation};
use serde::Serialize;

/// The input of an evaluation report.
pub struct Results<'a> {
    /// The study with the results.
    pub study: &'a Study,
    /// The results folders, which provide the replays and the settings.
    pub evaluations: &'a [Evaluation],
    /// The number of episodes per player that the page replays.
    pub replays: usize,
}

/// The content of `report.json`. Folder names are omitted, so that the same results give identical bytes
/// wherever they are stored.
#[derive(Serialize)]
struct Document<'a> {
    evaluations: Vec<Asked<'a>>,
    study: &'a Study,
}

/// A player's evaluation settings. The games are omitted, because the study lists them.
#[derive(Serialize)]
struct Asked<'a> {
    entrant: &'a Entrant,
    suite: &'a str,
    semantics: u32,
    snapshot: Option<base::Digest>,
    seed: &'a str,
    runs: u64,
    max_steps: u64,
}

/// Returns the report files: `report.html`, `report.md`, `report.json` and the files in `tables/`. The same
/// results give identical bytes.
///
/// # Errors
///
/// Returns an error if a log cannot be read or the page cannot be rendered.
pub fn evaluation_report(results: &Results<'_>) -> Result<Vec<File>, PageError> {
    let Results { study, evaluations, .. } = results;
    let tables = study.tables();
    let asked = evaluations.iter().map(|evaluation| {
        let evaluation = &evaluation.settings;
        Asked {
            entrant: &evaluation.entrant,
            suite: &evaluation.suite,
            semantics: evaluation.semantics,
            snapshot: evaluation.snapshot,
            seed: &evaluation.seed,
            runs: evaluation.runs,
            max_steps: evaluation.max_steps,
        }
    });
    let document = Document { evaluations: asked.collect(), study };
    let json = serde_json::to_string_pretty(&document);
    let json = json.map_err(PageError::failed("the report"))? + "\n";
    let told = told::Told::of(results);
    let mut files = vec![
        ("report.html".to_owned(), page::render(results, &told, &tables)?),
        ("report.md".to_owned(), told.markdown(&tables)),
        ("report.json".to_owned(), json),
    ];
    for table in &tables {
        files.push((format!("tables/{}.csv", table.id), table.to_csv()));
        files.push((format!("tables/{}.tex", table.id), table.to_latex()));
    }
    Ok(files.into_iter().map(File::text).collect())
}
