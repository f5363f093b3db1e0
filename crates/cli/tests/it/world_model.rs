//! Tests of `arcade world-model`.

use crate::arcade::{arcade, run, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;

const GAME: &str = "BasicGame\n    SpriteSet\n        goal > Door\n        hero > MovingAvatar\n    LevelMapping\n        g > goal\n        h > hero\n    InteractionSet\n        hero wall > stepBack\n        goal hero > killSprite scoreChange=1\n    TerminationSet\n        SpriteCounter stype=goal limit=0 win=True\n";

fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("goal.vgdl"), GAME).unwrap();
    fs::write(home.path().join("goal_lvl0.txt"), "wwwwww\nwh  gw\nw    w\nwwwwww\n").unwrap();
    home
}

fn results(home: &Path, out: &str) -> Value {
    serde_json::from_slice(&fs::read(home.join(out).join("results.json")).unwrap()).unwrap()
}

#[test]
fn the_reference_player_learns_a_small_game() {
    let home = home();
    let home = home.path();
    let command = ["world-model", "goal.vgdl", "--player", "induce", "--out", "models"];
    let out = text(&run(home, &command, 0).stdout);
    assert!(out.contains("plans win 1 of 1 levels (true game: 1)"), "{out}");
    let game = &results(home, "models")["goal"];
    assert_eq!((&game["attempts"], &game["problems"]), (&1.into(), &Value::Null));
    let kinds = game["score"]["kinds"].as_object().unwrap();
    assert!(kinds.values().all(|kind| kind["state"] == kind["transitions"]), "{kinds:?}");
    assert!(fs::read_to_string(home.join("models/games/goal.vgdl")).unwrap().contains("SpriteSet"));
    // The same command writes the same bytes again, from its log.
    let before = fs::read(home.join("models/results.json")).unwrap();
    run(home, &command, 2);
    run(home, &[&command[..], &["--resume"]].concat(), 0);
    assert_eq!(fs::read(home.join("models/results.json")).unwrap(), before);
    run(home, &[&command[..], &["--resume", "--hints", "none"]].concat(), 2);
}

fn wait(path: &Path, examination: &mut Child) -> String {
    loop {
        match fs::read_to_string(path) {
            Ok(text) => return text,
            Err(_) => assert_eq!(examination.try_wait().unwrap(), None, "{}", path.display()),
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn answers_may_be_files() {
    let home = home();
    let home = home.path();
    let mut command = arcade(home);
    command.args([
        "world-model",
        "goal.vgdl",
        "--player",
        "mailbox:box",
        "--explore",
        "9",
        "--out",
        "models",
    ]);
    let mut examination = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let folder = home.join("box/goal");
    let question = wait(&folder.join("0000-0.prompt.txt"), &mut examination);
    assert!(question.contains("PLAY 0:") && !question.contains("goal"), "{question}");
    fs::write(folder.join("0000-0.answer.txt"), "PLAY 0: right right right\n").unwrap();
    let recording = wait(&folder.join("0003-0.prompt.txt"), &mut examination);
    assert!(recording.contains("3 right: ") && recording.contains("the player has won"), "{recording}");
    fs::write(folder.join("0003-0.answer.txt"), "BasicGame\n  SpriteSet\n    t1 > Dor\n").unwrap();
    let complaint = wait(&folder.join("0003-1.prompt.txt"), &mut examination);
    assert!(complaint.contains("`Dor`"), "{complaint}");
    fs::write(folder.join("0003-1.answer.txt"), "I give up.\n").unwrap();
    wait(&folder.join("0003-2.prompt.txt"), &mut examination);
    fs::write(folder.join("0003-2.answer.txt"), "I really do.\n").unwrap();
    assert_eq!(examination.wait().unwrap().code(), Some(0));
    let game = &results(home, "models")["goal"];
    assert_eq!((&game["attempts"], &game["explored"], &game["game"]), (&3.into(), &3.into(), &Value::Null));
    assert!(home.join("box/finished.json").exists());
}
