//! Tests of regenerating a release.

use crate::arcade::{TINY, arcade, copy_of_tiny, copy_tree, files, run, terminate, text};
use std::fs;
use std::process::Stdio;

/// For a release of a different generation, the answer states the version that mints it, and the commands to
/// install that version.
#[test]
fn an_old_release_names_the_version_that_regenerates_it() {
    let stored = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/suite/snapshots/format-1");
    let output = run(TINY.path(), &["regenerate", stored], 2);
    let stderr = text(&output.stderr);
    assert!(stderr.contains("minted by arcade 0.6.0 (GENERATION 6, SEMANTICS 2)"), "{stderr}");
    let command = "git checkout ea25e6ab8ad7 && cargo install --locked --path cli";
    assert!(stderr.contains(command), "{stderr}");
}

/// A changed seed would mint a different release, so the change is reported before minting.
#[test]
fn a_changed_seed_is_damage() {
    let (folder, root) = copy_of_tiny();
    let manifest = fs::read_to_string(root.join("MANIFEST.json")).unwrap();
    assert!(manifest.contains("a coin"), "{manifest}");
    fs::write(root.join("MANIFEST.json"), manifest.replacen("a coin", "a corn", 1)).unwrap();
    let output = run(folder.path(), &["regenerate", "tiny", "--out", "again"], 2);
    let said = text(&output.stderr);
    assert!(said.contains("the root does not match the content"), "{said}");
    assert_eq!(text(&output.stdout), "");
    assert!(!folder.path().join("again").exists() && !folder.path().join("again.partial").exists());
}

/// Unreadable files are reported before the work starts. Root may read any file, so there is nothing to test
/// as root.
#[allow(clippy::print_stdout, reason = "a skipped test says so")]
#[cfg(unix)]
#[test]
fn unreadable_files_are_reported_before_minting() {
    use std::os::unix::fs::PermissionsExt;
    let (folder, root) = copy_of_tiny();
    let file = root.join("CARD.json");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o0)).unwrap();
    if fs::File::open(&file).is_ok() {
        println!("SKIPPED: this user may read any file");
        return;
    }
    let said = text(&run(folder.path(), &["regenerate", "tiny", "--out", "again"], 3).stderr);
    assert!(said.contains("CARD.json") && said.contains("Permission denied"), "{said}");
    assert!(!said.contains("jobs"), "{said}");
}

#[test]
fn a_manifest_alone_is_regenerated() {
    let (home, root) = copy_of_tiny();
    let folder = home.path();
    let manifest = fs::read(root.join("MANIFEST.json")).unwrap();
    let alone = |name: &str| {
        fs::create_dir(folder.join(name)).unwrap();
        fs::write(folder.join(name).join("MANIFEST.json"), &manifest).unwrap();
    };
    alone("bare");
    let said = text(&run(folder, &["regenerate", "bare", "--out", "full"], 0).stdout);
    let root_of = snapshots::Manifest::parse(&manifest).unwrap().root;
    let expect = format!(
        "bare has no files to compare with; the root of the regenerated release is {root_of}, the same as the manifest's\n\
         the regenerated release is in full\n"
    );
    assert_eq!(said, expect);
    assert_eq!(files(&folder.join("full")), files(&root));
    let again = ["regenerate", "bare", "--out", "full", "--resume"];
    let output = run(folder, &[&["--json"], &again[..]].concat(), 0);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&document["identical"], &document["files_compared"]), (&true.into(), &false.into()));
    // If one of the files is present, the other files are missing.
    fs::write(folder.join("bare/README.md"), fs::read(root.join("README.md")).unwrap()).unwrap();
    let said = text(&run(folder, &again, 1).stdout);
    assert!(said.contains("CARD.json: missing") && said.contains("NOT identical"), "{said}");
}

/// A finished folder is not minted again, but it is still compared.
#[test]
fn a_finished_regeneration_is_complete() {
    let (home, root) = copy_of_tiny();
    let folder = home.path();
    copy_tree(&root, &folder.join("again"));
    let regenerate = ["regenerate", "tiny", "--out", "again"];
    let resumed = [&regenerate[..], &["--resume"]].concat();
    let said = text(&run(folder, &resumed, 0).stdout);
    assert!(said.starts_with("already complete: again; nothing was minted\nidentical: "), "{said}");
    let document: serde_json::Value =
        serde_json::from_slice(&run(folder, &[&resumed[..], &["--json"]].concat(), 0).stdout).unwrap();
    assert_eq!((&document["out"], &document["complete"]), (&"again".into(), &true.into()));
    let said = text(&run(folder, &regenerate, 2).stderr);
    assert!(said.contains("is not an empty folder"), "{said}");
    fs::write(root.join("README.md"), "x").unwrap();
    let said = text(&run(folder, &resumed, 1).stdout);
    assert!(said.contains("README.md: differs"), "{said}");
    fs::write(folder.join("again/README.md"), "x").unwrap();
    run(folder, &resumed, 2);
}

/// Without `--out`, an interruption loses the work. Long runs state this at their start and at their end.
#[cfg(unix)]
#[test]
fn an_interrupted_regeneration_ends_with_its_status() {
    use std::io::{BufRead, BufReader};
    let (home, root) = copy_of_tiny();
    let path = root.join("MANIFEST.json");
    let mut manifest = snapshots::Manifest::parse(&fs::read(&path).unwrap()).unwrap();
    let recipe = snapshots::Recipe::from_toml(include_str!("../../../../seeds/starter.toml")).unwrap();
    manifest.recipe = serde_json::to_value(recipe).unwrap();
    manifest.seal_root().unwrap();
    fs::write(&path, manifest.to_bytes().unwrap()).unwrap();
    let mut command = arcade(home.path());
    command.args(["regenerate", "tiny", "--jobs", "1"]).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    let first = lines.next().unwrap();
    assert_eq!(first, "if interrupted, this must start over: --resume requires --out");
    terminate(&child);
    assert_eq!(child.wait().unwrap().code(), Some(143));
    assert_eq!(lines.last().as_deref(), Some("interrupted; nothing is kept without --out"));
}

/// A forged recipe that allows endless searches is rejected before the searches begin.
#[test]
fn endless_recipes_are_not_regenerated() {
    let (home, root) = copy_of_tiny();
    let path = root.join("MANIFEST.json");
    let whole = snapshots::Manifest::parse(&fs::read(&path).unwrap()).unwrap();
    let changes: [(&str, serde_json::Value); 2] =
        [("budget", 1_000_000_000_000_u64.into()), ("ladder", serde_json::json!(["random", "mcts:1000000"]))];
    for (key, value) in changes {
        let mut manifest = whole.clone();
        manifest.recipe["criteria"][key] = value;
        manifest.recipe["criteria"]["ask"].as_array_mut().unwrap().push("skill".into());
        manifest.seal_root().unwrap();
        fs::write(&path, manifest.to_bytes().unwrap()).unwrap();
        let output = run(home.path(), &["regenerate", "tiny"], 1);
        let said = text(&output.stdout);
        assert!(said.contains("NOT regenerated") && said.contains("--max-work"), "{key}: {said}");
    }
    fs::write(&path, whole.to_bytes().unwrap()).unwrap();
    let said = text(&run(home.path(), &["regenerate", "tiny", "--max-work", "1000"], 1).stdout);
    assert!(said.contains("--max-work is 1000"), "{said}");
}
