//! The pages of the book in `docs/`, which are embedded in the binary and formatted for a terminal.
//! `docs/SUMMARY.md` is the table of contents.

use crate::failure::Failure;
use include_dir::{Dir, include_dir};
use itertools::Itertools;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::ops::Range;

static DOCS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/docs");

pub(crate) struct Page {
    /// The argument of `arcade docs` that selects the page: the file's name, or the folder's name for a
    /// folder's README.
    pub(crate) name: String,
    /// The path below `docs/`, without the extension.
    path: String,
    /// The page's title in the table of contents.
    pub(crate) label: String,
    /// The page's depth in the table of contents: 0 for a page listed directly in a section, and greater than
    /// 0 for a page listed only by name.
    pub(crate) depth: usize,
    /// The page's Markdown text.
    pub(crate) text: &'static str,
}

/// The manual's sections, in the order of the table of contents. Each section is a folder in `docs/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Section {
    /// Tutorials.
    Start,
    /// Guides to individual tasks.
    HowTo,
    /// Commands, keys, files and terms.
    Reference,
    /// Methods and the reasons for them.
    Explanation,
    /// Reviews, measurements and decisions.
    Lab,
}

impl Section {
    pub(crate) const ALL: [Section; 5] =
        [Section::Start, Section::HowTo, Section::Reference, Section::Explanation, Section::Lab];

    /// Returns the section's heading in the table of contents.
    pub(crate) fn heading(self) -> &'static str {
        match self {
            Section::Start => "Start",
            Section::HowTo => "How to",
            Section::Reference => "Reference",
            Section::Explanation => "Explanation",
            Section::Lab => "Lab notes",
        }
    }

    fn folder(self) -> &'static str {
        match self {
            Section::Start => "start",
            Section::HowTo => "how-to",
            Section::Reference => "reference",
            Section::Explanation => "explanation",
            Section::Lab => "lab",
        }
    }
}

/// The table of contents in mdBook's format: section headings, and nested lists of links to pages.
const CONTENTS: &str = "SUMMARY.md";

/// Removed pages, each with its replacement.
const REPLACED: [(&str, &str); 1] = [("decision", "decisions")];

/// Returns all pages in the order of the table of contents.
pub(crate) fn pages() -> Vec<Page> {
    let contents = DOCS.get_file(CONTENTS).and_then(include_dir::File::contents_utf8).unwrap_or_default();
    contents.lines().filter_map(Page::listed).collect()
}

/// Returns the page that has replaced the page called `wanted`; `None` if there is no such page.
pub(crate) fn replaced(wanted: &str) -> Option<&'static str> {
    REPLACED.iter().find(|(old, _)| *old == stem(wanted)).map(|(_, new)| *new)
}

/// Returns the page with the given name or path.
pub(crate) fn page(wanted: &str) -> Result<Page, Failure> {
    let mut pages = pages();
    match find(&pages, wanted) {
        Some(found) => Ok(pages.swap_remove(found)),
        None => Err(absent(&pages, wanted)),
    }
}

/// Returns the failure for a word that is not a page name and does not occur on any page.
pub(crate) fn absent(pages: &[Page], wanted: &str) -> Failure {
    let near = engine::nearest(wanted, pages.iter().map(|page| page.name.as_str()));
    let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    malformed!("there is no page `{wanted}`; {near}`arcade docs` lists all pages")
}

/// A page that contains the search terms.
pub(crate) struct Hit<'a> {
    pub(crate) page: &'a Page,
    /// The best matching line: the title or a heading that contains the search terms, if there is one.
    pub(crate) line: String,
}

/// The points that a matching line adds to a page's score: for the title (in proportion to its matching
/// words), for a heading or a line of the first paragraph, and for any other line.
const POINTS: [usize; 3] = [30, 8, 1];
/// The maximum number of lines that earn the points for any other line.
const COUNTED: usize = 10;

/// The minimum number of matching lines for a beginners' page to count as an explanation of the search terms.
/// Such a page ranks before all other pages.
const EXPLAINED: usize = 3;

