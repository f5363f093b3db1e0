//! Citations in comments and pages: sections in `docs/reference/spec`, files in the repository, and numbered decisions.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use tests::{read, workspace_files};

use super::report;

/// The folder with the specification's pages, `01-….md` and so on.
const PAGES: &str = "docs/reference/spec";

/// Notes from before the repository existed, which comments must not cite. The name is split so that this
/// file does not match.
const NOTES: &str = concat!("design", ".md");

#[test]
fn citations_resolve() {
    let tree = Tree::of_the_workspace();
    let mut problems = Vec::new();
    for file in workspace_files() {
        if let Some(kind) = CitationKind::of(&file) {
            let name = file.to_string_lossy();
            let own = tree.spec_page(&name);
            for block in blocks(&read(&file), kind) {
                let mut found = block.problems(&tree, own);
                found.extend(block.missing_files(&tree, &file));
                problems.extend(found.into_iter().map(|(line, problem)| format!("{name}:{line}: {problem}")));
            }
        }
    }
    report(problems);
}

#[test]
fn wrong_citations_are_found() {
    let tree = Tree {
        pages: BTreeMap::from([
            (
                "01".to_owned(),
                Page::read("## 1. Files\n1. a\n2. b\n### 1.10 Values\n## 10. Quirks\n| K-1 | x |\n"),
            ),
            ("02".to_owned(), Page::read("## 17. Vectors\n**T5** x **T14** y\n")),
            ("05".to_owned(), Page::read("## A2. Analysis\n### A6.1 Rules\n")),
        ]),
        paths: ["docs/reference/metrics.md", "docs/reference/ontology", "docs/reference/ontology/README.md"]
            .map(str::to_owned)
            .into(),
        decisions: BTreeSet::from(["0005".to_owned()]),
    };
    let check = |comment: &str, expect: &[&str]| {
        let source = format!("fn f() {{}} // {comment}\n");
        let found =
            blocks(&source, CitationKind::Slashes).into_iter().flat_map(|block| block.problems(&tree, None));
        let found: Vec<String> = found.map(|(_, problem)| problem).collect();
        assert_eq!(found.len(), expect.len(), "{comment}: {found:?}");
        for (found, expect) in found.iter().zip(expect) {
            assert!(found.contains(expect), "{comment}: {found}");
        }
    };
    check("As in `spec/01`.", &[]);
    check("As in `spec/01` §1, §10 K-1; `spec/02` §17: T5 and T14, and 3 more.", &[]);
    check("As in spec/01 §1, steps 1–2, `spec/05` A2 and A6.1.", &[]);
    check(
        "See `docs/reference/metrics.md`, docs/reference/ontology/**.md, decision 0005 (`decisions/0005`).",
        &[],
    );
    check("See https://example.org/docs/none.md and old_docs/none.md.", &[]);
    check("As in `spec/03` §1.", &["no page `spec/03`"]);
    check("As in `spec/01` §2–§1.10", &["`spec/01` has no §2"]);
    check("As in `spec/01` §1 and §1.11: x", &["`spec/01` has no §1.11"]);
    check("As in `spec/02` §17, T5–T15", &["`spec/02` §17 has no T15"]);
    check("As in `spec/01` §10 K-2", &["`spec/01` §10 has no K-2"]);
    check("As in `spec/01` §1, step 3", &["`spec/01` §1 has no step 3"]);
    check("As in `spec/05` A3", &["`spec/05` has no A3"]);
    check("See `docs/none.md` or docs/reference/metrics.md.", &["no file `docs/none.md`"]);
    check("See decisions/0006 or decision 0007.", &["no decision 0006", "no decision 0007"]);
    check(&format!("See {NOTES}, §4."), &["is not in the repository"]);
}

#[test]
fn citations_are_read_from_comments_only() {
    let source =
        "//! As in `spec/01`\n//! §1,\n//! §9.\nlet a = \"spec/77 // spec/88\";\nlet b = 1; // spec/99\n";
    let tree = Tree {
        pages: BTreeMap::from([("01".to_owned(), Page::read("## 1. Files\n"))]),
        paths: BTreeSet::new(),
        decisions: BTreeSet::new(),
    };
    let found: Vec<(usize, String)> = blocks(source, CitationKind::Slashes)
        .into_iter()
        .flat_map(|block| block.problems(&tree, None))
        .collect();
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [3, 5], "{found:?}");
}

