//! The report on evaluations as files: one self-contained page, Markdown, JSON, and every table as CSV and LaTeX.

mod page;
mod plots;
mod replay;
mod sections;
mod told;

use crate::failure::Failure;
use evaluation::study::Study;
use evaluation::{Entrant, Evaluation};
use serde::Serialize;
use snapshots::Draft;

/// The input of a report.
pub(crate) struct Results<'a> {
    pub(crate) study: &'a Study,
    /// The results folders, for replays and settings.
    pub(crate) evaluations: &'a [Evaluation],
    /// The number of episodes of each player that the page replays.
    pub(crate) replays: usize,
}

/// The document `report.json`. It names no folder, so that the same results give the same bytes wherever they are
/// stored.
#[derive(Serialize)]
struct Document<'a> {
    evaluations: Vec<Asked<'a>>,
    study: &'a Study,
}

/// The settings of a player, without the games, which the study lists.
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

/// Writes `report.html`, `report.md`, `report.json` and `tables/`, and returns their names. The same results give the
/// same bytes.
pub(crate) fn write_evaluation_report(draft: Draft, results: &Results<'_>) -> Result<Vec<String>, Failure> {
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
    let json = json.map_err(|error| Failure::environment(error, "the report"))? + "\n";
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
    for (name, text) in &files {
        draft.write_of_any_size(name, text.as_bytes())?;
    }
    draft.commit()?;
    Ok(files.into_iter().map(|(name, _)| name).collect())
}