/// Returns the pages that contain every word in `wanted`, best match first. A page whose title consists of these words
/// comes before all others.
pub(crate) fn search<'a>(pages: &'a [Page], wanted: &str) -> Vec<Hit<'a>> {
    let wanted: Vec<String> = words(wanted).collect();
    let mut hits: Vec<((bool, bool, usize), Hit<'a>)> = Vec::new();
    for page in pages {
        let mut points = 0;
        let mut best: Option<(usize, usize, &str)> = None;
        let (mut lines, mut others) = (0, 0);
        let mut is_first_paragraph = true;
        let mut is_fenced = false;
        let mut is_missing = vec![true; wanted.len()];
        for (number, line) in page.text.lines().enumerate() {
            is_first_paragraph &= number < 2 || !line.trim().is_empty();
            is_fenced ^= line.starts_with("```");
            let has: Vec<bool> =
                wanted.iter().map(|word| words(line).any(|own| is_form(&own, word))).collect();
            let count = has.iter().filter(|&&has| has).count();
            if count == 0 || line.starts_with("```") {
                continue;
            }
            lines += 1;
            is_missing.iter_mut().zip(&has).for_each(|(missing, has)| *missing &= !has);
            let kind = match number {
                0 => 0,
                _ if !is_fenced && (is_first_paragraph || line.starts_with('#')) => 1,
                _ => 2,
            };
            others += usize::from(kind == 2);
            if kind < 2 || others <= COUNTED {
                let of_title = if kind == 0 { words(line).count().max(count) } else { 1 };
                points += POINTS[kind] * count / of_title;
            }
            let rank = (count, POINTS[kind], line);
            if best.is_none_or(|(c, p, _)| (c, p) < (count, POINTS[kind])) {
                best = Some(rank);
            }
        }
        let Some((_, _, line)) = best.filter(|_| !wanted.is_empty() && !is_missing.contains(&true)) else {
            continue;
        };
        let weight = match page.section() {
            Section::Start => 4,
            Section::HowTo | Section::Reference if page.folder() != DIAGNOSTICS => 2,
            _ => 1,
        };
        let title = page.text.lines().next().unwrap_or_default();
        let is_title = words(title).all(|own| wanted.iter().any(|word| is_form(&own, word)));
        let is_for_beginners = page.section() == Section::Start && lines >= EXPLAINED;
        hits.push(((is_title, is_for_beginners, points * weight), Hit { page, line: shown(line) }));
    }
    // The sort is stable, so pages with equal points stay in the order of the manual.
    hits.sort_by_key(|(points, _)| std::cmp::Reverse(*points));
    hits.into_iter().map(|(_, hit)| hit).collect()
}

/// Returns a text's words in lower case. For example, `killSprite` is two words.
fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    let is_inner = |c: char| c.is_alphanumeric();
    text.split(move |c| !is_inner(c))
        .flat_map(|name| {
            let starts = name
                .char_indices()
                .filter(|&(at, c)| at > 0 && c.is_uppercase() && name[..at].ends_with(char::is_lowercase));
            let cuts = [0].into_iter().chain(starts.map(|(at, _)| at)).chain([name.len()]);
            cuts.tuple_windows().map(|(from, to)| name[from..to].to_lowercase()).collect_vec()
        })
        .filter(|word| !word.is_empty())
}

/// The suffixes of inflected forms.
const ENDINGS: [&str; 7] = ["", "s", "es", "ed", "ing", "er", "ers"];

/// Returns `true` if a word is an inflected form of a search term. For example, `pushes` and `pushing` match
/// `push`, and `boat` matches `boats`.
fn is_form(own: &str, wanted: &str) -> bool {
    let stem = wanted.strip_suffix('s').unwrap_or(wanted);
    own == wanted || own.strip_prefix(stem).is_some_and(|end| ENDINGS.contains(&end))
}

/// The maximum length of a line in search results, in characters.
const LINE: usize = 80;

/// Formats a line of Markdown for search results, without the markup for headings, lists and tables.
fn shown(line: &str) -> String {
    let mut words = line.to_owned();
    for (link, inner, _) in links(line).into_iter().rev() {
        words.replace_range(link, &line[inner]);
    }
    let words = words.replace("**", "");
    let plain = words.trim_matches(['#', '|', '-', '*', '>', ' ']);
    match plain.char_indices().nth(LINE) {
        Some((end, _)) => format!("{}…", plain[..end].trim_end()),
        None => plain.to_owned(),
    }
}

/// The folder with the pages about diagnostic codes.
const DIAGNOSTICS: &str = "reference/diagnostics";

/// Returns the name or path in a reference such as `prompts.md#turn` or `ontology/`.
fn stem(wanted: &str) -> &str {
    let wanted = wanted.split('#').next().unwrap_or_default();
    let wanted = wanted.strip_prefix("docs/").unwrap_or(wanted).trim_end_matches('/');
    let wanted = wanted.strip_suffix(".md").unwrap_or(wanted);
    wanted.strip_suffix("/README").unwrap_or(wanted)
}

