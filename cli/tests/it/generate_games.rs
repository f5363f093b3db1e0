//! `arcade generate games`: the same bytes on any number of threads, games that validate and play, and clear errors.

use crate::arcade::{arcade, files, run, sweeping, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

/// Generates games; returns the answer as JSON.
#[track_caller]
fn generate(folder: &Path, out: &str, more: &[&str], status: i32) -> Value {
    let args = ["--json", "generate", "games", "--out", out];
    let output = run(folder, &[&args, more].concat(), status);
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

#[track_caller]
fn same_bytes(method: &str, kind: &str) {
    let home = tempfile::tempdir().unwrap();
    let (count, kinds) =
        if sweeping() { (2, &["--kind", kind, "--kind", "shooter"][..]) } else { (1, &["--kind", kind][..]) };
    let count_text = count.to_string();
    let more = ["--method", method, "--count", &count_text, "--levels", "2", "--seed", "e"];
    let more = [&more[..], kinds].concat();
    let told = generate(home.path(), "one", &[&more[..], &["--jobs", "1", "--report", "report"]].concat(), 0);
    let report = files(&home.path().join("report"));
    assert_eq!(report.keys().collect::<Vec<_>>(), ["report.html", "report.json", "sheet.png"]);
    let report: Value = serde_json::from_slice(&report["report.json"]).unwrap();
    assert_eq!(report["games"].as_array().unwrap().len(), count);
    generate(home.path(), "three", &[&more[..], &["--jobs", "3"]].concat(), 0);
    let made = files(&home.path().join("one"));
    assert!(made == files(&home.path().join("three")), "{method} games depend on the number of threads");
    let games = told["games"].as_array().unwrap();
    assert_eq!(games.len(), count);
    assert_eq!(made.keys().filter(|name| name.ends_with("game.vgdl")).count(), count);
    for game in games {
        let folder = format!("one/{}", game["id"].as_str().unwrap());
        assert_eq!(game["levels"].as_array().unwrap().len(), 2);
        // A win replays on its level.
        let witness = format!("{folder}/witness/lvl1.json");
        let picture = ["render", &folder, "1", "--episode", &witness, "-o", "-"];
        assert!(text(&run(home.path(), &picture, 0).stdout).contains("won"));
    }
}

#[test]
fn constructive_games_are_the_same_on_any_number_of_threads() {
    same_bytes("constructive", "demolition");
}

#[test]
fn searched_games_are_the_same_on_any_number_of_threads() {
    same_bytes("search", "key-and-door");
}

#[test]
fn evolved_games_are_the_same_on_any_number_of_threads() {
    same_bytes("evolutionary", "key-and-door");
}

#[cfg(unix)]
#[test]
fn an_interruption_is_told() {
    let home = tempfile::tempdir().unwrap();
    let mut command = arcade(home.path());
    command.args(["generate", "games", "--count", "500", "--jobs", "1", "--out", "new"]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    // Signals are caught once there is a folder to write to.
    while !home.path().join("new.partial").exists() {
        thread::sleep(Duration::from_millis(10));
    }
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(text(&output.stderr), "interrupted; nothing is kept: the same command starts over\n");
    assert!(!home.path().join("new").exists());
}

#[test]
fn impossible_requests_are_refused_with_advice() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir(home.path().join("old")).unwrap();
    fs::write(home.path().join("old/mine.txt"), "mine").unwrap();
    let cases: [(&[&str], &[&str]); 7] = [
        (&["--method", "magic"], &["magic", "constructive", "evolutionary"]),
        (&["--kind", "shoter"], &["shoter", "did you mean `shooter`?"]),
        (&["--kind", "herding"], &["herding", "unknown kind"]),
        (&["--count", "0"], &["0"]),
        (&["--levels", "21"], &["21", "20"]),
        (&["--jobs", "0"], &["--jobs"]),
        (&["--report", "old"], &["old"]),
    ];
    for (flags, words) in cases {
        let args = [&["generate", "games", "--out", "new"], flags].concat();
        let message = text(&run(home.path(), &args, 2).stderr);
        for part in words {
            assert!(message.contains(part), "no `{part}` in: {message}");
        }
        assert!(!home.path().join("new").exists());
    }
    let message = text(&run(home.path(), &["generate", "games", "--out", "old"], 2).stderr);
    assert!(message.contains("old"), "{message}");
    assert_eq!(fs::read(home.path().join("old/mine.txt")).unwrap(), b"mine");
}
