//! Tests of `arcade generate levels`: identical bytes on any number of threads, levels that meet the request,
//! and clear errors.

use crate::arcade::{files, run, sweeping, text};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Generates levels for a corpus game, or for a game in the folder. Returns the answer as JSON.
#[track_caller]
fn generate(folder: &Path, game: &str, out: &str, more: &[&str], status: i32) -> Value {
    let args = ["--json", "generate", "levels", "--game", game, "--out", out];
    let output = run(folder, &[&args, more].concat(), status);
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

#[track_caller]
fn same_bytes(method: &str, game: &str) {
    let home = tempfile::tempdir().unwrap();
    let more = ["--method", method, "--count", "2", "--seed", "bytes"];
    let asked = generate(home.path(), game, "one", &[&more[..], &["--jobs", "1"]].concat(), 0);
    generate(home.path(), game, "three", &[&more[..], &["--jobs", "3"]].concat(), 0);
    let made = files(&home.path().join("one"));
    assert!(made == files(&home.path().join("three")), "{method} levels depend on the number of threads");
    assert_eq!(made.keys().filter(|name| name.starts_with("lvl")).count(), 2);
    assert_eq!(asked["levels"].as_array().unwrap().len(), 2);
    assert_ne!(made["lvl0.txt"], made["lvl1.txt"]);
    // The result is a game with levels, and a win replays on its level.
    if let Some(witness) = made.keys().find(|name| name.starts_with("witness/")) {
        let picture = ["render", "one", "0", "--episode", &format!("one/{witness}"), "-o", "-"];
        assert!(text(&run(home.path(), &picture, 0).stdout).contains("won"));
    }
}

#[test]
fn constructive_levels_are_the_same_on_any_number_of_threads() {
    same_bytes("constructive", "foxglove-round");
}

#[test]
fn searched_levels_are_the_same_on_any_number_of_threads() {
    same_bytes("search", "foxglove-round");
}

#[test]
fn puzzles_are_the_same_on_any_number_of_threads() {
    if sweeping() {
        same_bytes("search", "quiet-jars");
    }
}

#[test]
fn evolved_levels_are_the_same_on_any_number_of_threads() {
    same_bytes("evolutionary", "foxglove-round");
}

#[test]
fn levels_keep_the_requested_counts() {
    let home = tempfile::tempdir().unwrap();
    let asked = ["--count", "2", "--size", "12x9", "--min-solution", "12", "--with", "clover=4"];
    let more = [&asked[..], &["--uses", "clover bee", "--report", "report"]].concat();
    let made = generate(home.path(), "foxglove-round", "new", &more, 0);
    for level in made["levels"].as_array().unwrap() {
        assert_eq!((&level["columns"], &level["rows"]), (&12.into(), &9.into()));
        assert!(level["witness_ticks"].as_u64().unwrap() >= 12, "{level}");
    }
    let report: Value =
        serde_json::from_slice(&fs::read(home.path().join("report/report.json")).unwrap()).unwrap();
    assert_eq!(report["solvability"]["solved"]["count"], 2);
    assert!(home.path().join("report/report.html").exists() && home.path().join("report/sheet.png").exists());
}

/// The user requests more sprites than fit. Every attempt fails, and the answer states this.
#[test]
fn impossible_requests_end_without_a_level() {
    let home = tempfile::tempdir().unwrap();
    let args = [
        "--json",
        "generate",
        "levels",
        "--game",
        "hailglass",
        "--method",
        // A search takes ten times as long to give up.
        if sweeping() { "search" } else { "constructive" },
        "--count",
        "1",
        "--size",
        "10x10",
        "--with",
        "orchid=100",
        "--out",
        "new",
    ];
    let output = run(home.path(), &args, 1);
    let message = text(&output.stderr);
    assert!(
        message.contains("no board has room for the requested sprites: requested 100 of orchid"),
        "{message}"
    );
    assert!(message.contains("--with"), "{message}");
    assert!(!home.path().join("new").exists());
    let asked: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(asked["levels"], serde_json::json!([]));
    assert!(asked["reason"].as_str().unwrap().contains("100 of orchid"), "{asked}");
}

/// Expects exit status 2, a message that contains the given words, and no folder.
#[track_caller]
fn refused(game: &str, more: &[&str], words: &[&str]) {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("idle.vgdl"), NEVER_WON).unwrap();
    let args = [&["generate", "levels", "--game", game, "--out", "new"], more].concat();
    let message = text(&run(home.path(), &args, 2).stderr);
    for part in words {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
    assert!(!home.path().join("new").exists());
}

const NEVER_WON: &str = "BasicGame
    SpriteSet
        wall > Immovable
        avatar > MovingAvatar
    LevelMapping
        w > wall
        A > avatar
    InteractionSet
        avatar wall > stepBack
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
";

#[test]
fn impossible_requests_are_refused_with_advice() {
    refused("hailglas", &[], &["hailglas", "hailglass"]);
    refused("hailglass", &["--method", "magic"], &["magic", "constructive", "evolutionary"]);
    refused("hailglass", &["--difficulty", "brutal"], &["brutal", "very_hard"]);
    refused("hailglass", &["--size", "12"], &["12", "12x9"]);
    refused("hailglass", &["--size", "3x99"], &["3", "between 4 and 64"]);
    refused("hailglass", &["--with", "orchd=2"], &["orchd", "orchid"]);
    refused("hailglass", &["--with", "orchid=100000"], &["100000 sprites", "160 cells"]);
    refused("hailglass", &["--with", "keeper=5"], &["keeper", "one avatar"]);
    refused("foxglove-round", &["--with", "bloom=3"], &["bloom", "no level character"]);
    refused("hailglass", &["--with", "orchid"], &["orchid", "box=3"]);
    refused("hailglass", &["--uses", "keeper hal"], &["hal", "hail"]);
    refused("hailglass", &["--count", "0"], &["0"]);
    refused("hailglass", &["--jobs", "0"], &["--jobs"]);
    refused("idle.vgdl", &[], &["idle.vgdl", "no winning termination"]);
}

#[test]
fn nothing_is_overwritten() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir(home.path().join("old")).unwrap();
    fs::write(home.path().join("old/lvl0.txt"), "mine").unwrap();
    for flags in [["--out", "old"].as_slice(), &["--out", "new", "--report", "old"]] {
        let args =
            [&["generate", "levels", "--game", "hailglass", "--method", "constructive"], flags].concat();
        let output = run(home.path(), &args, 2);
        assert!(text(&output.stderr).contains("old"));
        assert!(!home.path().join("new").exists());
    }
    assert_eq!(fs::read(home.path().join("old/lvl0.txt")).unwrap(), b"mine");
}
