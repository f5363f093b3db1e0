//! `arcade docs`: the manual.

use crate::book::manual::{self, Page, Section};
use crate::console::Console;
use crate::failure::Answer;
use crate::shell;
use itertools::Itertools;
use serde_json::json;
use std::fmt::Write;

/// Prints a page of the manual as text. Without PAGE, lists the pages. Any other word is searched for in all pages.
///
/// Every diagnostic code is a page, such as no-avatar, and so is every sprite class, effect and termination of VGDL
/// (killSprite). Names in [brackets] in a page are pages themselves. --json prints the page as Markdown.
///
/// Examples: arcade docs first-game,
/// arcade docs boat
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The page's name, or words to look for
    #[arg(value_name = "PAGE")]
    page: Vec<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let pages = manual::pages();
    let wanted = args.page.join(" ");
    if wanted.is_empty() {
        let entry =
            |page: &Page| json!({ "page": page.name, "folder": page.folder(), "title": page.title() });
        console.document(&json!({ "pages": pages.iter().map(entry).collect::<Vec<_>>() }))?;
        console.file(&list(&pages));
        return Ok(true);
    }
    let about_verb = VERBS.iter().find(|(verb, _)| *verb == wanted).map_or(&[][..], |(_, pages)| pages);
    let replaced = manual::replaced(&wanted).filter(|_| manual::page(&wanted).is_err());
    if let Ok(page) = manual::page(replaced.unwrap_or(&wanted)) {
        if let Some(new) = replaced {
            let command = shell::command(["docs", new]);
            console.remark(format_args!("the page `{wanted}` is now part of `{command}`\n"));
        }
        if !about_verb.is_empty() {
            let pages =
                about_verb.iter().map(|page| format!("`{}`", shell::command(["docs", page]))).join(" and ");
            console.remark(format_args!("the command `arcade {wanted}` is described in {pages}\n"));
        }
        console.document(&json!({ "page": page.name, "title": page.title(), "text": page.text }))?;
        console.file(&page.plain(&pages));
        return Ok(true);
    }
    found(&pages, &wanted, about_verb, console)
}

/// The pages about subcommands that have no page with the same name, most relevant first.
const VERBS: [(&str, &[&str]); 25] = [
    ("calibrate", &["calibrate", "scale"]),
    ("clean", &["command-line"]),
    ("completions", &["command-line"]),
    ("contamination", &["memory"]),
    ("describe", &["prompts"]),
    ("design", &["model-designs"]),
    ("docs", &["command-line"]),
    ("fmt", &["lsp"]),
    ("gallery", &["studio"]),
    ("generate", &["new-games", "generate-levels"]),
    ("keygen", &["trust", "first-month"]),
    ("keys", &["trust"]),
    ("log", &["trust", "first-month"]),
    ("man", &["command-line"]),
    ("merge", &["mint"]),
    ("new", &["first-game"]),
    ("play", &["first-release", "first-game", "studio"]),
    ("regenerate", &["snapshots", "minting"]),
    ("release", &["first-month", "mint", "recipes"]),
    ("render", &["rendering"]),
    ("sign", &["trust", "first-month"]),
    ("stream", &["train"]),
    ("study", &["calibrate", "timeline", "memory", "well"]),
    ("verify", &["snapshots", "trust"]),
    ("help", &["command-line"]),
];

/// The maximum number of pages listed by a search.
const SHOWN: usize = 8;

/// Lists the pages about a word that is not a page name.
fn found(pages: &[Page], wanted: &str, about_verb: &[&str], console: &Console) -> Answer {
    let of_verb = about_verb.iter().filter_map(|name| pages.iter().find(|page| page.name == *name));
    let of_verb = of_verb.map(|page| (page, page.title().to_owned()));
    let hits = manual::search(pages, wanted).into_iter().map(|hit| (hit.page, hit.line));
    let hits = of_verb.chain(hits).unique_by(|(page, _)| &page.name).take(SHOWN).collect_vec();
    if hits.is_empty() {
        return Err(manual::absent(pages, wanted));
    }
    let entry =
        |(page, line): &(&Page, String)| json!({ "page": page.name, "title": page.title(), "line": line });
    console.document(&json!({ "wanted": wanted, "found": hits.iter().map(entry).collect::<Vec<_>>() }))?;
    if !about_verb.is_empty() {
        console.say(format_args!("`arcade {wanted} --help` lists the flags of `{wanted}`"));
    }
    console.say(format_args!("there is no page `{wanted}`; these pages mention the term:\n"));
    let width = hits.iter().map(|(page, _)| page.name.len()).max().unwrap_or_default();
    for (page, line) in &hits {
        console.say(format_args!("{:<width$}  {line}", page.name));
    }
    console.say("\narcade docs PAGE prints a page");
    Ok(true)
}

/// The width of name lists, in columns.
const COLUMNS: usize = 100;

/// Returns the table of contents: each section's pages with their titles, and nested pages by name only.
fn list(pages: &[Page]) -> String {
    let is_titled = |page: &Page| page.depth == 0;
    let width = pages.iter().filter(|page| is_titled(page)).map(|page| page.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for section in Section::ALL {
        let gap = if text.is_empty() { "" } else { "\n" };
        let _ = writeln!(text, "{gap}{}:", section.heading());
        let own: Vec<&Page> = pages.iter().filter(|page| page.section() == section).collect();
        for page in own.iter().filter(|page| is_titled(page)) {
            let _ = writeln!(text, "{:<width$}  {}", page.name, page.label);
        }
        for (folder, named) in &own.into_iter().filter(|page| !is_titled(page)).chunk_by(|page| page.folder())
        {
            names(folder, &named.collect_vec(), &mut text);
        }
    }
    text.push_str("\narcade docs PAGE prints a page, or lists the pages about any other word\n");
    text
}

/// Lists a folder's nested pages by name, in lines of [`COLUMNS`] characters.
fn names(folder: &str, pages: &[&Page], text: &mut String) {
    let _ = write!(text, "\n{}:", folder.rsplit('/').next().unwrap_or(folder));
    let mut column = COLUMNS;
    for page in pages.iter().filter(|page| page.path() != folder) {
        let separator = if column + page.name.len() + 2 > COLUMNS { "\n  " } else { "  " };
        column = if separator == "\n  " { 2 } else { column + 2 } + page.name.len();
        let _ = write!(text, "{separator}{}", page.name);
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::usage::tests::for_each_verb;

    #[test]
    fn every_verb_has_a_page() {
        for_each_verb(&mut |path, _| {
            let words: Vec<&str> = path.split(' ').collect();
            let [_, verb] = words[..] else { return };
            let is_listed = VERBS.iter().any(|(known, _)| *known == verb);
            assert!(is_listed || manual::page(verb).is_ok(), "{verb}");
        });
        for (verb, names) in VERBS {
            for name in names {
                let page = manual::page(name).unwrap_or_else(|error| panic!("{verb}: {error}"));
                assert!(verb == "help" || page.text.contains(verb), "{verb}: {name}");
            }
        }
    }
}
