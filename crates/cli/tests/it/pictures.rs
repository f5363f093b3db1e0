//! Tests of `arcade render` and `arcade play` as users run them, without a terminal.

use crate::arcade::{run, text};
use serde_json::Value;
use std::fs;

#[test]
fn a_witness_becomes_pictures_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["validate", "foxglove-round", "0", "--witness", "win.json"], 0);
    let episode: engine::Episode =
        serde_json::from_slice(&fs::read(folder.path().join("win.json")).unwrap()).unwrap();
    // The level is found from the episode.
    let draw = |out: &str, tick: &[&str]| {
        let args = ["--json", "render", "foxglove-round", "--episode", "win.json", "-o", out];
        let output = run(folder.path(), &[&args, tick].concat(), 0);
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let gif = draw("win.gif", &[]);
    assert_eq!((&gif["format"], &gif["outcome"]), (&"gif".into(), &"won".into()));
    assert_eq!(gif["ticks"], episode.actions.len());
    assert_eq!(gif["level"], "foxglove-round/lvl0.txt");
    assert!(fs::read(folder.path().join("win.gif")).unwrap().starts_with(b"GIF89a"));
    let png = draw("start.png", &["--tick", "0", "--legend"]);
    assert_eq!((&png["ticks"], &png["outcome"]), (&0.into(), &"ongoing".into()));
    assert!(fs::read(folder.path().join("start.png")).unwrap().starts_with(b"\x89PNG"));
    draw("end.svg", &[]);
    assert!(fs::read_to_string(folder.path().join("end.svg")).unwrap().contains("<title>bee</title>"));
    draw("end.txt", &[]);
    let shown = draw("-", &[]);
    assert_eq!(shown["text"], fs::read_to_string(folder.path().join("end.txt")).unwrap());
    assert!(!folder.path().join("-").exists());
    // The witness has the form in which a snapshot stores it.
    let witness = serde_json::json!({ "canary": "none", "episode": episode });
    fs::write(folder.path().join("witness.json"), witness.to_string()).unwrap();
    run(folder.path(), &["render", "foxglove-round", "--episode", "witness.json", "-o", "-"], 0);
}

#[test]
fn the_same_question_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for out in ["one.gif", "two.gif"] {
        let args = [
            "render",
            "garden-post",
            "1",
            "--planner",
            "mcts",
            "--budget",
            "50",
            "--max-ticks",
            "20",
            "-o",
            out,
        ];
        run(folder.path(), &args, 0);
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("one.gif"), bytes("two.gif"));
}

#[test]
fn undrawable_pictures_are_reported_with_advice() {
    let folder = tempfile::tempdir().unwrap();
    run(
        folder.path(),
        &["render", "quiet-jars", "--planner", "random", "--max-ticks", "3", "-o", "x.txt"],
        0,
    );
    fs::write(folder.path().join("broken.json"), "{}").unwrap();
    run(folder.path(), &["validate", "bog-lantern", "0", "--witness", "bog.json"], 0);
    let check = |args: &[&str], words: &str| {
        let output = run(folder.path(), &[&["render"], args].concat(), 2);
        let message = text(&output.stderr);
        assert!(message.contains(words), "`{words}` is not in\n{message}");
    };
    check(&["quiet-jars", "-o", "x.jpg"], "a file name that ends in .png, .svg, .gif or .txt");
    check(&["quiet-jars", "-o", "x.gif"], "--planner NAME");
    check(&["quiet-jars", "--tick", "3", "-o", "x.png"], "--episode FILE");
    check(&["quiet-jars", "--scale", "2", "-o", "x.png"], "4 to 256");
    check(&["quiet-jars", "--planner", "mtcs", "-o", "x.png"], "mtcs");
    check(&["quiet-jars", "--episode", "broken.json", "-o", "-"], "--record FILE");
    check(&["quiet-jars", "--episode", "bog.json", "-o", "-"], "pass the level's file");
    check(&["quiet-jars", "0", "--episode", "bog.json", "-o", "-"], "was recorded on game");
    check(&["bog-lantern", "--episode", "bog.json", "--tick", "9999", "-o", "-"], "ends after tick");
}

#[test]
fn play_without_a_terminal_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["play", "quiet-jars", "--record", "jars.json"], 2);
    assert!(text(&output.stderr).contains("requires a terminal"), "{}", text(&output.stderr));
    assert!(!folder.path().join("jars.json").exists());
}
