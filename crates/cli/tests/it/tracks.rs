//! Tests of `arcade evaluate --track`, which selects a bundle of prompt settings: series of levels, images for
//! mailboxes, and rejections.

use crate::arcade::{arcade, run, text};
use crate::server::{ReceivedRequest, Response, Server};
use serde_json::Value;
use std::fs;
use std::process::Stdio;
use std::time::Duration;

fn json(output: &std::process::Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

/// A model that walks around without knowing the rules.
fn answer(_: usize, asked: &ReceivedRequest) -> Response {
    let last = asked.json()["messages"].as_array().unwrap().last().unwrap()["content"].to_string();
    Response::completion(match last.contains("## Question") {
        true => "KILLS: none\nSTOPS: none\nGOES: none\nSCORES: none",
        false => "ACTION: right",
    })
}

#[test]
fn a_model_discovers_the_rules_and_is_reported_apart() {
    let home = tempfile::tempdir().unwrap();
    let server = Server::start(answer);
    let url = server.base_url();
    let args =
        ["--json", "evaluate", "hailglass", "--levels", "0,1,2", "--model", "scripted", "--base-url", &url];
    let on = |track: &str| {
        let more = ["--max-steps", "4", "--track", track, "--out", track];
        json(&run(home.path(), &[&args[..], &more].concat(), 0))
    };
    let played = on("discover");
    assert_eq!(played["tally"]["practice"], 1, "{played}");
    assert_eq!(played["entrant"]["aids"], serde_json::json!(["track=discover@1"]));
    assert_eq!(played["entrant"]["mode"], "contextual");
    let settings: Value =
        serde_json::from_slice(&fs::read(home.path().join("discover/evaluation.json")).unwrap()).unwrap();
    assert_eq!((&settings["track"], &settings["series"]), (&"discover@1".into(), &3.into()));
    let log = fs::read_to_string(home.path().join("discover/episodes/hailglass-lvl2-run0.jsonl")).unwrap();
    assert!(log.contains("\"event\":\"predictions\"") && log.contains("\"track\":\"discover@1\""), "{log}");
    on("masked");
    on("told");
    // Nothing is left to play.
    let again = ["--max-steps", "4", "--track", "discover", "--out", "discover", "--resume"];
    let before = server.received().len();
    run(home.path(), &[&args[..], &again].concat(), 0);
    assert_eq!(server.received().len(), before);
    let other = run(
        home.path(),
        &[&args[..], &["--max-steps", "4", "--track", "masked", "--out", "told", "--resume"]].concat(),
        2,
    );
    assert!(text(&other.stderr).contains("started with a different"), "{}", text(&other.stderr));
    run(home.path(), &["report", "discover", "masked", "told", "--out", "report"], 0);
    let report = fs::read_to_string(home.path().join("report/report.md")).unwrap();
    for words in [
        "scripted (contextual, track=discover@1)",
        "scripted (zero-shot, track=masked@1)",
        "different tracks",
    ] {
        assert!(report.contains(words), "{words}: {report}");
    }
    assert!(report.contains("## Predictions about the rules"), "{report}");
}

#[test]
fn refusals_name_a_way_on() {
    let home = tempfile::tempdir().unwrap();
    for (more, words) in [
        (&["--player", "mcts:10", "--track", "masked"][..], "the player plans with the rules and the state"),
        (&["--player", "reflex", "--track", "discover"], "use `touch-everything`, which plays without rules"),
        (&["--player", "touch-everything", "--track", "vision"], "choose `told`, `masked` or `discover`"),
        (&["--player", "human", "--track", "vision"], "`mailbox:DIR` puts a PNG file beside each prompt"),
        (&["--player", "cmd:sh", "--track", "vision"], "plays through `mailbox:DIR`"),
        (&["--player", "planner:mcts", "--track", "told"], "pass --rules vgdl"),
        (&["--player", "reflex", "--track", "masked", "--rules", "vgdl"], "`rules=vgdl` contradicts"),
        (&["--player", "reflex", "--track", "masked", "--without", "grid"], "`no-grid` contradicts"),
        (
            &["--player", "mailbox:box", "--track", "discover", "--mode", "zero-shot"],
            "--mode zero-shot contradicts",
        ),
        (&["--player", "random", "--track", "discover", "--commit", "5"], "--commit 5 contradicts"),
        (&["--player", "random", "--track", "discover", "--levels", "1"], "at least two levels per game"),
        (&["--player", "random", "--track", "blind"], "possible values: told, masked, discover, vision"),
    ] {
        let refused =
            run(home.path(), &[&["evaluate", "hailglass", "--out", "results"][..], more].concat(), 2);
        assert!(text(&refused.stderr).contains(words), "{more:?}: {}", text(&refused.stderr));
        assert!(!home.path().join("results").exists(), "{more:?}");
    }
    // A flag that repeats the value that the track (the bundle of prompt settings) sets is not a contradiction.
    let args = [
        "evaluate",
        "hailglass",
        "--levels",
        "0",
        "--max-steps",
        "3",
        "--track",
        "told",
        "--rules",
        "described",
    ];
    run(home.path(), &[&args[..], &["--player", "reflex", "--out", "told"]].concat(), 0);
}

#[test]
fn a_mailbox_has_pictures() {
    let home = tempfile::tempdir().unwrap();
    let args = [
        "evaluate",
        "hailglass",
        "--levels",
        "0",
        "--max-steps",
        "1",
        "--player",
        "mailbox:box",
        "--track",
        "vision",
    ];
    let mut evaluation = arcade(home.path())
        .args(args)
        .args(["--out", "results", "-q"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let folder = home.path().join("box/hailglass-lvl0-run0");
    let prompt = (0..600).find_map(|_| {
        std::thread::sleep(Duration::from_millis(100));
        fs::read_to_string(folder.join("0000-0.prompt.txt")).ok()
    });
    let prompt = prompt.expect("a prompt within a minute");
    assert!(!prompt.contains("## Board") && prompt.contains("## Picture"), "{prompt}");
    assert_eq!(&fs::read(folder.join("0000-0.png")).unwrap()[1..4], b"PNG");
    let partial = home.path().join("answer");
    fs::write(&partial, "ACTION: nil\n").unwrap();
    fs::rename(partial, folder.join("0000-0.answer.txt")).unwrap();
    assert!(evaluation.wait().unwrap().success());
}