#[test]
fn paths_that_lead_nowhere_are_found() {
    let paths = [
        "engine",
        "engine/Cargo.toml",
        "engine/src",
        "engine/src/step.rs",
        "crates/cli/Cargo.toml",
        "crates/cli/cli/a.rs",
    ];
    let tree =
        Tree { pages: BTreeMap::new(), paths: paths.map(str::to_owned).into(), decisions: BTreeSet::new() };
    let source = "/// `engine/src/step.rs`, `engine/src/`, `cli/a.rs`, `a/b`, `engine::step/x`;\n/// not `engine/src/leap.rs`.\n";
    let found = blocks(source, CitationKind::Slashes);
    let found =
        found.iter().flat_map(|block| block.missing_files(&tree, Path::new("crates/cli/src/main.rs")));
    let found: Vec<(usize, String)> = found.collect();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].0 == 2 && found[0].1.contains("`engine/src/leap.rs`"), "{found:?}");
}

/// The possible targets of citations.
struct Tree {
    /// The specification's pages, by the two digits in their names.
    pages: BTreeMap<String, Page>,
    /// All files and folders in the repository.
    paths: BTreeSet<String>,
    /// The decisions, by the four digits in their names.
    decisions: BTreeSet<String>,
}

impl Tree {
    fn of_the_workspace() -> Tree {
        let mut tree = Tree { pages: BTreeMap::new(), paths: BTreeSet::new(), decisions: BTreeSet::new() };
        for file in workspace_files() {
            let name = file.file_name().expect("a file has a name").to_string_lossy().into_owned();
            let digits: String = name.chars().take_while(char::is_ascii_digit).collect();
            let folder = file.parent().expect("a file lies in a folder");
            if folder == Path::new(PAGES) && digits.len() == 2 {
                tree.pages.insert(digits, Page::read(&read(&file)));
            } else if folder == Path::new("docs/lab/decisions") && digits.len() == 4 {
                tree.decisions.insert(digits);
            }
            let all = file.ancestors().filter(|path| !path.as_os_str().is_empty());
            tree.paths.extend(all.map(|path| path.to_string_lossy().into_owned()));
        }
        tree
    }

    /// Returns the two digits in a specification page's name; `None` for any other file.
    fn spec_page<'a>(&self, file: &'a str) -> Option<&'a str> {
        let name = file.strip_prefix(PAGES)?.strip_prefix('/')?;
        let digits = name.get(..2)?;
        self.pages.contains_key(digits).then_some(digits)
    }

    /// Returns `true` if the repository contains a file or folder with the given path.
    fn has(&self, path: &str) -> bool {
        self.paths.contains(path.trim_end_matches('/'))
    }

    /// Returns `true` if a path leads to a file or folder, starting at the root, at the citing file or at any
    /// crate.
    fn finds(&self, path: &str, cited_in: &Path) -> bool {
        let from = |folder: &str| self.has(&format!("{folder}/{path}"));
        let own = cited_in.parent().map(|folder| folder.to_string_lossy().into_owned());
        self.has(path) || own.is_some_and(|folder| from(&folder)) || self.crates().any(from)
    }

    /// Returns the crate folders.
    fn crates(&self) -> impl Iterator<Item = &str> {
        self.paths.iter().filter_map(|path| path.strip_suffix("/Cargo.toml"))
    }
}

/// The sections of a page by number, each with its text up to the next heading at the same or a higher level.
struct Page {
    sections: BTreeMap<String, String>,
}

impl Page {
    fn read(text: &str) -> Page {
        let mut sections: BTreeMap<String, String> = BTreeMap::new();
        // The enclosing sections with their levels, outermost first.
        let mut open: Vec<(usize, String)> = Vec::new();
        for line in text.lines() {
            let level = line.chars().take_while(|c| *c == '#').count();
            if level > 0 && line[level..].starts_with(' ') {
                open.retain(|(outer, _)| *outer < level);
                if let Some((number, _)) = section(line[level..].trim_start()) {
                    sections.insert(number.to_owned(), String::new());
                    open.push((level, number.to_owned()));
                }
            }
            for (_, number) in &open {
                let text = sections.get_mut(number).expect("an open section is listed");
                text.push_str(line);
                text.push('\n');
            }
        }
        Page { sections }
    }

    /// Returns `true` if a section contains the given row, vector or numbered step.
    fn has(&self, section: &str, mark: &str) -> bool {
        let Some(text) = self.sections.get(section) else { return false };
        match mark.strip_prefix("step ") {
            Some(step) => text.lines().any(|line| line.trim_start().starts_with(&format!("{step}. "))),
            None => text.contains(&format!("| {mark} |")) || text.contains(&format!("**{mark}**")),
        }
    }
}

/// The kind of comments used in a file.
#[derive(Clone, Copy, PartialEq)]
enum CitationKind {
    /// Comments that start with `//`.
    Slashes,
    /// Comments that start with `#`.
    Hash,
    /// The whole file is prose.
    Prose,
}

