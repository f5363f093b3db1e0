//! `arcade stream`.

use crate::arcade::{TINY, run, text};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Returns the lines that the command prints.
#[track_caller]
fn lines(folder: &Path, more: &[&str], status: i32) -> Vec<String> {
    let args = [&["stream", "lines", "--games", "hailglass,foxglove-round"], more].concat();
    text(&run(folder, &args, status).stdout).lines().map(str::to_owned).collect()
}

#[test]
fn items_are_the_same_in_every_process() {
    let home = tempfile::tempdir().unwrap();
    let all = lines(home.path(), &["--count", "6", "--jobs", "2"], 0);
    assert_eq!(all.len(), 6);
    assert_eq!(lines(home.path(), &["--from", "4", "--count", "2", "--jobs", "1"], 0), all[4..]);
    for (index, line) in all.iter().enumerate() {
        let item: Value = serde_json::from_str(line).unwrap();
        assert_eq!((&item["index"], &item["path"][0][0]), (&index.into(), &"train".into()), "{line}");
        assert_eq!(item["witness"].as_str().unwrap().len(), item["length"].as_u64().unwrap() as usize);
    }
    // The order of the games does not matter.
    let other = ["stream", "lines", "--games", "foxglove-round", "--games", "hailglass", "--count", "1"];
    assert_eq!(text(&run(home.path(), &other, 0).stdout).trim_end(), all[0]);
}

#[test]
fn a_folder_holds_games_that_the_program_accepts() {
    let home = tempfile::tempdir().unwrap();
    let asked = ["--from", "7", "--count", "2", "--difficulty", "0", "--format", "folder", "--out", "new"];
    assert_eq!(lines(home.path(), &asked, 0).len(), 1);
    let items = fs::read_to_string(home.path().join("new/items.jsonl")).unwrap();
    assert_eq!(items.lines().count(), 2);
    for line in items.lines() {
        let item: Value = serde_json::from_str(line).unwrap();
        let (game, index) = (item["game"].as_str().unwrap(), item["index"].as_u64().unwrap());
        let (folder, witness) = (format!("new/{game}"), format!("new/{game}/witness/lvl{index}.json"));
        let replay = ["render", &folder, &index.to_string(), "--episode", &witness, "-o", "-"];
        assert!(text(&run(home.path(), &replay, 0).stdout).contains("won"));
    }
    let refused = ["stream", "lines", "--format", "folder", "--out", "new"];
    assert!(text(&run(home.path(), &refused, 2).stderr).contains("new"));
}

#[test]
fn one_document_holds_all_items() {
    let home = tempfile::tempdir().unwrap();
    let asked = ["--json", "stream", "lines", "--games", "hailglass", "--count", "2"];
    let document: Value = serde_json::from_slice(&run(home.path(), &asked, 0).stdout).unwrap();
    assert_eq!(document["items"].as_array().map(Vec::len), Some(2));
}

#[test]
fn releases_are_avoided_only_if_they_verify() {
    let avoid = ["--count", "1", "--avoid", "tiny"];
    assert_eq!(lines(TINY.path(), &avoid, 0).len(), 1);
    let (_home, damaged) = crate::arcade::copy_of_tiny();
    let level = fs::read_dir(damaged.join("games")).unwrap().next().unwrap().unwrap().path().join("lvl0.txt");
    fs::write(level, "w").unwrap();
    let said = lines(damaged.parent().unwrap(), &avoid, 1).join("\n");
    assert!(said.contains("does NOT verify"), "{said}");
}

/// Expects exit status 2 and a message that contains the given words.
#[track_caller]
fn refused(more: &[&str], words: &str) {
    let home = tempfile::tempdir().unwrap();
    let args = [&["stream", "lines"], more].concat();
    let message = text(&run(home.path(), &args, 2).stderr);
    assert!(message.contains(words), "{message}");
}

#[test]
fn faults_are_named_with_the_next_step() {
    refused(&["--games", "hailglas"], "did you mean the corpus game `hailglass`");
    refused(&["--games", "hailglass,hailglass"], "`hailglass` and `hailglass` have the same rules: omit one");
    refused(&["--difficulty", "1.5"], "expected a number from 0 to 1");
    refused(&["--size", "12"], "expected columns and rows");
    refused(
        &["--games", "hailglass", "--size", "2x2"],
        "hailglass: no level can be made for this game: columns from 2 to 2: both must be",
    );
    refused(&["--format", "folder"], "--out");
    refused(&["--out", "new"], "omit --out, or choose --format folder");
    refused(&["--avoid", "nowhere"], "nowhere");
    refused(&["--count", "0"], "--count");
}

#[test]
fn an_index_without_a_level_is_reported_and_skipped() {
    let home = tempfile::tempdir().unwrap();
    let output = run(home.path(), &["stream", "lines", "--games", "heath-fire", "--count", "1"], 1);
    assert!(output.stdout.is_empty());
    assert!(text(&output.stderr).contains("item 0 has no level"), "{}", text(&output.stderr));
}
