//! Judging: what the judge sees, what is recorded, what is resumed.

use crate::client::{GAME, LEVEL, WALLED, run, studio};
use engine::Game;
use infinite_arcade_studio::judging::{Candidate, Judgements, Judging, Source};
use serde_json::json;
use std::path::Path;

fn source(name: &str, levels: &[&str]) -> Source {
    let game = Game::from_source(&format!("# from {name}\n{GAME}")).unwrap();
    let levels = levels.iter().map(|level| game.level(level).unwrap()).collect();
    let candidate = Candidate { id: format!("{name}-game"), title: "A Title".to_owned(), game, levels };
    Source { name: name.to_owned(), games: vec![candidate] }
}

fn session(file: &Path, seed: &str) -> Judging {
    let sources = vec![source("secret-one", &[LEVEL]), source("secret-two", &[LEVEL, WALLED])];
    Judging::open(sources, seed, 3, file).unwrap().0
}

#[test]
fn pairs_are_judged_blindly_and_recorded() {
    let home = tempfile::tempdir().expect("temporary folder");
    let file = home.path().join("judged.jsonl");
    let running = run(studio(home.path(), Vec::new()).judging(session(&file, "s")));
    assert_eq!(running.get("/api/workspace").json()["judge"], true);
    for number in 0..3 {
        let answer = running.get("/api/judge");
        let shown = String::from_utf8_lossy(&answer.body).into_owned();
        assert!(!shown.contains("secret"), "{shown}");
        let pair = answer.json();
        assert_eq!((&pair["pair"], &pair["of"], &pair["done"]), (&json!(number), &json!(3), &json!(false)));
        // As many levels on both sides: their number would tell.
        for side in ["left", "right"] {
            assert_eq!(pair[side]["levels"].as_array().map(Vec::len), Some(1));
            let (source, level) = (&pair[side]["source"], &pair[side]["levels"][0]);
            running.ask("/api/play/begin", &json!({ "source": source, "level": level }));
        }
        let body = json!({
            "pair": number, "better": "left", "again": "both", "machine": null, "words": "</script>\n\u{2028}",
            "played": { "left": 5, "right": 6 },
        });
        assert_eq!(running.ask("/api/judge", &body), json!({}));
    }
    assert_eq!(running.get("/api/judge").json()["done"], true);
    let report = running.get("/api/judge/report").json();
    assert_eq!(report["judged"], 3);
    let wins: u64 = report["sources"].as_array().unwrap().iter().filter_map(|row| row["wins"].as_u64()).sum();
    assert_eq!(wins, 3);
    for body in [
        json!({ "pair": 3, "better": "left", "again": "both" }),
        json!({ "pair": 0, "better": "both", "again": "both" }),
        json!({ "pair": 0, "better": "left" }),
        json!({}),
    ] {
        assert_eq!(running.post("/api/judge", &body).status, 400, "{body}");
    }
    let text = std::fs::read_to_string(&file).expect("read");
    assert_eq!(text.lines().count(), 3);
    let (judgements, remarks) = Judgements::read(&file).unwrap();
    assert!(remarks.is_empty());
    assert!(judgements.0.iter().all(|judgement| judgement.left.measures.contains_key("pace")));
}

#[test]
fn judging_goes_on_where_it_was_left() {
    let home = tempfile::tempdir().expect("temporary folder");
    let file = home.path().join("judged.jsonl");
    let body = json!({ "pair": 0, "better": "same", "again": "neither" });
    {
        let running = run(studio(home.path(), Vec::new()).judging(session(&file, "s")));
        running.ask("/api/judge", &body);
    }
    {
        let running = run(studio(home.path(), Vec::new()).judging(session(&file, "s")));
        assert_eq!(running.get("/api/judge").json()["pair"], 1);
    }
    // Another seed draws other pairs, which are judged from the start.
    let running = run(studio(home.path(), Vec::new()).judging(session(&file, "other")));
    assert_eq!(running.get("/api/judge").json()["pair"], 0);
}

#[test]
fn sources_have_to_be_two_with_games() {
    let home = tempfile::tempdir().expect("temporary folder");
    let file = home.path().join("judged.jsonl");
    let open = |sources| Judging::open(sources, "s", 3, &file).map(drop).unwrap_err().to_string();
    assert!(open(vec![source("one", &[LEVEL])]).contains("two sources"));
    let empty = Source { name: "empty".to_owned(), games: Vec::new() };
    assert!(open(vec![source("one", &[LEVEL]), empty]).contains("empty"));
    assert!(!file.exists());
}

#[test]
fn without_games_to_judge_there_is_no_pair() {
    let running = run(studio(Path::new("."), Vec::new()));
    assert_eq!(running.get("/api/judge").status, 404);
    assert_eq!(running.get("/api/judge/report").status, 404);
}
