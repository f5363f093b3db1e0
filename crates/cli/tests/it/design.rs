//! `arcade design` as users run it: with a model behind a server, through a mailbox, interrupted, resumed and replayed.

use crate::arcade::{arcade, run, text};
use crate::server::{Response, Server};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};
use std::time::Duration;

const IDEA: &str = "NAME: plum-walk\nIDEA: The player gathers plums while the wasps close in, and each plum that is carried slows the way home.";
const BROKEN: &str = "```vgdl\nBasicGame\n    SpriteSet\n        plum > Immovabel\n```";

/// The answers of a draft that is given up.
fn answer(number: usize) -> Response {
    Response::completion(if number.is_multiple_of(5) { IDEA } else { BROKEN })
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

fn design<'a>(url: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let args =
        ["--json", "design", "--model", "scripted", "--base-url", url, "--drafts", "1", "--out", "designs"];
    args.into_iter().chain(more.iter().copied()).collect()
}

#[test]
fn a_cap_stops_a_run_and_more_money_continues_it() {
    let server = Server::start(|number, _| answer(number));
    let (url, home) = (server.base_url(), tempfile::tempdir().unwrap());
    let stopped = json(&run(home.path(), &design(&url, &["--max-requests", "2"]), 1));
    assert_eq!((&stopped["finished"], &stopped["accepted"]), (&0.into(), &0.into()));
    assert!(stopped["halted"].as_str().unwrap().contains("--max-requests 2"), "{stopped}");
    let again = run(home.path(), &design(&url, &["--max-requests", "9"]), 2);
    assert!(text(&again.stderr).contains("pass --resume to continue a run of the same command"));
    let done = json(&run(home.path(), &design(&url, &["--max-requests", "9", "--resume"]), 0));
    assert_eq!((&done["finished"], &done["spent"]["requests"]), (&1.into(), &5.into()));
    assert_eq!(server.received().len(), 5, "no answer is paid for twice");
    let asked = server.received().last().unwrap().json()["messages"].clone();
    let told = asked.as_array().unwrap().last().unwrap()["content"].to_string();
    assert!(told.contains("did you mean `Immovable`?") && told.contains("game.vgdl:3:16"), "{told}");
    let replayed = json(&run(home.path(), &["--json", "design", "--replay", "designs"], 0));
    assert_eq!((&replayed["replayed"], &replayed["differing"]), (&1.into(), &Value::Array(Vec::new())));
    let other = run(home.path(), &design(&url, &["--resume", "--theme", "snow"]), 2);
    assert!(text(&other.stderr).contains("different value of `brief`"), "{}", text(&other.stderr));
}

#[test]
fn files_answer_the_questions_of_a_mailbox() {
    let home = tempfile::tempdir().unwrap();
    let mut command = arcade(home.path());
    command.args(["design", "--designer", "mailbox:desk", "--drafts", "1", "--out", "designs"]);
    let mut designing = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let folder = home.path().join("desk/draft-0000");
    for (address, words) in [("0000-0", IDEA), ("0001-0", BROKEN), ("0001-1", BROKEN), ("0001-2", BROKEN)] {
        deliver(&folder, address, words);
    }
    wait(&folder.join("0001-3.prompt.txt"));
    let listed = json(&run(home.path(), &["--json", "mailbox", "desk", "--list"], 0));
    assert_eq!(listed["waiting"].as_array().unwrap().len(), 1, "{listed}");
    let prompt = fs::read_to_string(folder.join("0001-3.prompt.txt")).unwrap();
    assert!(prompt.contains("This is the last correction."), "{prompt}");
    deliver(&folder, "0001-3", BROKEN);
    assert_eq!(designing.wait().unwrap().code(), Some(0));
    let ended = fs::read_to_string(folder.join("finished.txt")).unwrap();
    assert!(ended.contains("given up in the stage `rules`"), "{ended}");
    assert!(home.path().join("desk/finished.json").exists());
}

#[test]
fn designers_are_compared() {
    let home = tempfile::tempdir().unwrap();
    for designer in ["grammar", "kernels"] {
        let args = ["design", "--designer", designer, "--drafts", "2", "--budget", "5000", "--out", designer];
        let written = run(home.path(), &args, 0);
        assert!(text(&written.stdout).contains("of 2 drafts accepted"), "{}", text(&written.stdout));
    }
    let told = run(home.path(), &["design", "--report", "grammar", "kernels"], 0);
    let told = text(&told.stdout);
    assert!(told.contains("| measure | grammar | kernels |"), "{told}");
    assert!(told.contains("| compiles, % |") && told.contains("| necessity, % |"), "{told}");
    let scores = json(&run(home.path(), &["--json", "design", "--report", "kernels"], 0));
    assert_eq!(
        (&scores["scores"][0]["designer"], &scores["scores"][0]["drafts"]),
        (&"kernels".into(), &2.into())
    );
}

