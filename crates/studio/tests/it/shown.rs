//! Tests of malicious names: the studio returns the texts of games, cards and levels as plain data, never as markup or
//! script.

use crate::client::{Running, entry, in_memory, run, studio, text};
use infinite_arcade_studio::Place;
use serde_json::{Value, json};
use std::path::Path;

/// Texts that would have an effect if they were not treated as text.
const MISBEHAVING: [&str; 6] = [
    "<script>alert(1)</script>",
    "\"><img src=x onerror=alert(1)>",
    "</title></svg><script>1</script>",
    "javascript:alert(1)",
    "\u{2028}\u{2029}\u{202e}\u{0}",
    "'; DROP TABLE games; --{{7*7}}${1}",
];

fn misbehaving() -> Running {
    let mut games = Vec::new();
    for name in MISBEHAVING {
        // Sprite names contain part of the text, while comments and levels contain all of it.
        let word: String =
            name.chars().filter(|c| !c.is_whitespace() && !"#>:".contains(*c) && !c.is_control()).collect();
        let source = format!(
            "BasicGame\n  # {name}\n  SpriteSet\n    {word} > Door img={word}\n    avatar > MovingAvatar\n  LevelMapping\n    < > {word}\n    & > wall\n  InteractionSet\n    {word} avatar > killSprite\n  TerminationSet\n    SpriteCounter stype={word} win=True\n"
        );
        let mut game = in_memory(name, &source, &["&&&&\n&A<&\n&&&&\n", name]);
        game.title = name.to_owned();
        game.summary = name.to_owned();
        game.card =
            Some(json!({ "title": name, "description": name, "levels": [{ "tier": name }], "kind": name }));
        games.push(game);
    }
    run(studio(Path::new("."), games))
}

/// Checks that a response is JSON and nothing else, and that its images contain no text at all.
fn check(answer: &crate::client::Answer) -> Value {
    assert_eq!(answer.header("content-type"), Some("application/json"));
    assert_eq!(answer.header("x-content-type-options"), Some("nosniff"));
    let document = answer.json();
    pictures(&document);
    document
}

fn pictures(value: &Value) {
    match value {
        Value::Object(fields) => {
            if let Some(svg) = fields.get("svg").and_then(Value::as_str) {
                let tags = svg.split('<').skip(1);
                for tag in tags {
                    let name: String =
                        tag.chars().take_while(|c| *c == '/' || c.is_ascii_alphabetic()).collect();
                    assert!(["svg", "g", "path", "/g", "/svg"].contains(&name.as_str()), "{svg}");
                    let after = tag.split_once('>').map_or("", |(_, after)| after);
                    assert!(after.trim().is_empty(), "text in {svg}");
                }
            }
            fields.values().for_each(pictures);
        }
        Value::Array(values) => values.iter().for_each(pictures),
        _ => {}
    }
}

#[test]
fn misbehaving_names_stay_data() {
    let running = misbehaving();
    let workspace = check(&running.get("/api/workspace"));
    let titles: Vec<&str> =
        workspace["games"].as_array().unwrap().iter().filter_map(|game| game["title"].as_str()).collect();
    assert_eq!(titles, MISBEHAVING);
    for name in MISBEHAVING {
        let id: String = name.bytes().map(|byte| format!("%{byte:02X}")).collect();
        let game = check(&running.get(&format!("/api/games/{id}")));
        assert_eq!(game["card"]["description"], name);
        let (source, level) = (&game["source"]["text"], &game["levels"][0]["text"]);
        check(&running.post("/api/check", &json!({ "source": source, "levels": [level, name] })));
        check(&running.post("/api/board", &json!({ "source": source, "level": level })));
        check(&running.post("/api/play/begin", &json!({ "source": source, "level": level, "seed": name })));
        check(&running.post("/api/hover", &json!({ "source": source, "at": 60 })));
        check(&running.post("/api/page", &json!({ "name": name })));
        check(&running.post("/api/play/act", &json!({ "session": name })));
        running.lines("/api/verdict", &json!({ "source": source, "level": level, "budget": 1000 }));
    }
}

#[test]
fn unreadable_games_are_listed_without_harm() {
    let home = tempfile::tempdir().expect("temporary folder");
    std::fs::write(home.path().join("game.vgdl"), b"\xff\xfe\x00").expect("written");
    let folder =
        Place::Folder { folder: home.path().to_owned(), source: "game.vgdl".to_owned(), writable: true };
    let gone =
        Place::Folder { folder: home.path().join("gone"), source: "game.vgdl".to_owned(), writable: true };
    let empty = Place::Texts { source: text("game.vgdl", ""), levels: Vec::new() };
    let games = vec![entry("binary", folder), entry("gone", gone), entry("empty", empty)];
    let running = run(studio(home.path(), games));
    let workspace = check(&running.get("/api/workspace"));
    assert_eq!(workspace["games"].as_array().unwrap().len(), 3);
    for (id, status) in [("binary", 400), ("gone", 404), ("empty", 200)] {
        let answer = running.get(&format!("/api/games/{id}"));
        assert_eq!(answer.status, status, "{id}");
        let document = check(&answer);
        let shown = document["error"].as_str().unwrap_or_default();
        assert!(!shown.contains(&*home.path().to_string_lossy()), "a folder of the machine in `{shown}`");
    }
}