impl CitationKind {
    /// Returns the kind of comments in a hand-written file, based on the file's name. Scripts have no
    /// extension.
    fn of(file: &Path) -> Option<CitationKind> {
        let Some(extension) = file.extension() else {
            let script = file.starts_with("tools/scripts") || file.starts_with(".ci");
            return script.then_some(CitationKind::Hash);
        };
        match extension.to_str()? {
            "rs" | "pest" => Some(CitationKind::Slashes),
            "toml" | "vgdl" | "py" | "sh" => Some(CitationKind::Hash),
            "md" => Some(CitationKind::Prose),
            _ => None,
        }
    }

    /// Returns the comment on a line; `None` if there is none.
    fn comment(self, line: &str) -> Option<&str> {
        let mark = match self {
            CitationKind::Slashes => "//",
            CitationKind::Hash => "#",
            CitationKind::Prose => return Some(line),
        };
        // A comment mark in a string does not start a comment. Quotes before a comment come in pairs.
        let quotes = |before: &str| before.matches('"').count() - before.matches("\\\"").count();
        let mut starts = line.match_indices(mark).map(|(start, _)| start);
        let start = starts.find(|start| quotes(&line[..*start]).is_multiple_of(2))?;
        Some(line[start..].trim_start_matches(['/', '!', '#']))
    }
}

/// Consecutive comment lines, as one text.
struct Block {
    text: String,
    /// Each line's offset in the text, and its line number in the file.
    lines: Vec<(usize, usize)>,
}

fn blocks(source: &str, kind: CitationKind) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut last = 0;
    for (line, number) in source.lines().zip(1..) {
        let Some(comment) = kind.comment(line) else { continue };
        // Code before a comment separates it from the comment above.
        let alone = kind == CitationKind::Prose || line.trim_start().starts_with(['/', '#']);
        if blocks.is_empty() || last + 1 != number || !alone {
            blocks.push(Block { text: String::new(), lines: Vec::new() });
        }
        last = number;
        let block = blocks.last_mut().expect("there is one by now");
        block.lines.push((block.text.len(), number));
        block.text.push_str(comment);
        block.text.push(' ');
    }
    blocks
}

impl Block {
    /// Returns the file's line number for a position in the text.
    fn line(&self, at: usize) -> usize {
        self.lines.iter().rev().find(|(start, _)| *start <= at).map_or(1, |(_, line)| *line)
    }

    /// Returns the problems with the block's citations, each with its line. `own` is the specification page
    /// that contains the block.
    fn problems(&self, tree: &Tree, own: Option<&str>) -> Vec<(usize, String)> {
        let mut problems = Vec::new();
        for (at, _) in self.text.match_indices("spec/") {
            let rest = &self.text[at + "spec/".len()..];
            let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
            // A path to a page is checked elsewhere, together with other paths.
            if digits.len() == 2 && !rest[2..].starts_with('-') && !self.text[..at].ends_with(path_character)
            {
                self.sections(tree, &digits, at + "spec/".len() + 2, &mut problems);
            }
        }
        if let Some(own) = own {
            self.own_sections(tree, own, &mut problems);
        }
        for (at, _) in self.text.match_indices("docs/") {
            if self.text[..at].ends_with(path_character) {
                continue;
            }
            let path: String = self.text[at..].chars().take_while(|c| path_character(*c)).collect();
            let path = path.trim_end_matches(['.', '/']);
            if !tree.has(path) {
                problems.push((self.line(at), format!("there is no file `{path}`; name one that exists")));
            }
        }
        for start in ["decisions/", "decision "] {
            for (at, _) in self.text.match_indices(start) {
                let number: String =
                    self.text[at + start.len()..].chars().take_while(char::is_ascii_digit).collect();
                if number.len() == 4 && number.starts_with('0') && !tree.decisions.contains(&number) {
                    let problem = format!("there is no decision {number}; name a page of docs/lab/decisions");
                    problems.push((self.line(at), problem));
                }
            }
        }
        for (at, _) in self.text.match_indices(NOTES) {
            problems.push((
                self.line(at),
                format!("{NOTES} is not in the repository; name a page of docs/ or ARCHITECTURE.md"),
            ));
        }
        problems
    }

    /// Returns the paths in backticks that begin with a top-level folder but do not exist, each with its
    /// line.
    fn missing_files(&self, tree: &Tree, cited_in: &Path) -> Vec<(usize, String)> {
        let mut problems = Vec::new();
        let mut at = 0;
        for (number, piece) in self.text.split('`').enumerate() {
            let is_path = number % 2 == 1 && piece.contains('/') && piece.chars().all(path_character);
            let top = piece.split('/').next().unwrap_or_default();
            let is_ours = tree.has(top) || tree.crates().any(|folder| folder.rsplit('/').next() == Some(top));
            if is_path && is_ours && !tree.finds(piece, cited_in) {
                problems.push((self.line(at), format!("there is no file `{piece}`; name one that exists")));
            }
            at += piece.len() + 1;
        }
        problems
    }