/// Finds a page by its name, its path or the end of its path. Pages have moved between folders, so users may
/// pass an old path.
fn find(pages: &[Page], wanted: &str) -> Option<usize> {
    let wanted = stem(wanted);
    let is_it = |page: &Page| page.name == wanted || page.path == wanted;
    let ends = |page: &Page| page.path.strip_suffix(wanted).is_some_and(|start| start.ends_with('/'));
    let nearly =
        |page: &Page| page.name.eq_ignore_ascii_case(wanted) || page.path.eq_ignore_ascii_case(wanted);
    let by = |test: &dyn Fn(&Page) -> bool| pages.iter().position(test);
    by(&is_it).or_else(|| by(&ends)).or_else(|| by(&nearly))
}

impl Page {
    /// Parses a line in the table of contents as a list item that links to a page.
    fn listed(line: &str) -> Option<Page> {
        let item = line.trim_start();
        let (label, file) = item.strip_prefix("- [")?.strip_suffix(')')?.split_once("](")?;
        let path = file.strip_suffix(".md")?;
        let path = path.strip_suffix("/README").unwrap_or(path).to_owned();
        let name = path.rsplit('/').next()?.to_owned();
        let text = DOCS.get_file(file)?.contents_utf8()?;
        Some(Page { name, path, label: label.replace('`', ""), depth: (line.len() - item.len()) / 2, text })
    }

    /// Returns the page's folder below `docs/`, or an empty text for a top-level page. A folder's README
    /// belongs to that folder.
    pub(crate) fn folder(&self) -> &str {
        // A page without a README of its name belongs to its parent folder, even if it has a folder of
        // images.
        match DOCS.get_file(format!("{}/README.md", self.path)) {
            Some(_) => &self.path,
            None => self.path.rsplit_once('/').map_or("", |(folder, _)| folder),
        }
    }

    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    pub(crate) fn section(&self) -> Section {
        let top = self.path.split('/').next().unwrap_or_default();
        Section::ALL.into_iter().find(|section| section.folder() == top).unwrap_or(Section::Lab)
    }

    pub(crate) fn title(&self) -> &str {
        self.text.lines().next().unwrap_or_default().trim_start_matches('#').trim()
    }

    /// Returns the page with its links converted to text: names of other pages in brackets, and addresses and
    /// source files in parentheses.
    pub(crate) fn plain(&self, pages: &[Page]) -> String {
        let mut plain = String::with_capacity(self.text.len());
        let mut done = 0;
        for (range, inner, target) in links(self.text) {
            plain.push_str(&self.text[done..range.start]);
            plain.push_str(&self.link(pages, &self.text[inner], &target));
            done = range.end;
        }
        plain.push_str(&self.text[done..]);
        plain
    }

    fn link(&self, pages: &[Page], text: &str, target: &str) -> String {
        let (file, _) = target.split_once('#').unwrap_or((target, ""));
        if file.is_empty() || text == target {
            return text.to_owned();
        }
        if target.contains("://") {
            return format!("{text} ({target})");
        }
        let path = resolved(self.folder(), file);
        let page = path.strip_prefix("docs/").and_then(|path| find(pages, path)).map(|found| &pages[found]);
        match page {
            Some(page) if page.name == self.name => text.to_owned(),
            Some(page) if page.name == text.trim_matches('`') => format!("[{}]", page.name),
            Some(page) => format!("{text} [{}]", page.name),
            None => format!("{text} ({path} in the source)"),
        }
    }
}

/// Returns a page's links and images: their ranges, the ranges of their texts, and their targets.
fn links(text: &str) -> Vec<(Range<usize>, Range<usize>, String)> {
    let mut links = Vec::new();
    let mut open: Option<(Range<usize>, Option<Range<usize>>, String)> = None;
    for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        match (event, &mut open) {
            (Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }), None) => {
                open = Some((range, None, dest_url.into_string()));
            }
            (Event::End(TagEnd::Link | TagEnd::Image), Some((whole, inner, target))) if *whole == range => {
                let inner = inner.take().unwrap_or(range.start..range.start);
                links.push((range, inner, std::mem::take(target)));
                open = None;
            }
            (_, Some((_, Some(inner), _))) => *inner = inner.start.min(range.start)..inner.end.max(range.end),
            (_, Some((_, inner, _))) => *inner = Some(range),
            (_, None) => {}
        }
    }
    links
}

