//! The dependencies between our crates, and their use of external crates.

use super::{manifests, name_of, report};
use std::collections::{BTreeMap, BTreeSet};
use tests::{read, rust_files};

/// Our crates, each with the dependencies that it may have. Imports go in one direction only.
const ALLOWED: &[(&str, &[&str])] = &[
    ("base", &[]),
    ("disk", &[]),
    ("loopback", &["base"]),
    ("engine", &["base"]),
    ("editor", &["disk", "engine"]),
    ("statistics", &[]),
    ("agents", &["base", "engine"]),
    ("generators", &["base", "engine"]),
    ("validators", &["base", "engine", "agents", "statistics"]),
    ("report", &["base", "statistics"]),
    ("forge", &["base", "engine", "agents", "generators", "validators", "report", "statistics"]),
    (
        "snapshots",
        &["base", "disk", "engine", "agents", "generators", "validators", "forge", "report", "statistics"],
    ),
    ("trust", &["base", "disk"]),
    ("render", &["engine"]),
    ("evaluation", &["base", "disk", "loopback", "engine", "agents", "render", "report", "statistics"]),
    (
        "design",
        &[
            "base",
            "disk",
            "engine",
            "editor",
            "agents",
            "generators",
            "validators",
            "forge",
            "evaluation",
            "report",
            "statistics",
        ],
    ),
    (
        "pages",
        &[
            "base",
            "engine",
            "generators",
            "validators",
            "forge",
            "evaluation",
            "render",
            "report",
            "statistics",
        ],
    ),
    ("terminal", &["base", "engine", "agents", "render"]),
    (
        "studio",
        &[
            "base",
            "disk",
            "loopback",
            "engine",
            "editor",
            "agents",
            "generators",
            "validators",
            "forge",
            "snapshots",
            "statistics",
            "render",
            "report",
            "evaluation",
        ],
    ),
    (
        "python",
        &[
            "base",
            "engine",
            "editor",
            "agents",
            "generators",
            "validators",
            "forge",
            "snapshots",
            "render",
            "evaluation",
        ],
    ),
    (
        "cli",
        &[
            "base",
            "disk",
            "engine",
            "editor",
            "agents",
            "generators",
            "validators",
            "forge",
            "snapshots",
            "trust",
            "report",
            "statistics",
            "render",
            "evaluation",
            "design",
            "pages",
            "terminal",
            "studio",
        ],
    ),
    (
        "xtask",
        &[
            "base",
            "engine",
            "agents",
            "generators",
            "validators",
            "forge",
            "snapshots",
            "report",
            "render",
            "statistics",
        ],
    ),
];

/// The crate that may depend on all others, because none depends on it.
pub(super) const ABOVE_ALL: &str = "tests";

/// External crates (with their families, such as `pest_derive`) that only a few of our crates may use.
const CONFINED: &[(&str, &[&str])] = &[
    ("pest", &["engine"]),
    ("clap", &["cli", "xtask"]),
    ("tiny-skia", &["render"]),
    ("png", &["render"]),
    ("gif", &["render"]),
    ("indicatif", &["cli"]),
    ("ratatui", &["terminal", "cli"]),
    ("miette", &["editor"]),
    ("minijinja", &["pages", "evaluation"]),
    ("anyhow", &["cli", "xtask"]),
    ("ureq", &["evaluation"]),
    ("tiktoken", &["evaluation"]),
    ("regex", &["evaluation"]),
    ("nalgebra", &["statistics"]),
    ("numpy", &["python"]),
    ("pyo3", &["python"]),
    ("tar", &["snapshots"]),
    ("zstd", &["snapshots"]),
    ("blst", &["trust"]),
    ("minisign", &["trust"]),
    ("ed25519", &["trust"]),
    ("sha2", &["trust"]),
    ("rpassword", &["cli"]),
];

