//! Tests of verdicts on levels that can be won, that cannot be won, or that try to break the judge.

use crate::client::{GAME, LEVEL, Running, WALLED, usual};
use engine::{Episode, Game, Outcome};
use serde_json::{Value, json};
use std::path::Path;

fn verdict(running: &Running, source: &str, level: &str, budget: u64) -> Vec<Value> {
    running.lines("/api/verdict", &json!({ "source": source, "level": level, "budget": budget, "seed": "s" }))
}

fn stages(lines: &[Value]) -> Vec<&str> {
    lines.iter().map(|line| line["stage"].as_str().expect("a stage")).collect()
}

fn find<'a>(lines: &'a [Value], stage: &str) -> &'a Value {
    lines
        .iter()
        .find(|line| line["stage"] == stage)
        .unwrap_or_else(|| panic!("no {stage}: {:?}", stages(lines)))
}

#[test]
fn a_level_that_can_be_won_is_shown_to_be() {
    let running = usual();
    let lines = verdict(&running, GAME, LEVEL, 100_000);
    assert_eq!(stages(&lines)[..3], ["problems", "reach", "win"]);
    assert_eq!(find(&lines, "reach")["unreachable"], json!([]));
    let win = find(&lines, "win");
    let episode: Episode = serde_json::from_value(win["episode"].clone()).unwrap();
    let game = Game::from_source(GAME).unwrap();
    assert_eq!(episode.replay(&game, &game.level(LEVEL).unwrap()).unwrap().outcome(), Outcome::Won);
    assert_eq!((win["ticks"].as_u64(), &win["shortest"]), (Some(4), &json!(true)));
    let criterion = |name: &str| {
        let found = lines.iter().find(|line| line["stage"] == "criterion" && line["name"] == name);
        found.unwrap_or_else(|| panic!("no {name}"))["verdict"].clone()
    };
    assert_eq!(criterion("well-formed"), "pass");
    // Four ticks are fewer than the criterion requires.
    assert_eq!(criterion("length"), "fail");
    assert!(!find(&lines, "ladder")["rows"].as_array().expect("rows").is_empty());
    assert_eq!(stages(&lines).last(), Some(&"done"));
}

#[test]
fn a_level_that_cannot_be_won_is_explained_at_its_place() {
    let running = usual();
    let lines = verdict(&running, GAME, WALLED, 100_000);
    assert_eq!(stages(&lines)[..3], ["problems", "reach", "impossible"]);
    let reach = find(&lines, "reach");
    let key = reach["unreachable"].as_array().expect("types").iter().find(|found| found["type"] == "key");
    assert_eq!(key.expect("the key")["cells"], json!([[4, 1]]));
    let why = reach["why"].as_array().expect("causes");
    let cells: Vec<&Value> = why.iter().map(|link| &link["cell"]).filter(|cell| !cell.is_null()).collect();
    assert!(cells.contains(&&json!([5, 1])) || cells.contains(&&json!([4, 1])), "{why:?}");
    let rule = why.iter().find_map(|link| link["rule"].as_object()).expect("a rule");
    let at = |key: &str| usize::try_from(rule[key].as_u64().expect("a place")).expect("small");
    let line = GAME.lines().nth(at("line") - 1).expect("a line");
    assert!(line.contains(&GAME[at("start")..at("end")]), "{line}");
}

#[test]
fn proofs_by_search_are_explained_too() {
    let running = usual();
    // There are two boxes in a corridor. The computed reach ignores that one box blocks the other.
    let source = "BasicGame\n  SpriteSet\n    hole > Immovable\n    box > Passive\n    avatar > MovingAvatar\n  LevelMapping\n    o > hole\n    b > box\n  InteractionSet\n    avatar wall > stepBack\n    box avatar > bounceForward\n    box wall > undoAll\n    box box > undoAll\n    box hole > killSprite\n  TerminationSet\n    SpriteCounter stype=box win=True\n    Timeout limit=50 win=False\n";
    let lines = verdict(&running, source, "wwwwwww\nwAb bow\nw    ww\nwb   ww\nwwwwwww\n", 200_000);
    let impossible = find(&lines, "impossible");
    assert!(impossible["states"].as_u64().expect("a number") > 0, "{impossible}");
    let winnable = lines.iter().find(|line| line["name"] == "winnable").expect("the explanation");
    assert_eq!(winnable["verdict"], "fail");
}

#[test]
fn faults_end_the_verdict_with_their_places() {
    let running = usual();
    let lines = verdict(&running, &GAME.replace("key avatar", "kay avatar"), LEVEL, 1000);
    assert_eq!(stages(&lines), ["problems", "done"]);
    assert_eq!(lines[0]["problems"][0]["in"], "source");
    let lines = verdict(&running, GAME, "wXw\n", 1000);
    assert_eq!(lines[0]["problems"][0]["in"], "level");
}

#[test]
fn the_gates_are_asked_of_all_levels() {
    let running = usual();
    let lines = running.lines("/api/necessity", &json!({ "source": GAME, "levels": [LEVEL, LEVEL] }));
    let names: Vec<&str> = lines.iter().filter_map(|line| line["name"].as_str()).collect();
    assert!(names.contains(&"rule-use") && names.contains(&"necessity"), "{names:?}");
    let none = running.lines("/api/necessity", &json!({ "source": GAME, "levels": [] }));
    assert_eq!(none[0]["stage"], "error");
}

/// Every game in the hostile set can be checked, drawn, begun and judged. Each request gets a response or a
/// refusal, and the server keeps running. Like a page, the client leaves once it knows whether the level can
/// be won. Outside of `cargo xtask sweep`, only a third of the games are tested.
#[test]
fn hostile_games_are_answered() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/suite/hostile");
    let Ok(listed) = std::fs::read_dir(&folder) else { return };
    let mut games: Vec<_> = listed.map(|entry| entry.expect("readable").path()).collect();
    games.retain(|path| path.extension().is_some_and(|extension| extension == "vgdl"));
    games.sort();
    let step = if std::env::var_os("ARCADE_SWEEP").is_some() { 1 } else { 3 };
    let running = usual();
    let mut judged = 0;
    for path in games.iter().step_by(step) {
        let read =
            |path: &Path| std::fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let source = read(path).expect("readable");
        let level = read(&path.with_extension("txt")).unwrap_or_default();
        let name = path.display();
        running.ask("/api/check", &json!({ "source": source, "levels": [level] }));
        let board = running.post("/api/board", &json!({ "source": source, "level": level }));
        assert!([200, 422].contains(&board.status), "{name}: {}", board.status);
        let begun = running.post("/api/play/begin", &json!({ "source": source, "level": level }));
        assert!([200, 422].contains(&begun.status), "{name}: {}", begun.status);
        if begun.status == 200 {
            let session = begun.json()["session"].clone();
            for _ in 0..3 {
                running.ask("/api/play/act", &json!({ "session": session, "action": "ACTION_USE" }));
            }
            running.ask("/api/play/seek", &json!({ "session": session, "tick": 1 }));
        }
        let body = json!({ "source": source, "level": level, "budget": 500 });
        let lines = running.lines_until("/api/verdict", &body, &["win", "impossible", "unknown", "done"]);
        assert_ne!(lines.last().expect("a line")["stage"], "error", "{name}");
        judged += 1;
    }
    assert!(judged > 20, "{judged} games");
    assert_eq!(running.get("/api/workspace").status, 200);
}