fn wait(path: &Path) {
    while !path.exists() {
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn deliver(folder: &Path, address: &str, words: &str) {
    wait(&folder.join(format!("{address}.prompt.txt")));
    let draft = folder.join(".draft");
    fs::write(&draft, words).unwrap();
    fs::rename(draft, folder.join(format!("{address}.answer.txt"))).unwrap();
}

#[test]
fn wrong_requests_name_the_next_step() {
    let home = tempfile::tempdir().unwrap();
    for (args, words) in [
        (&["--out", "x"][..], "no designer specified"),
        (&["--out", "x", "--designer", "mcts"], "`mcts` isn't a designer"),
        (&["--out", "x", "--designer", "mailbox:b", "--require", "chaser"], "did you mean `Chaser`?"),
        (&["--out", "x", "--designer", "mailbox:b", "--unlike", "hailglas"], "did you mean the corpus game"),
        (&["--out", "x", "--designer", "mailbox:b", "--levels", "0"], "1 to 20 levels"),
        (&["--out", "x", "--designer", "mailbox:b", "--max-cost", "1"], "--model"),
        (&["--replay", "nothing"], "there are no drafts here"),
    ] {
        let refused = run(home.path(), &[&["design"], args].concat(), 2);
        assert!(text(&refused.stderr).contains(words), "{args:?}: {}", text(&refused.stderr));
    }
    assert!(!home.path().join("x").exists() && !home.path().join("b").exists());
}

/// The release contains the selected designs. Only minting needs the folder of designs.
#[test]
fn designs_become_a_release() {
    const RULES: &str = "BasicGame\n    SpriteSet\n        plum > Immovable\n        wasp > Immovable\n        avatar > MovingAvatar\n    \
        LevelMapping\n        p > plum\n        x > wasp\n    InteractionSet\n        avatar wall > stepBack\n        \
        plum avatar > killSprite scoreChange=1\n        avatar wasp > killSprite\n    TerminationSet\n        \
        SpriteCounter stype=avatar limit=0 win=False\n        SpriteCounter stype=plum limit=0 win=True\n        Timeout limit=60 win=False\n";
    let home = tempfile::tempdir().unwrap();
    let game = home.path().join("designs/games/plum-walk");
    fs::create_dir_all(&game).unwrap();
    let digest = "0".repeat(64);
    let origin =
        format!("{{\"designer\":\"alice\",\"settings\":\"{digest}\",\"draft\":3,\"answers\":\"{digest}\"}}");
    let level = "wwwwwwwwwwww\nwA   x    pw\nw  x    x  w\nw    x     w\nwp  x   x pw\nwwwwwwwwwwww\n";
    for (file, text) in [("game.vgdl", RULES), ("lvl0.txt", level), ("design.json", &origin)] {
        fs::write(game.join(file), text).unwrap();
    }
    let recipe = "name = \"ours\"\ndescription = \"designs\"\nseed = \"plums\"\n[criteria]\n\
                  ask = [\"not-idle\", \"not-random\", \"winnable\"]\nbudget = 50000\n[designs]\ngames = 1\nlevels = 1\n";
    let file = home.path().join("ours.toml");
    fs::write(&file, recipe).unwrap();
    let release = ["release", "ours.toml", "--designs", "designs"];
    let told = run(home.path(), &release, 2);
    let told = text(&told.stderr);
    let line =
        told.split('`').find(|part| part.starts_with("digest = ")).expect("the line to write").to_owned();
    fs::write(&file, format!("{recipe}{line}\n")).unwrap();
    let minted = run(home.path(), &release, 0);
    let said = text(&minted.stdout);
    assert!(said.contains("Plum Walk") && said.contains("regenerate releases/ours --designs DIR"), "{said}");
    run(home.path(), &["verify", "releases/ours"], 0);
    let again = run(home.path(), &["regenerate", "releases/ours", "--designs", "designs"], 0);
    assert!(text(&again.stdout).starts_with("identical"), "{}", text(&again.stdout));
    let without = run(home.path(), &["regenerate", "releases/ours"], 2);
    assert!(text(&without.stderr).contains("pass the folder with --designs"), "{}", text(&without.stderr));
}