#[test]
fn imports_point_one_way() {
    let manifests = manifests();
    let mut problems = Vec::new();
    for manifest in &manifests {
        let name = manifest.name();
        let allowed = ALLOWED.iter().find(|(row, _)| *row == name).map(|(_, allowed)| *allowed);
        if allowed.is_none() && name != ABOVE_ALL {
            problems.push(format!(
                "{}:1: the place of `{name}` among the crates is not decided; give it a row in \
                 ALLOWED in {}",
                manifest.path(),
                file!()
            ));
        }
        for dependency in manifest.dependencies.iter().filter(|dependency| !dependency.development) {
            let Some(target) = name_of(&manifests, &dependency.package) else { continue };
            if allowed.is_some_and(|allowed| !allowed.contains(&target)) {
                problems.push(format!(
                    "{}:{}: `{name}` must not depend on `{target}`; move what both need into a \
                     crate that both may use",
                    manifest.path(),
                    dependency.line
                ));
            }
        }
    }
    report(problems);
}

#[test]
fn dev_dependencies_close_no_cycle() {
    let manifests = manifests();
    let mut edges: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for manifest in &manifests {
        let targets = manifest.dependencies.iter().filter_map(|d| name_of(&manifests, &d.package));
        edges.insert(manifest.name(), targets.collect());
    }
    let mut problems = Vec::new();
    for manifest in &manifests {
        for dependency in manifest.dependencies.iter().filter(|dependency| dependency.development) {
            let Some(target) = name_of(&manifests, &dependency.package) else { continue };
            if reaches(&edges, target, manifest.name()) {
                problems.push(format!(
                    "{}:{}: `{target}` depends on `{}` in turn; move the test that needs it into \
                     `{ABOVE_ALL}`",
                    manifest.path(),
                    dependency.line,
                    manifest.name()
                ));
            }
        }
    }
    report(problems);
}

#[test]
fn confined_crates_stay_where_they_belong() {
    let mut problems = Vec::new();
    for manifest in manifests() {
        for dependency in &manifest.dependencies {
            let family = CONFINED.iter().find(|(name, _)| {
                let rest = dependency.package.strip_prefix(name);
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['_', '-']))
            });
            let Some((name, homes)) = family else { continue };
            if !homes.contains(&manifest.name()) {
                problems.push(format!(
                    "{}:{}: `{name}` belongs in {} only; hand over plain data and use `{}` there",
                    manifest.path(),
                    dependency.line,
                    homes.join(" and "),
                    dependency.package
                ));
            }
        }
    }
    report(problems);
}

/// Returns `true` if `goal` is `start` itself, or one of its direct or indirect dependencies.
fn reaches(edges: &BTreeMap<&str, BTreeSet<&str>>, start: &str, goal: &str) -> bool {
    let mut seen = BTreeSet::from([start]);
    let mut open = vec![start];
    while let Some(folder) = open.pop() {
        if folder == goal {
            return true;
        }
        let next = edges.get(folder).into_iter().flatten();
        open.extend(next.filter(|target| seen.insert(target)));
    }
    false
}

/// A crate without doctests declares so in its manifest, which saves a compilation. A crate with this
/// declaration must not contain doctests.
#[test]
fn doctests_are_looked_for_where_there_are_some() {
    let mut fenced: BTreeMap<String, String> = BTreeMap::new();
    for (file, text) in rust_files() {
        let is_fence =
            |line: &str| ["//! ```", "/// ```"].iter().any(|fence| line.trim_start().starts_with(fence));
        let path = file.to_string_lossy();
        if let Some((folder, _)) = path.split_once("/src/")
            && let Some(number) = text.lines().position(is_fence)
        {
            fenced.entry(folder.to_owned()).or_insert_with(|| format!("{}:{}", file.display(), number + 1));
        }
    }
    let mut problems = Vec::new();
    for manifest in manifests() {
        let is_off = read(manifest.path()).contains("\ndoctest = false\n");
        if let (true, Some(place)) = (is_off, fenced.get(&manifest.folder)) {
            problems.push(format!(
                "{place}: this example is not tested; remove `doctest = false` from {}",
                manifest.path()
            ));
        }
    }
    assert!(!fenced.is_empty());
    report(problems);
}
