//! The origin of everything that is built. External crates come from one registry, each with a checksum and
//! with licences that `deny.toml` allows. Our crates contain no unsafe code. `cargo deny check`, if
//! installed, checks more.

use super::{get, manifests, report};
use std::collections::BTreeSet;
use std::process::Command;
use tests::{read, workspace_root};
use toml::de::{DeTable, DeValue};

const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

#[test]
fn crates_of_others_come_from_one_registry() {
    let source = read("Cargo.lock");
    let root = DeTable::parse(&source).unwrap_or_else(|error| panic!("Cargo.lock: {error}"));
    let packages = get(root.get_ref(), "package").and_then(DeValue::as_array).expect("packages");
    let (mut others, mut problems) = (0, Vec::new());
    for package in packages {
        let Some(package) = package.get_ref().as_table() else { continue };
        let text = |key| get(package, key).and_then(DeValue::as_str);
        let Some(origin) = text("source") else { continue };
        others += 1;
        let has_checksum = text("checksum").is_some_and(|checksum| checksum.len() == 64);
        if origin != REGISTRY || !has_checksum {
            let name = text("name").unwrap_or_default();
            problems.push(format!(
                "Cargo.lock:1: `{name}` is from {origin}; take a release of crates.io, with its checksum"
            ));
        }
    }
    assert!(others > 100, "{others} crates of others");
    report(problems);
}

/// Checks the crates for this platform, with the features that tests use.
#[test]
fn licences_are_allowed() {
    let allowed = allowed();
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--offline", "--locked", "--format-version", "1"])
        .args(["--filter-platform", &host()])
        .current_dir(workspace_root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let (mut others, mut problems) = (0, Vec::new());
    for package in found["packages"].as_array().expect("packages") {
        if package["source"].is_null() {
            continue;
        }
        others += 1;
        let licence = package["license"].as_str().unwrap_or_default();
        if !is_allowed(licence, &allowed) {
            let name = package["name"].as_str().unwrap_or_default();
            problems.push(format!(
                "deny.toml:1: `{name}` has the licence `{licence}`, which is not allowed there; take another crate, or \
                 decide about the licence"
            ));
        }
    }
    assert!(others > 100, "{others} crates of others");
    report(problems);
}

/// Returns the licences that the policy allows.
fn allowed() -> BTreeSet<String> {
    let source = read("deny.toml");
    let root = DeTable::parse(&source).unwrap_or_else(|error| panic!("deny.toml: {error}"));
    let licences = get(root.get_ref(), "licenses").and_then(DeValue::as_table).expect("licenses");
    let names = get(licences, "allow").and_then(DeValue::as_array).expect("allow");
    names.iter().filter_map(|name| name.get_ref().as_str()).map(str::to_owned).collect()
}

/// Returns the compiler's host platform.
fn host() -> String {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).arg("-vV").current_dir(workspace_root()).output().expect("rustc runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host").to_owned()
}

/// Returns `true` if the allowed licences can satisfy a licence expression. The expression uses SPDX syntax,
/// or `/` for `OR` as in older manifests.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let tokens: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = tokens.as_slice();
    any(&mut rest, allowed) == Some(true) && rest.is_empty()
}

/// Evaluates alternatives. `OR` binds less tightly than `AND`. Returns `None` if the expression ends
/// prematurely.
fn any(rest: &mut &[&str], allowed: &BTreeSet<String>) -> Option<bool> {
    let mut holds = all(rest, allowed)?;
    while let ["OR", after @ ..] = rest {
        *rest = after;
        holds |= all(rest, allowed)?;
    }
    Some(holds)
}

fn all(rest: &mut &[&str], allowed: &BTreeSet<String>) -> Option<bool> {
    let mut holds = one(rest, allowed)?;
    while let ["AND", after @ ..] = rest {
        *rest = after;
        holds &= one(rest, allowed)?;
    }
    Some(holds)
}

fn one(rest: &mut &[&str], allowed: &BTreeSet<String>) -> Option<bool> {
    let (name, after) = match *rest {
        ["(", after @ ..] => {
            *rest = after;
            let holds = any(rest, allowed)?;
            *rest = rest.strip_prefix(&[")"])?;
            return Some(holds);
        }
        [licence, "WITH", exception, after @ ..] => (format!("{licence} WITH {exception}"), after),
        [licence, after @ ..] => ((*licence).to_owned(), after),
        [] => return None,
    };
    *rest = after;
    Some(allowed.contains(&name))
}

#[test]
fn licence_expressions_are_understood() {
    let allowed = ["MIT", "ISC", "Apache-2.0 WITH LLVM-exception"].map(str::to_owned).into();
    for expression in
        ["MIT", "GPL-3.0/MIT", "GPL-3.0 OR MIT", "(GPL-3.0 OR MIT) AND ISC", "Apache-2.0 WITH LLVM-exception"]
    {
        assert!(is_allowed(expression, &allowed), "{expression}");
    }
    for expression in ["", "GPL-3.0", "MIT AND GPL-3.0", "Apache-2.0", "(MIT", "MIT ISC", "MIT OR"] {
        assert!(!is_allowed(expression, &allowed), "{expression}");
    }
}

#[test]
fn unsafe_code_is_forbidden() {
    let source = read("Cargo.toml");
    let root = DeTable::parse(&source).unwrap_or_else(|error| panic!("Cargo.toml: {error}"));
    let lint = ["workspace", "lints", "rust"]
        .iter()
        .try_fold(root.get_ref(), |table, key| get(table, key).and_then(DeValue::as_table))
        .and_then(|lints| get(lints, "unsafe_code"))
        .and_then(DeValue::as_str);
    assert_eq!(
        lint,
        Some("forbid"),
        "Cargo.toml: write `unsafe_code = \"forbid\"` in [workspace.lints.rust]"
    );
    let mut problems = Vec::new();
    for manifest in manifests() {
        let source = read(manifest.path());
        let table = DeTable::parse(&source).unwrap_or_else(|error| panic!("{}: {error}", manifest.path()));
        let lints = get(table.get_ref(), "lints").and_then(DeValue::as_table);
        let inherits = lints.and_then(|lints| get(lints, "workspace")).and_then(DeValue::as_bool);
        if inherits != Some(true) {
            problems.push(format!(
                "{}:1: it has lints of its own; write `[lints]` and `workspace = true`",
                manifest.path()
            ));
        }
    }
    report(problems);
}