    /// Checks a list of sections and marks after a page name, such as "§1, §10 K-1 and §1.3–§1.9".
    fn sections(&self, tree: &Tree, page: &str, at: usize, problems: &mut Vec<(usize, String)>) {
        let Some(sections) = tree.pages.get(page) else {
            let problem = format!("there is no page `spec/{page}`; cite one of {PAGES}");
            problems.push((self.line(at), problem));
            return;
        };
        let mut rest = &self.text[at..];
        let mut section_cited: Option<String> = None;
        loop {
            rest = after_separators(rest);
            let here = self.line(self.text.len() - rest.len());
            let lettered =
                rest.starts_with(|c: char| c.is_ascii_uppercase()).then(|| section(rest)).flatten();
            if let Some((number, after)) = rest.strip_prefix('§').and_then(section).or(lettered) {
                if sections.sections.contains_key(number) {
                    section_cited = Some(number.to_owned());
                } else {
                    let sign = if lettered.is_some() { "" } else { "§" };
                    problems.push((
                        here,
                        format!("`spec/{page}` has no {sign}{number}; cite a section of {PAGES}/{page}-….md"),
                    ));
                    section_cited = None;
                }
                rest = after;
            } else if let Some((marks, after)) = marks(rest) {
                for mark in marks {
                    if section_cited.as_ref().is_some_and(|section| !sections.has(section, &mark)) {
                        let section = section_cited.as_deref().unwrap_or_default();
                        problems.push((
                            here,
                            format!(
                                "`spec/{page}` §{section} has no {mark}; cite a row that {PAGES}/{page}-….md has"
                            ),
                        ));
                    }
                }
                rest = after;
            } else {
                return;
            }
        }
    }

    /// Checks a specification page's references to its own sections, such as `§4.1`, and to sections of other
    /// pages, such as `02 §15`.
    fn own_sections(&self, tree: &Tree, own: &str, problems: &mut Vec<(usize, String)>) {
        for (at, sign) in self.text.match_indices('§') {
            let Some((number, _)) = section(&self.text[at + sign.len()..]) else { continue };
            let before = self.text[..at].trim_end();
            let page =
                before.get(before.len().saturating_sub(2)..).filter(|page| tree.pages.contains_key(*page));
            let spelled = before.len() < 3 || !before[..before.len() - 2].ends_with(path_character);
            let page = page.filter(|_| spelled).unwrap_or(own);
            if !tree.pages.get(page).is_some_and(|page| page.sections.contains_key(number)) {
                problems.push((
                    self.line(at),
                    format!("page {page} has no §{number}; correct the number, or name the page before it"),
                ));
            }
        }
    }
}

fn path_character(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '/' | '.' | '-' | '_')
}

/// Returns the section number at the start of a text, such as `4`, `1.6.3` or `A6.1`, and the rest of the text.
fn section(text: &str) -> Option<(&str, &str)> {
    let letters = usize::from(text.starts_with('A'));
    let mut end = letters;
    for (at, c) in text.char_indices().skip(letters) {
        let next = text[at + c.len_utf8()..].chars().next();
        let dot = c == '.' && at > letters && next.is_some_and(|next| next.is_ascii_digit());
        if !c.is_ascii_digit() && !dot {
            break;
        }
        end = at + 1;
    }
    (end > letters).then(|| text.split_at(end))
}

/// Returns a mark at the start of a text, or the two ends of a range (`T9`, `K-16`, `Q35–Q58`, `steps 2–5`), and the rest of the
/// text.
fn marks(text: &str) -> Option<(Vec<String>, &str)> {
    let number = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    for (written, prefix) in [("K-", "K-"), ("T", "T"), ("Q", "Q"), ("steps ", "step "), ("step ", "step ")] {
        let Some(rest) = text.strip_prefix(written) else { continue };
        let end = number(rest);
        if end == 0 {
            continue;
        }
        let mut marks = vec![format!("{prefix}{}", &rest[..end])];
        let mut after = &rest[end..];
        if let Some(to) = after.strip_prefix(['–', '-']) {
            let to = to.strip_prefix(written).unwrap_or(to);
            let end = number(to);
            if end > 0 {
                marks.push(format!("{prefix}{}", &to[..end]));
                after = &to[end..];
            }
        }
        return Some((marks, after));
    }
    None
}

/// Returns a text without leading list separators.
fn after_separators(mut text: &str) -> &str {
    loop {
        let shorter = text.trim_start_matches(|c: char| c.is_whitespace() || "`,;:–-".contains(c));
        let shorter = shorter.strip_prefix("and ").or_else(|| shorter.strip_prefix("to ")).unwrap_or(shorter);
        if shorter.len() == text.len() {
            return text;
        }
        text = shorter;
    }
}
