//! Tests of opening, checking, playing and saving games.

use crate::client::{GAME, LEVEL, in_folder, in_memory, run, studio, usual};
use base::Digest;
use engine::{Episode, Game, Outcome};
use serde_json::{Value, json};

#[test]
fn the_workspace_lists_games_with_boards() {
    let running = usual();
    let workspace = running.get("/api/workspace").json();
    assert_eq!(workspace["kind"], "games");
    let game = &workspace["games"][0];
    assert_eq!((game["id"].as_str(), game["levels"].as_u64()), (Some("one"), Some(2)));
    assert_eq!((&game["tile"]["width"], &game["tile"]["height"]), (&json!(7), &json!(3)));
    for tile in game["tiles"].as_array().expect("tiles") {
        assert!(tile["svg"].as_str().expect("a picture").starts_with("<svg"));
    }
    let opened = running.get("/api/games/one").json();
    assert_eq!(opened["source"]["text"], GAME);
    assert_eq!(opened["levels"][0]["digest"], json!(Digest::of(LEVEL.as_bytes())));
    assert!(opened["describe"].as_str().expect("words").contains("key"));
    let versions = running.get("/api/games/one/versions").json();
    assert_eq!(versions["files"]["game.vgdl"], opened["source"]["digest"]);
}

#[test]
fn problems_come_with_places_and_repairs() {
    let running = usual();
    let source = GAME.replace("door avatar >", "# 😀\n    dor avatar >");
    let answer = running.ask("/api/check", &json!({ "source": source, "levels": [LEVEL, "wXw\n"] }));
    let problem = &answer["problems"][0];
    assert_eq!(
        (problem["code"].as_str(), problem["severity"].as_str()),
        (Some("unknown-sprite"), Some("error"))
    );
    // Positions are counted in UTF-16 code units. The character before the problem has two of them, but four
    // bytes.
    let units: Vec<u16> = source.encode_utf16().collect();
    let at = |key: &str| usize::try_from(problem[key].as_u64().expect("a place")).expect("small");
    assert_eq!(String::from_utf16(&units[at("start")..at("end")]).unwrap(), "dor");
    let edit = &problem["fixes"][0]["edits"][0];
    assert_eq!((&edit["text"], &edit["start"]), (&json!("door"), &problem["start"]));
    assert_eq!(answer["levels"][1]["problems"][0]["severity"], "error");
    let sound = running.ask("/api/check", &json!({ "source": GAME, "levels": [LEVEL] }));
    let legend = sound["legend"].as_array().expect("a legend");
    let key = legend.iter().find(|entry| entry["symbol"] == "k").expect("the key");
    assert_eq!(key["types"], json!(["key", "floor"]));
    assert!(key["tile"].as_u64().expect("a tile") < sound["tiles"].as_array().expect("tiles").len() as u64);
    assert!(legend.iter().any(|entry| entry["symbol"] == "w"), "mapped by default");
    let floors = |legend: &Value| -> Vec<Value> {
        let entries = legend.as_array().expect("a legend").iter();
        entries.filter(|entry| entry["floor"] == true).map(|entry| entry["symbol"].clone()).collect()
    };
    assert_eq!(floors(&sound["legend"]), ["."]);
    // A character mapped by default to a type that the game does not mention is not a brush, and a hidden trap is not a
    // floor.
    let snail = GAME.replace("avatar", "snail").replace(". > floor", ". > trap").replace("floor >", "trap >");
    let snail =
        snail.replace("floor", "trap").replace("snail wall", "snail trap > killSprite\n    snail wall");
    let answer = running.ask("/api/check", &json!({ "source": snail, "levels": [] }));
    let symbols: Vec<&str> = answer["legend"]
        .as_array()
        .expect("a legend")
        .iter()
        .filter_map(|entry| entry["symbol"].as_str())
        .collect();
    assert_eq!(symbols, [".", "k", "d", "A", "w"], "{answer}");
    assert!(floors(&answer["legend"]).is_empty(), "{answer}");
    let unmapped = snail.replace("A > snail", "s > snail");
    let answer = running.ask("/api/check", &json!({ "source": unmapped, "levels": [] }));
    assert!(
        answer["legend"].as_array().expect("a legend").iter().all(|entry| entry["symbol"] != "A"),
        "{answer}"
    );
}

