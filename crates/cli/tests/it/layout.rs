//! Tests of how games and levels are found by name: folders, the layout of the public games, single levels,
//! and other dialects.

use crate::arcade::{run, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const GAME: &str = "BasicGame\n    SpriteSet\n        gem > Immovable\n        avatar > MovingAvatar\n    LevelMapping\n        g > gem\n    InteractionSet\n        gem avatar > killSprite scoreChange=1\n        avatar wall > stepBack\n    TerminationSet\n        SpriteCounter stype=gem win=True\n        Timeout limit=9 win=False\n";

/// Returns a folder with two games in the layout of the public games, a game in its own folder, and levels
/// elsewhere.
fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    for folder in ["public", "mine/levels", "other"] {
        fs::create_dir_all(at(folder)).unwrap();
    }
    for (name, text) in [
        ("public/pond.txt", GAME),
        ("public/pond_lvl0.txt", "wwww\nwAgw\nwwww\n"),
        ("public/pond_lvl2.txt", "\u{feff}wwwww\r\nwA gw\r\nwwwww\r\n"),
        ("public/pond_glvl.txt", "no game\n"),
        ("public/x-hill.TXT", GAME),
        ("public/X-Hill_LVL7.TXT", "wAgw\nw  w\n"),
        ("mine/game.vgdl", GAME),
        ("mine/lvl0.txt", "Ag\n  \n"),
        ("mine/lvl1.txt", "A g\n   \n"),
        ("mine/levels/far.txt", "A  g\n    \n"),
        ("other/lvl3.txt", "A   g\n     \n"),
    ] {
        fs::write(at(name), text).unwrap();
    }
    home
}

fn json(folder: &Path, args: &[&str], status: i32) -> Value {
    let args: Vec<&str> = args.iter().copied().chain(["--json"]).collect();
    serde_json::from_slice(&run(folder, &args, status).stdout).unwrap()
}

/// Returns the games and levels that `run` plays.
#[track_caller]
fn played(folder: &Path, games: &[&str]) -> Vec<String> {
    let options = ["--planner", "do-nothing", "--runs", "1", "--max-ticks", "1", "--by-level"];
    let args: Vec<&str> = ["run"].iter().chain(games).chain(&options).copied().collect();
    let report = json(folder, &args, 0);
    let rows = report["rows"].as_array().unwrap().iter();
    let rows = rows.filter(|row| !row["level"].is_null());
    rows.map(|row| format!("{} {}", row["game"].as_str().unwrap(), row["level"])).collect()
}

#[test]
fn what_is_not_taken_as_a_level_is_told() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::create_dir_all(folder.join("mine/lvl1.txt")).unwrap();
    fs::write(folder.join("mine/game.vgdl"), GAME).unwrap();
    fs::write(folder.join("mine/level0.txt"), "Ag\n  \n").unwrap();
    let misnamed = "`mine/level0.txt` is ignored, because levels of this game are named like `lvl0.txt`";
    let is_folder = "`mine/lvl1.txt` is ignored, because it is a folder";
    let said = |args: &[&str], status: i32| text(&run(folder, args, status).stderr);
    let told = said(&["validate", "mine"], 2);
    assert!(told.contains(misnamed) && told.contains(is_folder), "{told}");
    fs::write(folder.join("mine/lvl0.txt"), "Ag\n  \n").unwrap();
    let play = ["--planner", "do-nothing", "--runs", "1", "--max-ticks", "1"];
    let told = said(&[&["run", "mine"], &play[..]].concat(), 0);
    assert_eq!(told.matches("is ignored, because").count(), 2, "{told}");
    assert!(told.contains("like `lvl2.txt`"), "{told}");
    // A level that the user specifies is accepted.
    let told =
        said(&["run", "mine/level0.txt", "--planner", "do-nothing", "--runs", "1", "--max-ticks", "1"], 0);
    assert!(!told.contains("is ignored, because"), "{told}");
}

#[test]
fn games_are_found_with_the_levels_beside_them() {
    let home = home();
    let folder = home.path();
    assert_eq!(played(folder, &["public/pond.txt"]), ["public/pond.txt 0", "public/pond.txt 2"]);
    assert_eq!(played(folder, &["public"]), ["pond 0", "pond 2", "x-hill 7"]);
    assert_eq!(played(folder, &["mine"]), ["mine 0", "mine 1"]);
    assert_eq!(played(folder, &["."]), ["mine 0", "mine 1", "pond 0", "pond 2", "x-hill 7"]);
    let error = text(&run(folder, &["describe", "public"], 2).stderr);
    assert!(error.contains("2 games") && error.contains("public/pond.txt"), "{error}");
    let error = text(&run(folder, &["describe", "public/pond"], 2).stderr);
    assert!(error.contains("did you mean `public/pond.txt`?"), "{error}");
}

