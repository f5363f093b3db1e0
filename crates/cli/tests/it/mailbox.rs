//! Tests of `arcade mailbox`, and of `arcade evaluate` with players that answer through files.

use crate::arcade::{arcade, run, text};
use evaluation::log::{Event, read, without_times};
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Output, Stdio};

const EPISODES: [&str; 2] = ["hailglass-lvl0-run0", "hailglass-lvl1-run0"];

fn evaluate(home: &Path, more: &[&str]) -> Child {
    let mut command = arcade(home);
    command.args(["evaluate", "hailglass", "--levels", "0,1", "--max-steps", "3", "--jobs", "2"]);
    command.args(["--player", "mailbox:box", "--name", "alice", "--out", "results"]).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until the mailbox contains the given number of open prompts.
fn wait(home: &Path, prompts: usize) -> Value {
    loop {
        let listed = arcade(home).args(["--json", "mailbox", "box"]).output().unwrap();
        let listed: Value = serde_json::from_slice(&listed.stdout).unwrap();
        if listed["waiting"].as_array().is_some_and(|waiting| waiting.len() == prompts) {
            return listed;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
}

/// Types lines into `arcade mailbox`.
fn answer(home: &Path, more: &[&str], typed: &str) -> Output {
    let mut command = arcade(home);
    command.args(["mailbox", "box"]).args(more);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(typed.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

fn logs(home: &Path) -> Vec<Vec<Event>> {
    let log = |episode: &&str| {
        let log = read(&home.join(format!("results/episodes/{episode}.jsonl"))).unwrap();
        log.iter().map(without_times).collect()
    };
    EPISODES.iter().map(log).collect()
}

/// Two episodes are played side by side, interrupted and resumed. Their logs equal the logs without an
/// interruption.
#[test]
fn episodes_are_answered_interrupted_and_resumed() {
    let (whole, broken) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (whole, broken) = (whole.path(), broken.path());
    let mut playing = evaluate(whole, &[]);
    let listed = wait(whole, 2);
    assert_eq!((&listed["player"], &listed["running"]), (&"alice".into(), &true.into()));
    let sat = answer(whole, &[], "left\nfly\nsay fly\nr\nn\nright\nRIGHT\nright\n");
    let (out, err) = (text(&sat.stdout), text(&sat.stderr));
    assert_eq!(sat.status.code(), Some(0), "{out}{err}");
    assert!(err.contains("`fly` isn't one of nil, left, right, use"), "{err}");
    assert!(out.contains("Your answer cannot be used: it names no action."), "{out}");
    assert!(
        out.contains(&format!("--- {} has ended ---\n## End\nThe limit of 3 actions", EPISODES[0])),
        "{out}"
    );
    assert!(out.ends_with("the evaluation is over: 0 of 2 episodes won\n"), "{out}");
    assert_eq!(out.matches("How you win:").count(), 2, "the rules are shown once an episode: {out}");
    assert_eq!(playing.wait().unwrap().code(), Some(0));

    let mut playing = evaluate(broken, &[]);
    wait(broken, 2);
    let sat = answer(broken, &["--episode", EPISODES[0]], "left\nsay fly\n");
    assert_eq!(sat.status.code(), Some(1));
    playing.kill().unwrap();
    playing.wait().unwrap();
    // The prompts stay open, so answers given now are read later.
    let sat = answer(broken, &["--episode", EPISODES[1]], "right\n");
    assert!(text(&sat.stdout).contains("no evaluation is running here"), "{}", text(&sat.stdout));
    let listed = wait(broken, 1);
    assert_eq!((&listed["unread"], &listed["running"]), (&1.into(), &false.into()));
    let refused = evaluate(broken, &[]).wait_with_output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        text(&refused.stderr).contains("continue the evaluation with --resume"),
        "{}",
        text(&refused.stderr)
    );
    let mut playing = evaluate(broken, &["--resume"]);
    // Both answers are read.
    wait(broken, 2);
    let sat = answer(broken, &["--episode", EPISODES[0]], "r\nn\n");
    assert_eq!(sat.status.code(), Some(1), "{}", text(&sat.stderr));
    answer(broken, &[], "right\nright\n");
    assert_eq!(playing.wait().unwrap().code(), Some(0));
    assert_eq!(logs(broken), logs(whole));
    run(broken, &["report", "results", "--out", "report"], 0);
}

#[test]
fn malformed_requests_are_reported() {
    let home = tempfile::tempdir().unwrap();
    let check = |args: &[&str], expect: &str| {
        let output = run(home.path(), args, 2);
        let told = text(&output.stderr);
        assert!(told.contains(expect), "{told}");
    };
    check(&["mailbox", "box"], "there is no mailbox here");
    check(&["evaluate", "hailglass", "--player", "mailbox:"], "`mailbox:` has no folder");
    check(
        &["evaluate", "hailglass", "--player", "random", "--name", "bob"],
        "--name applies only to the players",
    );
    for flag in ["--timeout", "--tries", "--concurrency"] {
        let applies = format!("{flag} applies only to language models");
        check(&["evaluate", "hailglass", "--player", "mailbox:box", flag, "5"], &applies);
    }
    std::fs::write(home.path().join("box"), "a file").unwrap();
    check(&["mailbox", "box"], "box: there is no mailbox here");
    check(&["evaluate", "hailglass", "--player", "mailbox:box"], "a mailbox is a folder");
    assert!(!home.path().join("results").exists(), "nothing is written before the mailbox is open");
    let forecast = run(home.path(), &["evaluate", "hailglass", "--player", "mailbox:box", "--dry-run"], 0);
    assert!(text(&forecast.stdout).contains("episodes of at most"));
}