#[test]
fn editors_get_words_about_words() {
    let running = usual();
    let at = GAME.find("key >").expect("a key") + 1;
    let hover = running.ask("/api/hover", &json!({ "source": GAME, "at": at }));
    assert!(hover["markdown"].as_str().expect("words").contains("key"));
    let renamed = running.ask("/api/rename", &json!({ "source": GAME, "at": at, "name": "coin" }));
    assert_eq!(renamed["edits"].as_array().expect("edits").len(), GAME.matches("key").count());
    let symbol = GAME.find("k > key").expect("a mapping");
    let body = json!({ "source": GAME, "at": symbol, "name": "c", "levels": [LEVEL] });
    assert_eq!(running.ask("/api/rename", &body)["levels"][0].as_array().expect("edits").len(), 1);
    let formatted = running.ask("/api/format", &json!({ "source": GAME }));
    assert_eq!(running.ask("/api/format", &json!({ "source": formatted["text"] })), formatted);
    assert_eq!(running.ask("/api/page", &json!({ "name": "known" }))["markdown"], "# Known");
    assert_eq!(running.post("/api/page", &json!({ "name": "../known" })).status, 404);
    // Any position in any text is a valid request.
    for at in [0, 3, 100_000, usize::MAX] {
        for path in ["/api/hover", "/api/complete", "/api/definition"] {
            running.ask(path, &json!({ "source": "\u{feff}é😀", "at": at }));
        }
    }
}

fn act(running: &crate::client::Running, session: &Value, action: &str) -> Value {
    running.ask("/api/play/act", &json!({ "session": session, "action": action }))
}

#[test]
fn games_are_played_undone_and_recorded() {
    let running = usual();
    let begun = running.ask("/api/play/begin", &json!({ "source": GAME, "level": LEVEL, "seed": "s" }));
    let session = &begun["session"];
    let mut frames = vec![begun["frame"].clone()];
    for _ in 0..3 {
        frames.push(act(&running, session, "ACTION_RIGHT")["frame"].clone());
    }
    assert_eq!(frames[3]["tick"], 3);
    assert_ne!(frames[0]["marks"], frames[1]["marks"]);
    // Every tick can be shown again, with the same board.
    for tick in [1_usize, 3, 0, 2] {
        let seen = running.ask("/api/play/seek", &json!({ "session": session, "tick": tick }));
        assert_eq!(seen["frame"], frames[tick], "{tick}");
    }
    // The next action drops the ticks after the shown tick.
    act(&running, session, "left");
    let episode: Episode =
        serde_json::from_value(running.ask("/api/play/episode", &json!({ "session": session }))).unwrap();
    let game = Game::from_source(GAME).unwrap();
    episode.replay(&game, &game.level(LEVEL).unwrap()).unwrap();
    assert_eq!(episode.actions.len(), 3);
    let replayed = running.ask("/api/replay", &json!({ "source": GAME, "level": LEVEL, "episode": episode }));
    assert_eq!((&replayed["agrees"], replayed["frames"].as_array().map(Vec::len)), (&json!(true), Some(4)));
    let mut damaged = episode.clone();
    damaged.actions[0] = engine::Action::Nil;
    let replayed = running.ask("/api/replay", &json!({ "source": GAME, "level": LEVEL, "episode": damaged }));
    assert_eq!(replayed["agrees"], false);
    // A planner wins the game, and no tick follows the end.
    let mut last = json!(null);
    for _ in 0..40 {
        last = running.ask("/api/play/act", &json!({ "session": session, "planner": "width:500" }));
    }
    assert_eq!(last["frame"]["outcome"], "won");
    let episode: Episode =
        serde_json::from_value(running.ask("/api/play/episode", &json!({ "session": session }))).unwrap();
    assert_eq!(episode.outcome, Outcome::Won);
    assert!(episode.actions.len() < 40);
    for wrong in
        [json!({ "planner": "mtcs" }), json!({ "planner": "mcts:100000000" }), json!({ "action": "jump" })]
    {
        let mut body = wrong;
        body["session"] = session.clone();
        assert_eq!(running.post("/api/play/act", &body).status, 400);
    }
}

