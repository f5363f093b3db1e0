//! Tests of `arcade generate games`: identical bytes on any number of threads, games that validate and play,
//! and clear errors.

use crate::arcade::{arcade, files, run, sweeping, terminate, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::Duration;

/// Generates games. Returns the answer as JSON.
#[track_caller]
fn generate(folder: &Path, out: &str, more: &[&str], status: i32) -> Value {
    let args = ["--json", "generate", "games", "--out", out];
    let output = run(folder, &[&args, more].concat(), status);
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

/// Checks that there are `count` games with `count` playable levels each, and that their report is complete.
#[track_caller]
fn are_whole(home: &Path, made: &str, told: &Value, count: usize) {
    let report = files(&home.join("report"));
    assert_eq!(report.keys().collect::<Vec<_>>(), ["report.html", "report.json", "sheet.png"]);
    let report: Value = serde_json::from_slice(&report["report.json"]).unwrap();
    assert_eq!(report["games"].as_array().unwrap().len(), count);
    let games = told["games"].as_array().unwrap();
    assert_eq!(games.len(), count);
    let found = files(&home.join(made));
    assert_eq!(found.keys().filter(|name| name.ends_with("game.vgdl")).count(), count);
    for game in games {
        let folder = format!("{made}/{}", game["id"].as_str().unwrap());
        assert_eq!(game["levels"].as_array().unwrap().len(), count);
        // A win replays on its level.
        let witness = format!("{folder}/witness/lvl0.json");
        let picture = ["render", &folder, "0", "--episode", &witness, "-o", "-"];
        assert!(text(&run(home, &picture, 0).stdout).contains("won"));
    }
}

/// Runs only in `cargo xtask sweep`. A test below resumes on a different number of threads, and the crate
/// `forge` tests the searches for inventions.
#[test]
fn games_are_the_same_on_any_number_of_threads() {
    if !sweeping() {
        return;
    }
    let home = tempfile::tempdir().unwrap();
    let more = ["--count", "2", "--levels", "2", "--seed", "f", "--kind", "survival", "--kind", "shooter"];
    let told = generate(home.path(), "one", &[&more[..], &["--jobs", "1", "--report", "report"]].concat(), 0);
    are_whole(home.path(), "one", &told, 2);
    generate(home.path(), "three", &[&more[..], &["--jobs", "3"]].concat(), 0);
    let made = files(&home.path().join("one"));
    assert!(made == files(&home.path().join("three")), "games depend on the number of threads");
}

/// Three threads make the games without interruption, and one thread makes them with an interruption.
#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on_with_the_same_bytes() {
    let home = tempfile::tempdir().unwrap();
    let more = ["--kind", "survival", "--count", "1", "--levels", "1", "--seed", "f"];
    let whole = [&more[..], &["--jobs", "3", "--report", "report"]].concat();
    let told = generate(home.path(), "whole", &whole, 0);
    are_whole(home.path(), "whole", &told, 1);
    let args = [&["generate", "games", "--jobs", "1", "--out", "new"], &more[..]].concat();
    let mut command = arcade(home.path());
    let child = command.args(&args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let finished = || {
        let jobs = fs::read_dir(home.path().join("new.partial/jobs")).into_iter().flatten().flatten();
        jobs.filter(|job| job.path().extension().is_some_and(|kind| kind == "json")).count()
    };
    while finished() < 2 {
        thread::sleep(Duration::from_millis(5));
    }
    terminate(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(143));
    let hint = "interrupted; finished work is kept: continue with the same command and --resume\n";
    assert!(text(&output.stderr).ends_with(hint), "{}", text(&output.stderr));
    assert!(!home.path().join("new").exists());
    let message = text(&run(home.path(), &args, 2).stderr);
    assert!(message.contains("--resume"), "{message}");
    let other = [&args[..], &["--resume", "--seed", "another"]].concat();
    run(home.path(), &other, 2);
    assert!(finished() >= 2);
    assert!(told == generate(home.path(), "new", &[&more[..], &["--jobs", "1", "--resume"]].concat(), 0));
    assert!(files(&home.path().join("whole")) == files(&home.path().join("new")));
    assert!(!home.path().join("new.partial").exists());
}

#[test]
fn impossible_requests_are_refused_with_advice() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir(home.path().join("old")).unwrap();
    fs::write(home.path().join("old/mine.txt"), "mine").unwrap();
    let cases: [(&[&str], &[&str]); 8] = [
        (&["--method", "magic"], &["magic", "constructive", "evolutionary"]),
        (&["--kind", "shooter", "--method", "search"], &["kernels", "leave out --method or --kind"]),
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