/// Resolves a link target to a path in the source tree. The target is relative to its page's folder.
fn resolved(folder: &str, file: &str) -> String {
    let mut parts = vec!["docs"];
    for part in folder.split('/').chain(file.split('/')) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::{Path, PathBuf};

    #[test]
    fn every_page_has_a_name_and_a_title_of_its_own() {
        let pages = pages();
        assert!(pages.len() > 150, "{}", pages.len());
        for (number, page) in pages.iter().enumerate() {
            assert!(!page.title().is_empty(), "{}", page.path);
            assert_eq!(pages.iter().position(|other| other.name == page.name), Some(number), "{}", page.name);
        }
        for name in [
            "prompts",
            "docs/reference/prompts.md",
            "docs/metrics.md#intervals",
            "no-avatar",
            "diagnostics/no-avatar",
            "docs/ontology/effects/killAll.md",
            "decisions/0003-determinism",
            "ontology",
            "killall",
        ] {
            assert!(page(name).is_ok(), "{name}");
        }
        for (old, new) in REPLACED {
            assert!(page(old).is_err() && page(new).is_ok(), "{old}");
            assert_eq!(replaced(&format!("docs/{old}.md")), Some(new));
        }
        let error = page("promts").err().expect("there is no such page").to_string();
        assert!(error.contains("did you mean `prompts`?"), "{error}");
    }

    /// Checks that the table of contents lists the sections in order, and every page under its folder's
    /// section.
    #[test]
    fn the_contents_page_lists_every_page_once() {
        let contents = DOCS.get_file(CONTENTS).expect("a contents page").contents_utf8().expect("text");
        let headings: Vec<&str> =
            contents.lines().skip(1).filter_map(|line| line.strip_prefix("# ")).collect();
        assert_eq!(headings, Section::ALL.map(Section::heading));
        let pages = pages();
        let links = contents.lines().filter(|line| line.contains("](")).count();
        assert_eq!(pages.len(), links, "a line of {CONTENTS} is not read, or its page is missing");
        assert!(pages.is_sorted_by_key(Page::section));
        let mut files = Vec::new();
        sources(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").as_path(), &mut files);
        for file in files.iter().filter(|file| !file.ends_with(CONTENTS)) {
            let path = file.to_string_lossy().replace('\\', "/");
            let path = path.split_once("/docs/").map_or("", |(_, path)| path);
            let path = path.strip_suffix(".md").unwrap_or(path);
            let path = path.strip_suffix("/README").unwrap_or(path);
            let listed = pages.iter().filter(|page| page.path == path).count();
            assert_eq!(listed, 1, "{path} is listed {listed} times in {CONTENTS}");
        }
    }

    #[test]
    fn words_lead_to_the_pages_about_them() {
        let pages = pages();
        let first = |wanted: &str, count: usize| -> Vec<String> {
            search(&pages, wanted).into_iter().take(count).map(|hit| hit.page.name.clone()).collect()
        };
        for (wanted, page) in [
            ("push", "bounceForward"),
            ("water", "waterPhysics"),
            ("wrap", "wrapAround"),
            ("avatar", "MovingAvatar"),
            ("boat", "first-game"),
            ("boats", "first-game"),
            ("tutorial", "first-game"),
            ("getting-started", "first-game"),
            ("quickstart", "first-game"),
            ("vgdl", "first-game"),
            ("language", "first-game"),
            ("seal", "first-month"),
            ("commitment", "first-month"),
        ] {
            let found = first(wanted, 8);
            assert!(found.contains(&page.to_owned()), "{wanted}: {found:?}");
        }
        // A page must contain all the words. A search for punctuation finds nothing.
        assert!(search(&pages, "boat qwertzuiop").is_empty() && search(&pages, "promts").is_empty());
        assert!(search(&pages, "").is_empty() && search(&pages, "-").is_empty());
        let hits = search(&pages, "planners");
        assert_eq!(
            (hits[0].page.name.as_str(), hits[0].line.as_str()),
            ("planners", pages_title(&pages, "planners"))
        );
        for (own, wanted, expect) in [
            ("pushes", "push", true),
            ("boat", "boats", true),
            ("keys", "key", true),
            ("keyboard", "key", false),
            ("logic", "log", false),
            ("signals", "sign", false),
        ] {
            assert_eq!(is_form(own, wanted), expect, "{own} {wanted}");
        }
    }

    fn pages_title<'a>(pages: &'a [Page], name: &str) -> &'a str {
        pages.iter().find(|page| page.name == name).map_or("", Page::title)
    }

    /// Checks that a search for beginners' terms lists the tutorials before all other pages, starting with
    /// the tutorial on writing a first game.
    #[test]
    fn words_of_beginners_lead_to_the_tutorials() {
        let pages = pages();
        for wanted in ["wall", "walls", "player", "levels", "avatar", "win", "enemy"] {
            let hits = search(&pages, wanted);
            let found: Vec<&str> = hits.iter().take(4).map(|hit| hit.page.name.as_str()).collect();
            assert_eq!(hits[0].page.section(), Section::Start, "{wanted}: {found:?}");
            assert!(found.contains(&"first-game"), "{wanted}: {found:?}");
        }
    }

    #[track_caller]
    fn check(markdown: &'static str, expect: &str) {
        let pages = pages();
        let page = Page {
            name: "here".to_owned(),
            path: "reference/ontology/effects/here".to_owned(),
            label: "Here".to_owned(),
            depth: 2,
            text: markdown,
        };
        assert_eq!(page.plain(&pages), expect);
    }

    #[test]
    fn links_name_pages() {
        check(
            "see [killAll](killAll.md) and\n[the others](README.md#all)",
            "see [killAll] and\nthe others [effects]",
        );
        check("[codes](../../diagnostics/README.md)", "codes [diagnostics]");
        check("[above](#top), [a `b` c](../../prompts.md#x)", "above, a `b` c [prompts]");
        check("[paper](https://example.org/x)", "paper (https://example.org/x)");
        check("[file](../../../../seeds/tiny.toml)", "file (seeds/tiny.toml in the source)");
        check(
            "`[code](x.md)`\n\n```text\n[code](x.md)\n```\n",
            "`[code](x.md)`\n\n```text\n[code](x.md)\n```\n",
        );
    }

    #[test]
    fn links_between_pages_resolve() {
        let pages = pages();
        for page in &pages {
            let plain = page.plain(&pages);
            let lost =
                plain.lines().find(|line| line.contains("(docs/") && line.contains(".md in the source"));
            assert_eq!(lost, None, "{}", page.path);
        }
    }

    /// Collects the workspace sources that may print messages for users, without tests.
    fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("readable") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                sources(&path, found);
            } else if path
                .extension()
                .is_some_and(|ending| ["rs", "html", "j2", "md"].iter().any(|e| ending == *e))
            {
                found.push(path);
            }
        }
    }

    /// Checks that messages for users refer only to pages that `arcade docs` can show, because an installed
    /// binary has no `docs/` folder.
    #[test]
    fn messages_and_templates_name_pages_that_the_binary_has() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut files = Vec::new();
        let crates =
            ["cli", "evaluation", "snapshots", "agents", "render"].map(|name| format!("crates/{name}"));
        for folder in crates.iter().map(String::as_str).chain(["engine", "validators", "generators"]) {
            sources(&root.join(folder).join("src"), &mut files);
        }
        let mut named = 0;
        for file in files {
            let text = std::fs::read_to_string(&file).expect("readable");
            let place = file.strip_prefix(&root).expect("below").display();
            let product = text.split("#[cfg(test)]").next().unwrap_or_default();
            for (number, line) in product.lines().enumerate() {
                // Comments are for readers of the source. Another test covers the comments that become help
                // texts.
                let names_files = file.ends_with("manual.rs") || file.ends_with("command_page.rs");
                if line.trim_start().starts_with("//") || names_files {
                    continue;
                }
                let is_path =
                    ["include_str!", "include_dir!", "reason = "].iter().any(|word| line.contains(word));
                assert!(is_path || !line.contains("docs/"), "{place}:{}: {line}", number + 1);
                for rest in line.split("arcade docs ").skip(1) {
                    let name: String =
                        rest.chars().take_while(|c| c.is_alphanumeric() || *c == '-').collect();
                    // `arcade docs PAGE` and placeholders of templates stand for any page.
                    assert!(
                        name == "PAGE" || rest.starts_with("{{") || page(&name).is_ok(),
                        "{place}:{}: {line}",
                        number + 1
                    );
                    named += 1;
                }
            }
        }
        assert!(named > 5, "{named}");
    }
}
