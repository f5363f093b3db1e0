//! `arcade docs`: the manual.

use crate::console::Console;
use crate::failure::Answer;
use crate::manual::{self, Page, Section};
use crate::shell;
use itertools::Itertools;
use serde_json::json;
use std::fmt::Write;

/// Prints a page of the manual, as text; without PAGE, lists the pages. Any other word is looked for in all pages.
///
/// The code of a diagnostic is a page (no-avatar), and so is every sprite class, effect and termination of VGDL
/// (killSprite). Names in [brackets] in a page are pages themselves. --json prints the page as Markdown.
///
/// Examples: arcade docs first-game
/// and: arcade docs boat
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The page's name, or words to look for
    #[arg(value_name = "PAGE")]
    page: Vec<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let mut pages = manual::pages();
    pages.sort_by_key(Page::section);
    let wanted = args.page.join(" ");
    if wanted.is_empty() {
        let entry =
            |page: &Page| json!({ "page": page.name, "folder": page.folder(), "title": page.title() });
        console.document(&json!({ "pages": pages.iter().map(entry).collect::<Vec<_>>() }))?;
        console.file(&list(&pages));
        return Ok(true);
    }
    let about_verb = VERBS.iter().find(|(verb, _)| *verb == wanted).map_or(&[][..], |(_, pages)| pages);
    if let Ok(page) = manual::page(&wanted) {
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

/// The pages that describe a verb without a page of its own name, the best first.
const VERBS: [(&str, &[&str]); 23] = [
    ("calibrate", &["scale"]),
    ("clean", &["command-line"]),
    ("completions", &["command-line"]),
    ("contamination", &["memory"]),
    ("describe", &["prompts"]),
    ("docs", &["command-line"]),
    ("fmt", &["lsp"]),
    ("gallery", &["studio"]),
    ("generate", &["generate-levels", "generate-games"]),
    ("keygen", &["trust", "first-month"]),
    ("keys", &["trust"]),
    ("log", &["trust", "first-month"]),
    ("man", &["command-line"]),
    ("merge", &["recipes"]),
    ("new", &["first-game"]),
    ("play", &["first-game", "studio"]),
    ("regenerate", &["snapshots", "recipes"]),
    ("release", &["first-month", "recipes"]),
    ("render", &["rendering"]),
    ("sign", &["trust", "first-month"]),
    ("study", &["scale", "timeline", "memory", "well"]),
    ("verify", &["snapshots", "trust"]),
    ("help", &["command-line"]),
];

/// The most pages that a search lists.
const SHOWN: usize = 8;

/// Lists the pages about a word that is not a page.
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
    console.say(format_args!("there is no page `{wanted}`; these pages are about it:\n"));
    let width = hits.iter().map(|(page, _)| page.name.len()).max().unwrap_or_default();
    for (page, line) in &hits {
        console.say(format_args!("{:<width$}  {line}", page.name));
    }
    console.say("\narcade docs PAGE prints a page");
    Ok(true)
}

/// The folders whose pages are known by their names, such as codes of diagnostics: they are listed without titles.
const NAMED: [&str; 5] =
    ["diagnostics", "ontology/effects", "ontology/sprites", "ontology/terminations", "spec"];
const COLUMNS: usize = 100;

fn list(pages: &[Page]) -> String {
    let width = pages.iter().filter(|page| !NAMED.contains(&page.folder())).map(|page| page.name.len()).max();
    let width = width.unwrap_or(0);
    let mut text = String::new();
    let own = |page: &&Page| {
        !NAMED.contains(&page.folder()) || NAMED.iter().any(|folder| folder.ends_with(&page.name))
    };
    for (section, heading) in [
        (Section::Start, "Start here:"),
        (Section::Guides, "\nGuides:"),
        (Section::Reference, "\nThe words of VGDL, and diagnostics:"),
        (Section::Internals, "\nHow the suite works internally:"),
    ] {
        let _ = writeln!(text, "{heading}");
        for page in pages.iter().filter(|page| page.section() == section).filter(own) {
            let _ = writeln!(text, "{:<width$}  {}", page.name, page.title());
        }
        for folder in NAMED {
            let named = pages.iter().filter(|page| page.folder() == folder && page.section() == section);
            let mut column = 0;
            for page in named.filter(|page| !folder.ends_with(&page.name)) {
                if column == 0 {
                    let _ = write!(text, "\n{folder}:");
                    column = COLUMNS;
                }
                let separator = if column + page.name.len() + 2 > COLUMNS { "\n  " } else { "  " };
                column = if separator == "\n  " { 2 } else { column + 2 } + page.name.len();
                let _ = write!(text, "{separator}{}", page.name);
            }
            if column > 0 {
                text.push('\n');
            }
        }
    }
    text.push_str("\narcade docs PAGE prints a page, or lists the pages about any other word\n");
    text
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