#[test]
fn levels_find_their_game() {
    let home = home();
    let folder = home.path();
    assert_eq!(played(folder, &["public/pond_lvl2.txt"]), ["public/pond.txt 2"]);
    assert_eq!(played(folder, &["mine/lvl0.txt", "mine/lvl1.txt"]), ["mine/game.vgdl 0", "mine/game.vgdl 1"]);
    assert_eq!(played(folder, &["mine", "other/lvl3.txt"]), ["mine 3"]);
    assert_eq!(played(folder, &["mine", "1"]), ["mine 1"]);
    let described = json(folder, &["describe", "public/X-Hill_LVL7.TXT"], 0);
    assert_eq!(described["game"], "public/x-hill.TXT");
    assert_eq!(described["level"]["level"], "public/X-Hill_LVL7.TXT");
    let validated = json(folder, &["validate", "mine/lvl0.txt", "--budget", "300"], 1);
    let levels: Vec<&Value> =
        validated["levels"].as_array().unwrap().iter().map(|level| &level["level"]).collect();
    assert_eq!(levels, ["mine/lvl0.txt"]);
    let url = ["--base-url", "http://127.0.0.1:9", "--model", "none"];
    for (subject, levels) in [("public", 3), ("public/pond_lvl2.txt", 1), ("mine", 2)] {
        let args: Vec<&str> =
            ["evaluate", subject, "--out", "results", "--dry-run"].into_iter().chain(url).collect();
        let planned = json(folder, &args, 0);
        assert_eq!(planned["episodes"], levels, "{planned}");
    }
    let drawn = json(folder, &["render", "public/pond_lvl2.txt", "-o", "-"], 0);
    assert_eq!(drawn["level"], "public/pond_lvl2.txt");
    assert_eq!(
        json(folder, &["render", "public/pond.txt", "2", "-o", "-"], 0)["level"],
        "public/pond_lvl2.txt"
    );
}

#[test]
fn a_level_without_a_game_is_told_with_the_command_that_works() {
    let home = home();
    let folder = home.path();
    let error = text(&run(folder, &["validate", "mine/levels/far.txt"], 2).stderr);
    let command = "arcade validate mine/game.vgdl mine/levels/far.txt";
    assert!(error.contains(command), "{error}");
    let args: Vec<&str> = command.split(' ').skip(1).chain(["--budget", "300"]).collect();
    run(folder, &args, 1);
    let error = text(&run(folder, &["run", "other/lvl3.txt"], 2).stderr);
    assert!(error.contains("arcade validate GAME other/lvl3.txt"), "{error}");
}

#[test]
fn python_files_are_converted_by_the_command_that_the_message_names() {
    let home = home();
    let folder = home.path();
    let level = "level = \"\"\"\nwwww\nwAgw\nwwww\n\"\"\"\n";
    let game = GAME.replace("BasicGame", "BasicGame block_size=10");
    fs::write(folder.join("my pond.py"), format!("{level}game = '''\n{game}'''\n")).unwrap();
    let error = text(&run(folder, &["validate", "my pond.py"], 2).stderr);
    let command = error.split("convert it first: ").nth(1).unwrap().trim();
    let args = shlex::split(command).unwrap();
    assert_eq!(args[0], "arcade");
    run(folder, &args[1..].iter().map(String::as_str).collect::<Vec<_>>(), 0);
    assert_eq!(played(folder, &["my pond"]), ["my pond 0"]);
    let source = fs::read_to_string(folder.join("my pond/game.vgdl")).unwrap();
    assert!(source.starts_with("BasicGame square_size=10\n"), "{source}");
}

#[test]
fn games_of_a_dialect_are_told_and_converted() {
    let home = home();
    let folder = home.path();
    let game = GAME.replace("BasicGame", "BasicGame block_size=10").replace("stepBack", "conveySprite");
    fs::write(folder.join("belt.txt"), game).unwrap();
    let error = text(&run(folder, &["describe", "belt.txt"], 2).stderr);
    assert!(error.contains("py-vgdl") && error.contains("`arcade fmt --from py-vgdl belt.txt`"), "{error}");
    let output = run(folder, &["fmt", "--from", "py-vgdl", "belt.txt"], 1);
    assert!(text(&output.stdout).starts_with("BasicGame square_size=10\n"));
    let told = text(&output.stderr);
    assert!(told.contains("belt.txt:1: `block_size=10` becomes: square_size=10"), "{told}");
    assert!(told.contains("belt.txt:9: not converted: no effect named `conveySprite`"), "{told}");
    let document = json(folder, &["fmt", "--from", "empa", "belt.txt"], 1);
    assert_eq!(
        (document["changes"][0]["line"].as_u64(), document["left"][0]["line"].as_u64()),
        (Some(1), Some(9))
    );
}
