//! The dependency table in `docs/lab/decisions/0002-dependencies.md`, compared with the manifests.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use tests::read;
use toml::de::{DeTable, DeValue};

use super::{get, manifest, manifests, name_of, report};

const TABLE: &str = "docs/lab/decisions/0002-dependencies.md";

/// The folder that has a workspace of its own.
const APART: &str = "tools/fuzz";

#[test]
fn every_dependency_has_its_reason() {
    let page = read(TABLE);
    report(differences(&named(&page), &declared()));
}

#[test]
fn versions_are_stated_once() {
    let mut problems = Vec::new();
    let members = manifests();
    for member in &members {
        // Our own crates may be declared by path, because `tests` uses them under their package names.
        let is_ours = |package: &str| package.starts_with("infinite-arcade");
        let stated = member.dependencies.iter().filter(|dependency| !dependency.inherited);
        for dependency in stated.filter(|dependency| !is_ours(&dependency.package)) {
            problems.push(format!(
                "{}:{}: `{}` has a version of its own; state it in [workspace.dependencies] and write \
                 `{}.workspace = true`",
                member.path(),
                dependency.line,
                dependency.package,
                dependency.package
            ));
        }
    }
    report(problems);
}

#[test]
fn missing_and_superfluous_rows_are_found() {
    let page = "| Need | Crate | Why |\n|---|---|---|\n| data | `serde`, `serde_json` | well kept |\n";
    let declared = |names: &[&str]| -> BTreeMap<String, String> {
        names.iter().map(|name| ((*name).to_owned(), format!("engine/Cargo.toml:{}", name.len()))).collect()
    };
    assert_eq!(named(page), [("serde".to_owned(), 3), ("serde_json".to_owned(), 3)]);
    assert!(differences(&named(page), &declared(&["serde", "serde_json"])).is_empty());
    let found = differences(&named(page), &declared(&["rand", "serde"]));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("engine/Cargo.toml:4: `rand` has no row"), "{found:?}");
    assert!(
        found[1].starts_with("docs/lab/decisions/0002-dependencies.md:3: `serde_json` is in no"),
        "{found:?}"
    );
}

/// Returns the crates in backticks in the second column of a page's tables, each with its line.
fn named(page: &str) -> Vec<(String, usize)> {
    let mut named = Vec::new();
    for (line, number) in page.lines().zip(1..) {
        let Some(column) = line.strip_prefix('|').and_then(|row| row.split('|').nth(1)) else { continue };
        named.extend(column.split('`').skip(1).step_by(2).map(|name| (name.to_owned(), number)));
    }
    named
}

/// Returns the external crates that any manifest declares, each with one such manifest.
fn declared() -> BTreeMap<String, String> {
    let source = read("Cargo.toml");
    let root = DeTable::parse(&source).unwrap_or_else(|error| panic!("Cargo.toml: {error}"));
    let workspace = get(root.get_ref(), "workspace").and_then(DeValue::as_table);
    let shared = workspace.and_then(|workspace| get(workspace, "dependencies")).and_then(DeValue::as_table);
    let mut declared = BTreeMap::new();
    for (name, value) in shared.into_iter().flatten() {
        if value.get_ref().as_table().is_none_or(|table| get(table, "path").is_none()) {
            let line = source[..name.span().start].matches('\n').count() + 1;
            declared.insert(name.get_ref().to_string(), format!("Cargo.toml:{line}"));
        }
    }
    let members = manifests();
    let is_there = tests::workspace_root().join(Path::new(APART)).is_dir();
    let apart = is_there.then(|| manifest(APART, None));
    for member in members.iter().chain(&apart) {
        for dependency in &member.dependencies {
            if name_of(&members, &dependency.package).is_none() {
                let place = format!("{}:{}", member.path(), dependency.line);
                declared.entry(dependency.package.clone()).or_insert(place);
            }
        }
    }
    declared
}

/// Returns the problems: first missing rows, then rows without a dependency.
fn differences(named: &[(String, usize)], declared: &BTreeMap<String, String>) -> Vec<String> {
    let rows: BTreeSet<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
    let missing = declared.iter().filter(|(name, _)| !rows.contains(name.as_str()));
    let missing = missing.map(|(name, place)| {
        format!("{place}: `{name}` has no row in {TABLE}; add one with the reason and what else was weighed")
    });
    let superfluous = named.iter().filter(|(name, _)| !declared.contains_key(name));
    let superfluous = superfluous
        .map(|(name, line)| format!("{TABLE}:{line}: `{name}` is in no manifest; remove it from the table"));
    missing.chain(superfluous).collect()
}
