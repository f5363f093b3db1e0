//! House rules that can be checked automatically, such as the imports between crates, the length of files and the
//! targets of links.
//!
//! Every message has the form `file:line: the problem; the fix`, and a test reports all problems together.

mod citations;
mod clocks;
mod crates;
mod dependencies;
mod layers;
mod paths;
mod rows;
mod supply;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use tests::{read, rust_files, workspace_files, workspace_root};
use toml::de::{DeTable, DeValue};

/// The maximum length of a Rust file, in lines.
const RUST_LINES: usize = 1000;

/// The pages in the root folder. Their links are checked like those in `docs/`.
const PAGES: [&str; 4] = ["ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "README.md"];

#[test]
fn rust_files_are_short() {
    let mut problems = Vec::new();
    for (file, text) in rust_files() {
        let lines = text.lines().count();
        if lines > RUST_LINES {
            problems.push(format!(
                "{}:{lines}: longer than {RUST_LINES} lines; split it by noun",
                file.display()
            ));
        }
    }
    report(problems);
}

/// This test relies on the formatting, which puts only the first line of each item at the left margin.
#[test]
fn lib_files_hold_docs_and_declarations_only() {
    let mut problems = Vec::new();
    for (file, text) in rust_files() {
        // This crate's helpers are few and have no other users, so they stay in its lib.rs.
        if !file.ends_with("src/lib.rs") || file.starts_with(crates::ABOVE_ALL) {
            continue;
        }
        for (line, number) in text.lines().zip(1..) {
            if !is_declaration(line) {
                problems.push(format!(
                    "{}:{number}: lib.rs holds docs, `mod`, `use` and the constants SEMANTICS and \
                     GENERATION; move `{line}` into a module",
                    file.display()
                ));
            }
        }
    }
    report(problems);
}

#[test]
fn crates_open_with_their_docs() {
    let mut problems = Vec::new();
    for (file, text) in rust_files() {
        let crate_root = (file.ends_with("src/lib.rs") || file.ends_with("src/main.rs"))
            && !text.trim_start().starts_with("//!");
        if crate_root {
            problems.push(format!(
                "{}:1: does not start with `//!`; say in a sentence what the crate is for",
                file.display()
            ));
        }
    }
    report(problems);
}

#[test]
fn files_are_named_after_what_they_hold() {
    let mut problems = Vec::new();
    for (file, _) in rust_files() {
        let nameless = file.iter().any(|part| {
            let stem = Path::new(part).file_stem().unwrap_or(part);
            ["utils", "helpers", "misc"].iter().any(|name| stem == *name)
        });
        if nameless {
            problems.push(format!(
                "{}:1: its name does not say what it holds; a helper lives with its user until it has a name",
                file.display()
            ));
        }
    }
    report(problems);
}

#[test]
fn nothing_is_left_unfinished() {
    // The strings are split so that this file does not match.
    let unfinished = [
        (concat!("todo", "!("), "write it, or leave it out"),
        (concat!("unimplemented", "!("), "write it, or leave it out"),
        (concat!("dbg", "!("), "remove it"),
        (concat!("#[", "ignore"), "make the test fast enough to run, or remove it"),
    ];
    let mut problems = Vec::new();
    for (file, text) in rust_files() {
        for (line, number) in text.lines().zip(1..) {
            for (needle, repair) in unfinished {
                if line.contains(needle) {
                    problems.push(format!("{}:{number}: `{needle}` in the tree; {repair}", file.display()));
                }
            }
        }
    }
    report(problems);
}

/// Paths to home and work folders are rejected everywhere. `/tmp` may appear in tests, like other absolute
/// paths.
#[test]
fn no_path_leads_out_of_the_repository() {
    let homes = ["home", "root", "Users", "work"];
    let checked = ["rs", "md", "toml", "json", "vgdl", "txt", "html", "py", "sh", "yml", "yaml"];
    let mut problems = Vec::new();
    for file in workspace_files() {
        let text_file =
            file.extension().is_some_and(|extension| checked.iter().any(|known| extension == *known));
        if !text_file && !file.starts_with(".ci") {
            continue;
        }
        let mut in_test = file.iter().any(|part| part == "tests");
        for (line, number) in read(&file).lines().zip(1..) {
            in_test |= line.trim_start().starts_with("#[cfg(test)]");
            let home = homes.iter().find(|folder| names_absolute(line, folder));
            let found = home.or_else(|| Some(&"tmp").filter(|tmp| !in_test && names_absolute(line, tmp)));
            if let Some(folder) = found {
                problems.push(format!(
                    "{}:{number}: a path below /{folder} exists on one machine only; write it relative to \
                     the repository, or take it as an argument",
                    file.display()
                ));
            }
        }
    }
    report(problems);
}

#[test]
fn links_lead_to_files() {
    let root = workspace_root().canonicalize().expect("the workspace root exists");
    let in_docs = workspace_files().into_iter().filter(|file| {
        file.starts_with("docs") && file.extension().is_some_and(|extension| extension == "md")
    });
    let mut problems = Vec::new();
    for page in PAGES.iter().map(PathBuf::from).chain(in_docs) {
        let folder = root.join(&page).parent().expect("a page lies in a folder").to_path_buf();
        for (number, target) in relative_links(&read(&page)) {
            let found = folder.join(&target).canonicalize();
            if !found.is_ok_and(|found| found.starts_with(&root)) {
                problems.push(format!(
                    "{}:{number}: the link `{target}` leads to no file of the repository; correct or \
                     remove it",
                    page.display()
                ));
            }
        }
    }
    report(problems);
}

#[test]
fn decisions_are_numbered_and_complete() {
    let pages = workspace_files().into_iter().filter(|file| {
        let here = file.parent().is_some_and(|folder| folder == Path::new("docs/lab/decisions"));
        here && file.file_name().is_some_and(|name| name != "README.md")
    });
    let mut problems = Vec::new();
    for (page, expected) in pages.zip(1..) {
        let name = page.file_name().expect("a page has a name").to_string_lossy().into_owned();
        if !name.starts_with(&format!("{expected:04}-")) || !name.ends_with(".md") {
            problems.push(format!(
                "{}:1: should be called {expected:04}-title.md; number the decisions without gaps or doubles",
                page.display()
            ));
        }
        let text = read(&page);
        let headings: Vec<&str> = text.lines().filter(|line| line.starts_with("## ")).collect();
        let wanted = ["## Question", "## Answer", "## What we gave up"];
        if !text.starts_with("# ") || headings != wanted {
            problems.push(format!(
                "{}:1: has the headings {headings:?}; under its `# ` title write {wanted:?}, in this order",
                page.display()
            ));
        }
    }
    report(problems);
}

#[test]
fn code_is_formatted() {
    let cargo = || {
        let mut command = Command::new(env!("CARGO"));
        command.current_dir(workspace_root()).arg("fmt");
        command
    };
    if !cargo().arg("--version").output().is_ok_and(|output| output.status.success()) {
        // Writing to standard error bypasses the output capture of the test harness, so that the message is visible.
        writeln!(std::io::stderr(), "rustfmt is not installed: formatting is not checked")
            .expect("stderr is open");
        return;
    }
    let output = cargo().args(["--all", "--check"]).output().expect("cargo fmt has just run");
    if output.status.success() {
        return;
    }
    let root = format!("{}/", workspace_root().display());
    let differences = String::from_utf8_lossy(&output.stdout).replace(&root, "");
    let mut problems: Vec<String> = differences
        .lines()
        .filter_map(|line| line.strip_prefix("Diff in "))
        .map(|place| format!("{} not as rustfmt writes it; run `cargo fmt --all`", place.trim_end()))
        .collect();
    if problems.is_empty() {
        problems.push(String::from_utf8_lossy(&output.stderr).replace(&root, ""));
    }
    report(problems);
}

#[test]
fn relative_links_are_found() {
    let page = "See [`a`](a.md#part), [b](<b c.md> \"title\") and ![c](../c.png).\n\
                Not [d](https://example.org/d), [e](#here), `[f](f.md)`.\n\
                ```\n[g](g.md)\n```\n[h]: h.md\n[^1]: note\n";
    let found: Vec<(usize, String)> = relative_links(page);
    let found: Vec<(usize, &str)> = found.iter().map(|(line, target)| (*line, target.as_str())).collect();
    assert_eq!(found, [(1, "a.md"), (1, "b c.md"), (1, "../c.png"), (6, "h.md")]);
}

#[test]
fn absolute_paths_are_found() {
    let path = concat!("/", "home/me");
    for line in [format!("{path}/x"), format!("open(\"{path}\")"), format!("run in `{path}`")] {
        assert!(names_absolute(&line, "home"), "{line}");
    }
    for line in [format!("https://example.org{path}"), format!("{{root}}{path}"), "/homestead/x".to_owned()] {
        assert!(!names_absolute(&line, "home"), "{line}");
    }
}

/// All dependencies in a member's `Cargo.toml`, of every kind and for every target.
struct Manifest {
    /// The folder and library name, such as `engine`.
    folder: String,
    /// The package name, such as `infinite-arcade-engine`.
    package: String,
    dependencies: Vec<Dependency>,
}

impl Manifest {
    fn path(&self) -> String {
        format!("{}/Cargo.toml", self.folder)
    }

    /// Returns the last component of the folder, which is the crate's name.
    fn name(&self) -> &str {
        self.folder.rsplit('/').next().expect("a folder has a name")
    }
}

/// A dependency in a manifest.
struct Dependency {
    /// The real package name, even if the dependency is renamed.
    package: String,
    /// `true` if only tests, examples and benches use the dependency.
    development: bool,
    /// `true` if the version comes from `[workspace.dependencies]`.
    inherited: bool,
    line: usize,
}

/// Returns the manifests of all members, in workspace order.
fn manifests() -> Vec<Manifest> {
    let source = read("Cargo.toml");
    let root = DeTable::parse(&source).unwrap_or_else(|error| panic!("Cargo.toml: {error}"));
    let workspace = get(root.get_ref(), "workspace").and_then(DeValue::as_table);
    let workspace = workspace.expect("Cargo.toml has [workspace]");
    let shared = get(workspace, "dependencies").and_then(DeValue::as_table);
    let members = get(workspace, "members").and_then(DeValue::as_array).expect("[workspace] has members");
    let folders = members.iter().map(|member| member.get_ref().as_str().expect("a member is a string"));
    folders.map(|folder| manifest(folder, shared)).collect()
}

/// Reads one member's manifest. `shared` is `[workspace.dependencies]`.
fn manifest(folder: &str, shared: Option<&DeTable<'_>>) -> Manifest {
    let source = read(Path::new(folder).join("Cargo.toml"));
    let root = DeTable::parse(&source).unwrap_or_else(|error| panic!("{folder}/Cargo.toml: {error}"));
    let root = root.get_ref();
    let targets = get(root, "target").and_then(DeValue::as_table);
    let mut scopes = vec![root];
    scopes.extend(
        targets.iter().flat_map(|targets| targets.values()).filter_map(|target| target.get_ref().as_table()),
    );
    let mut dependencies = Vec::new();
    for scope in scopes {
        for section in ["dependencies", "build-dependencies", "dev-dependencies"] {
            for (name, value) in get(scope, section).and_then(DeValue::as_table).into_iter().flatten() {
                let written = name.get_ref().as_ref();
                let own = renamed(value.get_ref());
                let inherited = || shared.and_then(|shared| get(shared, written)).and_then(renamed);
                dependencies.push(Dependency {
                    package: own.or_else(inherited).unwrap_or(written).to_owned(),
                    development: section == "dev-dependencies",
                    inherited: inherits(value.get_ref()),
                    line: source[..name.span().start].matches('\n').count() + 1,
                });
            }
        }
    }
    let package = get(root, "package").and_then(DeValue::as_table).and_then(|package| get(package, "name"));
    let package = package.and_then(DeValue::as_str).unwrap_or_else(|| panic!("{folder}/Cargo.toml: no name"));
    Manifest { folder: folder.to_owned(), package: package.to_owned(), dependencies }
}

/// Returns the `package = "..."` of a dependency; `None` if the dependency is not renamed.
fn renamed<'a>(dependency: &'a DeValue<'_>) -> Option<&'a str> {
    dependency.as_table().and_then(|table| get(table, "package")).and_then(DeValue::as_str)
}

/// Returns `true` if a dependency has `workspace = true`.
fn inherits(dependency: &DeValue<'_>) -> bool {
    let workspace = dependency.as_table().and_then(|table| get(table, "workspace"));
    workspace.and_then(DeValue::as_bool).unwrap_or(false)
}

fn get<'a, 'i>(table: &'a DeTable<'i>, key: &str) -> Option<&'a DeValue<'i>> {
    table.iter().find(|(name, _)| name.get_ref() == key).map(|(_, value)| value.get_ref())
}

/// Returns the name of the member with the package name `package`, or `None` for external crates.
fn name_of<'a>(manifests: &'a [Manifest], package: &str) -> Option<&'a str> {
    manifests.iter().find(|manifest| manifest.package == package).map(Manifest::name)
}

