//! Tests of judging: what the judge sees, what is recorded, and how sessions are resumed.

use crate::client::{GAME, LEVEL, Running, WALLED, run, studio};
use engine::Game;
use infinite_arcade_studio::judging::{Candidate, Judgements, Judging, Source, Watched};
use serde_json::{Value, json};
use std::path::Path;

fn source(name: &str, levels: &[&str]) -> Source {
    let game = Game::from_source(&format!("# from {name}\n{GAME}")).unwrap();
    let levels = levels.iter().map(|level| game.level(level).unwrap()).collect();
    let candidate = Candidate { id: format!("{name}-game"), title: "A Title".to_owned(), game, levels };
    Source { name: name.to_owned(), games: vec![candidate] }
}

fn of_two_levels(file: &Path, seed: &str) -> Judging {
    let sources = ["secret-one", "secret-two"].map(|name| source(name, &[LEVEL, WALLED]));
    Judging::open(sources.into(), seed, 3, file).unwrap().0
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
        // No results are shown while there are still pairs to judge.
        let blind = running.get("/api/judge/report").json();
        assert_eq!(blind, json!({ "blind": true, "judged": number, "of": 3 }));
        let answer = running.get("/api/judge");
        let shown = String::from_utf8_lossy(&answer.body).into_owned();
        assert!(!shown.contains("secret"), "{shown}");
        let pair = answer.json();
        assert_eq!((&pair["pair"], &pair["of"], &pair["done"]), (&json!(number), &json!(3), &json!(false)));
        // Both sides have the same number of levels, because the number could reveal the source.
        for side in ["left", "right"] {
            assert_eq!(pair[side]["levels"].as_array().map(Vec::len), Some(1));
            let (source, level) = (&pair[side]["source"], &pair[side]["levels"][0]);
            running.ask("/api/play/begin", &json!({ "source": source, "level": level }));
        }
        let body = json!({
            "pair": number, "better": "left", "again": "both", "machine": null, "words": "</script>\n\u{2028}",
            "played": { "left": 5, "right": 6 }, "watched": { "left": false, "right": true },
        });
        assert_eq!(running.ask("/api/judge", &body), json!({}));
    }
    assert_eq!(running.get("/api/judge").json()["done"], true);
    let report = running.get("/api/judge/report").json();
    assert_eq!((&report["judged"], &report["blind"]), (&json!(3), &json!(false)));
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
    let watched = Watched { left: false, right: true };
    assert!(judgements.0.iter().all(|judgement| judgement.watched == watched && !judgement.after_report));
}

#[test]
fn plays_to_watch_are_made_alike_on_both_sides() {
    let home = tempfile::tempdir().expect("temporary folder");
    let file = home.path().join("judged.jsonl");
    let wanted = |side: &str, level: usize| json!({ "pair": 1, "side": side, "level": level });
    let watch = |running: &Running, side: &str, level: usize| {
        let answer = running.post("/api/judge/watch", &wanted(side, level));
        assert_eq!(answer.status, 200, "{}", String::from_utf8_lossy(&answer.body));
        assert!(!String::from_utf8_lossy(&answer.body).contains("secret"));
        answer.json()
    };
    let first = {
        let running = run(studio(home.path(), Vec::new()).judging(of_two_levels(&file, "s")));
        let first = ["left", "right"].map(|side| [0, 1].map(|level| watch(&running, side, level)));
        // Here, both games have the same first level, and therefore the same episode.
        assert_eq!(first[0], first[1]);
        let [won, other] = &first[0];
        let last = |play: &Value| play["frames"].as_array().expect("frames").last().expect("one").clone();
        assert_eq!(
            (&last(won)["outcome"], &won["note"], &won["agrees"]),
            (&json!("won"), &json!(null), &json!(true))
        );
        assert_eq!(
            (&won["frames"][0]["tick"], won["actions"].as_array().map(Vec::len)),
            (&json!(0), Some(4))
        );
        // If no win is found, a planner plays until the game ends.
        assert_eq!(last(other)["outcome"], "lost");
        assert!(other["note"].is_string());
        assert_eq!(watch(&running, "left", 1), *other);
        first
    };
    // The next session plays the same episodes.
    let running = run(studio(home.path(), Vec::new()).judging(of_two_levels(&file, "s")));
    assert_eq!(["left", "right"].map(|side| [0, 1].map(|level| watch(&running, side, level))), first);
    for (wrong, message) in [
        (json!({ "pair": 3, "side": "left", "level": 0 }), "no such pair"),
        (json!({ "pair": 0, "side": "both", "level": 0 }), "is malformed"),
        (json!({ "pair": 0, "side": "left", "level": 2 }), "no such level"),
        (json!({ "pair": -1, "side": "left", "level": 0 }), "is malformed"),
        (json!({ "pair": 0 }), "is malformed"),
    ] {
        let answer = running.post("/api/judge/watch", &wrong);
        let error = answer.json()["error"].as_str().expect("a message").to_owned();
        assert!(answer.status == 400 && error.contains(message), "{wrong}: {} {error}", answer.status);
    }
    // Levels without a counterpart on the other side are neither shown nor played.
    let running = run(studio(home.path(), Vec::new()).judging(session(&file, "s")));
    for side in ["left", "right"] {
        assert_eq!(running.post("/api/judge/watch", &wanted(side, 1)).status, 400, "{side}");
    }
}

#[test]
fn the_report_before_the_end_ends_the_blinding() {
    let home = tempfile::tempdir().expect("temporary folder");
    let file = home.path().join("judged.jsonl");
    let judge = |running: &Running, pair: usize| {
        running.ask("/api/judge", &json!({ "pair": pair, "better": "left", "again": "left" }));
    };
    {
        let running = run(studio(home.path(), Vec::new()).judging(session(&file, "s")));
        judge(&running, 0);
        assert_eq!(running.get("/api/judge/report").json()["blind"], true);
        running.ask("/api/judge/end", &json!({}));
        let report = running.get("/api/judge/report").json();
        assert_eq!(
            (&report["blind"], &report["judged"], &report["of"]),
            (&json!(false), &json!(1), &json!(3))
        );
        assert_eq!(report["sources"].as_array().map(Vec::len), Some(2));
        judge(&running, 1);
    }
    let (judgements, _) = Judgements::read(&file).unwrap();
    assert_eq!(
        judgements.0.iter().map(|judgement| judgement.after_report).collect::<Vec<_>>(),
        [false, true]
    );
    // The next session learns from the record that the report was shown.
    let running = run(studio(home.path(), Vec::new()).judging(session(&file, "s")));
    assert_eq!(running.get("/api/judge/report").json()["blind"], false);
    let running = run(studio(home.path(), Vec::new()).judging(session(&file, "other")));
    assert_eq!(running.get("/api/judge/report").json(), json!({ "blind": true, "judged": 0, "of": 3 }));
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
    // A different seed draws different pairs, so judging starts from the beginning.
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
    let wanted = json!({ "pair": 0, "side": "left", "level": 0 });
    assert_eq!(running.post("/api/judge/watch", &wanted).status, 404);
    assert_eq!(running.post("/api/judge/end", &json!({})).status, 404);
}