#[test]
fn old_sessions_give_way() {
    let running = usual();
    let begin =
        || running.ask("/api/play/begin", &json!({ "source": GAME, "level": LEVEL }))["session"].clone();
    let first = begin();
    act(&running, &first, "ACTION_RIGHT");
    let mut last = first.clone();
    for _ in 0..32 {
        last = begin();
    }
    assert_eq!(running.post("/api/play/act", &json!({ "session": first })).status, 404);
    act(&running, &last, "ACTION_RIGHT");
}

#[test]
fn long_games_can_be_undone_to_any_tick() {
    let running = usual();
    let source = GAME.replace("limit=100 win", "limit=1900 win");
    let begun = running.ask("/api/play/begin", &json!({ "source": source, "level": LEVEL }));
    let session = &begun["session"];
    let mut boards = vec![begun["frame"]["marks"].clone()];
    for tick in 0..700 {
        let action = if tick % 3 == 0 { "ACTION_RIGHT" } else { "ACTION_LEFT" };
        boards.push(act(&running, session, action)["frame"]["marks"].clone());
    }
    for tick in [700, 699, 640, 512, 513, 3, 250, 0, 1] {
        let seen = running.ask("/api/play/seek", &json!({ "session": session, "tick": tick }));
        assert_eq!(seen["frame"]["marks"], boards[tick], "{tick}");
    }
}

#[test]
fn saving_replaces_only_what_was_seen() {
    let home = tempfile::tempdir().expect("temporary folder");
    let running = run(studio(home.path(), vec![in_folder("one", home.path())]));
    let file = home.path().join("lvl0.txt");
    let path = "/api/games/one/files/lvl0.txt";
    let digest = |text: &str| json!(Digest::of(text.as_bytes()));
    let saved = running.put(path, &json!({ "text": "wAw\n", "base": digest(LEVEL) }));
    assert_eq!((saved.status, &saved.json()["digest"]), (200, &digest("wAw\n")));
    assert_eq!(std::fs::read_to_string(&file).expect("read"), "wAw\n");
    // If another program writes the file, neither text is lost.
    std::fs::write(&file, "wwA\n").expect("written");
    let answer = running.put(path, &json!({ "text": "Aww\n", "base": digest("wAw\n") }));
    assert_eq!(answer.status, 409);
    assert_eq!((&answer.json()["text"], &answer.json()["digest"]), (&json!("wwA\n"), &digest("wwA\n")));
    assert_eq!(std::fs::read_to_string(&file).expect("read"), "wwA\n");
    // The page expects a new file, but the file already exists. Later, it has been removed.
    assert_eq!(running.put(path, &json!({ "text": "Aww\n", "base": null })).status, 409);
    std::fs::remove_file(&file).expect("removed");
    let answer = running.put(path, &json!({ "text": "Aww\n", "base": digest("wwA\n") }));
    assert_eq!((answer.status, &answer.json()["text"]), (409, &json!(null)));
    assert_eq!(running.put(path, &json!({ "text": "Aww\n", "base": null })).status, 200);
    // This level is new.
    assert_eq!(
        running.put("/api/games/one/files/lvl7.txt", &json!({ "text": "A\n", "base": null })).status,
        200
    );
    let names: Vec<_> =
        std::fs::read_dir(home.path()).expect("read").map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 3, "{names:?}");
    let long = "w".repeat(engine::MAX_LEVEL_TEXT + 1);
    assert_eq!(running.put(path, &json!({ "text": long, "base": digest("Aww\n") })).status, 413);
}