/// Returns `true` if a line in a formatted `lib.rs` belongs to documentation, an attribute or an allowed
/// declaration.
fn is_declaration(line: &str) -> bool {
    let continued = line.is_empty() || line.starts_with([' ', '}', ')', ']']);
    let item = line.strip_prefix("pub(crate) ").or_else(|| line.strip_prefix("pub ")).unwrap_or(line);
    let module = item.starts_with("mod ") && (item.ends_with(';') || item.ends_with("{}"));
    let constant = ["const SEMANTICS:", "const GENERATION:"].iter().any(|start| item.starts_with(start));
    let starts = ["//", "#[", "#![", "use ", "extern crate "];
    continued || module || constant || starts.iter().any(|start| item.starts_with(start))
}

/// Returns `true` if a line contains an absolute path below the given top-level folder of the file system.
fn names_absolute(line: &str, folder: &str) -> bool {
    let prefix = format!("/{folder}/");
    line.match_indices(&prefix).any(|(start, _)| {
        let before = line[..start].chars().next_back();
        before.is_none_or(|before| before.is_whitespace() || "\"'`(<[=:,|".contains(before))
    })
}

/// Returns the links in a Markdown page without their fragments, each with its line number. URLs, anchors in
/// the same page, and code are skipped.
fn relative_links(page: &str) -> Vec<(usize, String)> {
    let mut links = Vec::new();
    let mut fenced = false;
    for (line, number) in page.lines().zip(1..) {
        let start = line.trim_start();
        if start.starts_with("```") || start.starts_with("~~~") {
            fenced = !fenced;
        }
        if fenced {
            continue;
        }
        // Every second piece between backticks is code.
        let prose: String = line.split('`').step_by(2).collect();
        let defined = prose.trim_start().strip_prefix('[').filter(|rest| !rest.starts_with('^'));
        let defined = defined.and_then(|rest| rest.split_once("]: ")).map(|(_, target)| target);
        for target in prose.split("](").skip(1).chain(defined) {
            let target = match target.trim_start().strip_prefix('<') {
                Some(quoted) => quoted.split('>').next(),
                None => target.split([')', ' ']).next(),
            };
            let target = target.unwrap_or_default().split('#').next().unwrap_or_default();
            if !target.is_empty() && !target.contains("://") && !target.starts_with("mailto:") {
                links.push((number, target.to_owned()));
            }
        }
    }
    links
}

/// Fails if there are any problems, and lists them with one line each.
#[track_caller]
fn report(problems: Vec<String>) {
    assert!(problems.is_empty(), "\n{}\n", problems.join("\n"));
}
