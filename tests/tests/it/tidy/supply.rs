//! The origin of what is built: crates of others come from one registry, each with its checksum, and no crate of ours
//! has unsafe code.

use super::{get, manifests, report};
use tests::read;
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