#[test]
fn only_the_last_level_is_removed() {
    let home = tempfile::tempdir().expect("temporary folder");
    let running =
        run(studio(home.path(), vec![in_folder("one", home.path()), in_memory("two", GAME, &[LEVEL])]));
    let at = |name: &str| home.path().join(name);
    let path = |name: &str| format!("/api/games/one/files/{name}");
    let base = |text: &str| json!({ "base": Digest::of(text.as_bytes()) });
    for number in 1..4 {
        std::fs::write(at(&format!("lvl{number}.txt")), format!("A{number}\n")).expect("written");
    }
    for (name, body, status) in [
        ("lvl0.txt", base(LEVEL), 403),
        ("lvl2.txt", base("A2\n"), 403),
        ("lvl4.txt", base("A4\n"), 409),
        ("game.vgdl", base(GAME), 403),
        ("CARD.toml", base(""), 404),
        ("..%2Flvl3.txt", base("A3\n"), 404),
        ("lvl3.txt", base("A2\n"), 409),
        ("lvl3.txt", json!({ "base": null }), 400),
        ("lvl3.txt", json!({}), 400),
    ] {
        let answer = running.delete(&path(name), &body);
        assert_eq!(answer.status, status, "{name} {body}");
    }
    assert_eq!(running.delete("/api/games/two/files/lvl0.txt", &base(LEVEL)).status, 403);
    // Another program has changed the file since the page read it, so the file is kept and shown.
    std::fs::write(at("lvl3.txt"), "wA\n").expect("written");
    let answer = running.delete(&path("lvl3.txt"), &base("A3\n"));
    assert_eq!((answer.status, &answer.json()["text"]), (409, &json!("wA\n")));
    assert_eq!(running.delete(&path("lvl3.txt"), &base("wA\n")).status, 200);
    assert_eq!(running.delete(&path("lvl3.txt"), &base("wA\n")).status, 409);
    assert_eq!(running.delete(&path("lvl2.txt"), &base("A2\n")).status, 200);
    let names = running.get("/api/games/one/versions").json()["files"].as_object().expect("files").len();
    assert_eq!(names, 3);
}

#[test]
fn games_that_cannot_be_changed_are_copied() {
    let home = tempfile::tempdir().expect("temporary folder");
    let running = run(studio(home.path(), vec![in_memory("one", GAME, &[LEVEL])]));
    let path = "/api/games/one/files/lvl0.txt";
    let base = json!(Digest::of(LEVEL.as_bytes()));
    assert_eq!(running.put(path, &json!({ "text": "A\n", "base": base })).status, 403);
    let mut ids = Vec::new();
    for title in ["../../My <Game>", "my game"] {
        ids.push(running.ask("/api/copy", &json!({ "id": "one", "title": title }))["id"].clone());
    }
    assert_eq!(ids, [json!("my-game"), json!("my-game-2")]);
    assert_eq!(std::fs::read_to_string(home.path().join("my-game/lvl0.txt")).expect("read"), LEVEL);
    let saved = running.put("/api/games/my-game/files/lvl0.txt", &json!({ "text": "A\n", "base": base }));
    assert_eq!(saved.status, 200);
    assert_eq!(running.post("/api/copy", &json!({ "id": "one", "title": "…" })).status, 400);
}

#[test]
fn new_levels_are_made() {
    let running = usual();
    let body = json!({
        "source": GAME, "level": LEVEL, "method": "constructive", "width": 12, "height": 8, "seed": "s", "count": 3,
    });
    let lines = running.lines("/api/more", &body);
    let levels: Vec<&Value> = lines.iter().filter(|line| line["stage"] == "level").collect();
    assert!(!levels.is_empty(), "{lines:?}");
    let game = Game::from_source(GAME).unwrap();
    for level in levels {
        let made = game.level(level["level"].as_str().expect("a text")).unwrap();
        assert_eq!((made.columns(), made.rows()), (12, 8));
    }
    for (key, value) in [("method", json!("magic")), ("tier", json!(9))] {
        let mut wrong = body.clone();
        wrong[key] = value;
        assert_eq!(running.lines("/api/more", &wrong).last().unwrap()["stage"], "error", "{key}");
    }
}

#[test]
fn new_levels_have_the_tier_that_is_asked_for() {
    let running = usual();
    let asked = |tier| {
        let body = json!({
            "source": GAME, "level": LEVEL, "method": "constructive", "seed": "s", "count": 2, "tier": tier,
        });
        running.lines("/api/more", &body)
    };
    let stages = |lines: &[Value], stage: &str| lines.iter().filter(|line| line["stage"] == stage).count();
    let low = asked(1);
    assert_eq!(stages(&low, "level"), 2, "{low:?}");
    assert!(low.iter().filter(|line| line["stage"] == "level").all(|line| line["tier"] == 1));
    let high = asked(4);
    assert_eq!(
        (stages(&high, "level"), stages(&high, "none")),
        (0, 8),
        "a walk to a goal asks little: {high:?}"
    );
}
