//! `arcade docs`: the manual.

use crate::console::Console;
use crate::failure::Answer;
use crate::manual::{self, Page};
use itertools::Itertools;
use serde_json::json;
use std::fmt::Write;

/// Prints a page of the manual, as text; without PAGE, lists the pages.
///
/// The code of a diagnostic is a page (no-avatar), and so is every sprite class, effect and termination of VGDL
/// (killSprite). Names in [brackets] in a page are pages themselves. --json prints the page as Markdown.
///
/// Example: arcade docs recipes
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The page's name
    #[arg(value_name = "PAGE")]
    page: Option<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let pages = manual::pages();
    let Some(name) = &args.page else {
        let entry =
            |page: &Page| json!({ "page": page.name, "folder": page.folder(), "title": page.title() });
        console.document(&json!({ "pages": pages.iter().map(entry).collect::<Vec<_>>() }))?;
        console.file(&list(&pages));
        return Ok(true);
    };
    let page = manual::page(name)?;
    console.document(&json!({ "page": page.name, "title": page.title(), "text": page.text }))?;
    console.file(&page.plain(&pages));
    Ok(true)
}

/// The folders whose pages are known by their names, such as codes of diagnostics: they are listed without titles.
const NAMED: [&str; 5] =
    ["diagnostics", "ontology/effects", "ontology/sprites", "ontology/terminations", "spec"];
/// The folder whose pages come last of those with titles.
const DECISIONS: &str = "decisions";
const COLUMNS: usize = 100;

fn list(pages: &[Page]) -> String {
    let width = pages.iter().filter(|page| !NAMED.contains(&page.folder())).map(|page| page.name.len()).max();
    let width = width.unwrap_or(0);
    let mut text = String::new();
    let own = |page: &&Page| {
        !NAMED.contains(&page.folder()) || NAMED.iter().any(|folder| folder.ends_with(&page.name))
    };
    let titled = pages.iter().filter(own).sorted_by_key(|page| page.folder() == DECISIONS).collect_vec();
    for page in titled {
        let _ = writeln!(text, "{:<width$}  {}", page.name, page.title());
    }
    for folder in NAMED {
        let _ = write!(text, "\n{folder}:");
        let mut column = COLUMNS;
        for page in pages.iter().filter(|page| page.folder() == folder && !folder.ends_with(&page.name)) {
            let separator = if column + page.name.len() + 2 > COLUMNS { "\n  " } else { "  " };
            column = if separator == "\n  " { 2 } else { column + 2 } + page.name.len();
            let _ = write!(text, "{separator}{}", page.name);
        }
        text.push('\n');
    }
    text.push_str("\narcade docs PAGE prints a page\n");
    text
}
