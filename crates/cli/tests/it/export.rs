//! Tests of exporting snapshots as datasets, using the recipe `tiny`.

use crate::arcade::{TINY, files, run, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Exports `tiny`, and returns the files.
fn export(out: &str, flags: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let folder = TINY.path();
    run(folder, &[&["export", "tiny", "--out", out], flags].concat(), 0);
    files(&folder.join(out))
}

fn rows(files: &BTreeMap<String, Vec<u8>>) -> Vec<Value> {
    let lines = text(&files["data/test.jsonl"]);
    lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn rows_match_the_release() {
    let release = TINY.path().join("tiny");
    let exported = export("rows", &["--format", "jsonl"]);
    assert_eq!(exported.keys().collect::<Vec<_>>(), ["README.md", "data/test.jsonl"]);
    let rows = rows(&exported);
    assert_eq!(rows.len(), 6);
    for row in &rows {
        let game = release.join("games").join(row["game_id"].as_str().unwrap());
        let read = |file: &str| fs::read_to_string(game.join(file)).unwrap();
        let card: Value = serde_json::from_str(&read("card.json")).unwrap();
        let number = row["level"].as_u64().unwrap();
        let level = &card["levels"][number as usize];
        assert_eq!(row["vgdl"], read("game.vgdl"));
        assert_eq!(row["level_text"], read(&format!("lvl{number}.txt")));
        for column in ["title", "goal", "rules", "kind", "canary"] {
            assert_eq!(row[column], card[column], "{column}");
        }
        assert_eq!((&row["game_digest"], &row["level_digest"]), (&card["digest"], &level["digest"]));
        assert_eq!(row["witness_ticks"], level["witness_ticks"]);
        // The legend has every character of the board except spaces.
        let legend = row["legend"].as_array().unwrap();
        let known = |symbol: char| legend.iter().any(|line| line["symbol"] == symbol.to_string());
        let board = row["level_text"].as_str().unwrap();
        assert!(board.chars().filter(|symbol| !symbol.is_whitespace()).all(known), "{board}");
    }
    let card = text(&exported["README.md"]);
    assert!(card.starts_with("---\n") && card.contains(rows[0]["canary"].as_str().unwrap()), "{card}");
    assert!(card.contains(rows[0]["release_root"].as_str().unwrap()), "{card}");
}

/// The page documents all columns in order, with their types.
#[test]
fn the_page_describes_every_column() {
    let page = include_str!("../../../../docs/reference/columns.md");
    let told: Vec<(&str, &str)> = page
        .lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| `")?.split(" | ");
            Some((cells.next()?.strip_suffix('`')?, cells.next()?))
        })
        .collect();
    let columns = snapshots::export::columns(true);
    let kinds: Vec<(&str, String)> = columns.iter().map(|column| (column.name, column.kind.name())).collect();
    let kinds: Vec<(&str, &str)> = kinds.iter().map(|(name, kind)| (*name, kind.as_str())).collect();
    assert_eq!(told, kinds);
    let rows = rows(&export("columns", &["--format", "jsonl", "--solutions"]));
    // Objects of serde_json are sorted by key.
    let mut names: Vec<&str> = told.iter().map(|(name, _)| *name).collect();
    names.sort_unstable();
    assert_eq!(rows[0].as_object().unwrap().keys().collect::<Vec<_>>(), names);
}

#[test]
fn solutions_are_exported_on_request_only() {
    let rows = rows(&export("solved", &["--format", "jsonl", "--solutions"]));
    for row in &rows {
        let actions = row["solution"].as_array().unwrap();
        assert_eq!(actions.len() as u64, row["witness_ticks"].as_u64().unwrap());
        assert!(row["solution_seed"].is_string());
    }
    // A plain export contains nothing from the witness files: no seeds, no hashes, and no actions under any
    // name.
    for (out, format) in [
        ("plain", "jsonl"),
        #[cfg(feature = "parquet")]
        ("plain-p", "parquet"),
    ] {
        let plain: String = export(out, &["--format", format]).values().map(|bytes| text(bytes)).collect();
        for row in &rows {
            assert!(!plain.contains(row["solution_seed"].as_str().unwrap()));
        }
        assert!(!plain.contains("\"solution") && !plain.contains("hashes"));
    }
}

#[test]
fn the_same_snapshot_gives_the_same_bytes() {
    for format in [
        "jsonl",
        #[cfg(feature = "parquet")]
        "parquet",
    ] {
        let one = export(&format!("{format}-one"), &["--format", format, "--jobs", "1"]);
        assert_eq!(one, export(&format!("{format}-two"), &["--format", format, "--jobs", "3"]));
    }
}

#[test]
fn twins_are_rows_and_games() {
    let own = rows(&export("own", &["--format", "jsonl"]));
    let masked = rows(&export("masked", &["--format", "jsonl", "--twin", "masked", "--solutions"]));
    assert_eq!(own.len(), masked.len());
    for (own, twin) in own.iter().zip(&masked) {
        for same in
            ["game_id", "level", "rules_digest", "difficulty", "goal_kind", "columns", "rows", "canary"]
        {
            assert_eq!(own[same], twin[same], "{same}");
        }
        for other in ["item_id", "title", "vgdl", "level_text", "game_digest"] {
            assert_ne!(own[other], twin[other], "{other}");
        }
        assert_eq!(twin["twin"], "masked");
        assert!(!twin["solution"].as_array().unwrap().is_empty());
    }
    let games = export("games", &["--format", "games", "--twin", "masked"]);
    for row in &masked {
        let (id, number) = (row["game_id"].as_str().unwrap(), &row["level"]);
        assert_eq!(row["vgdl"], text(&games[&format!("{id}/game.vgdl")]));
        assert_eq!(row["level_text"], text(&games[&format!("{id}/lvl{number}.txt")]));
    }
    let output = run(TINY.path(), &["--json", "run", "games", "--planner", "random", "--runs", "1"], 0);
    assert!(text(&output.stdout).contains(masked[0]["game_id"].as_str().unwrap()));
}

#[test]
fn archives_hold_the_whole_release() {
    let folder = TINY.path();
    let output = run(folder, &["export", "tiny", "--format", "archive", "--out", "tiny.tar.zst"], 0);
    let said = text(&output.stdout);
    assert!(
        said.ends_with("papers/ (4 files) is not in the archive: publish that folder next to it\n"),
        "{said}"
    );
    let root = |place: &str| {
        let output = run(folder, &["--json", "verify", place], 0);
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["root"].clone()
    };
    assert_eq!(root("tiny.tar.zst"), root("tiny"));
    run(folder, &["export", "tiny.tar.zst", "--format", "jsonl", "--out", "from-archive"], 0);
    assert_eq!(files(&folder.join("from-archive")), export("from-folder", &["--format", "jsonl"]));
    let said = |arguments: &[&str]| text(&run(folder, arguments, 2).stderr);
    let again = said(&["export", "tiny", "--format", "archive", "--out", "tiny.tar.zst"]);
    assert!(again.contains("tiny.tar.zst"), "{again}");
    let twin = said(&["export", "tiny", "--format", "archive", "--twin", "masked", "--out", "x"]);
    assert!(twin.contains("--twin"), "{twin}");
    let file = said(&["regenerate", "tiny.tar.zst"]);
    assert!(file.contains("this is a file") && file.contains("unpack an archive first"), "{file}");
}

#[test]
fn unverified_releases_are_not_exported() {
    let folder = tempfile::tempdir().unwrap();
    let tampered = folder.path().join("tampered");
    for (path, content) in files(&TINY.path().join("tiny")) {
        let content = if path == "README.md" { b"mine".to_vec() } else { content };
        fs::create_dir_all(tampered.join(&path).parent().unwrap()).unwrap();
        fs::write(tampered.join(path), content).unwrap();
    }
    let exports = ["export", "tampered", "--format", "jsonl", "--out", "out"];
    let output = run(folder.path(), &exports, 1);
    assert!(text(&output.stdout).contains("README.md"), "{}", text(&output.stdout));
    let left = |folder: &Path| fs::read_dir(folder).unwrap().count();
    assert_eq!(left(folder.path()), 1, "nothing is left of the export");
    let output = run(folder.path(), &["export", "absent", "--format", "jsonl", "--out", "out"], 2);
    assert!(text(&output.stderr).contains("MANIFEST.json"), "{}", text(&output.stderr));
    let output = run(folder.path(), &["export", "tampered", "--format", "xlsx", "--out", "out"], 2);
    assert!(text(&output.stderr).contains("jsonl"), "{}", text(&output.stderr));
    let output = run(folder.path(), &["export", "tampered", "--format", "jsonl", "--out", "-"], 2);
    assert!(text(&output.stderr).contains("standard output"), "{}", text(&output.stderr));
    let output = run(folder.path(), &["export", "tampered", "--format", "jsonl", "--out", "tampered"], 2);
    assert!(text(&output.stderr).contains("choose another --out"), "{}", text(&output.stderr));
    let output =
        run(folder.path(), &["export", "tampered", "--format", "jsonl", "--out", "tampered/rows"], 2);
    assert!(text(&output.stderr).contains("in the release itself"), "{}", text(&output.stderr));
    assert!(!tampered.join("rows").exists() && !tampered.join("rows.partial").exists());
}

/// Questions are drawn again to check answers, and the right answers are right.
#[test]
fn questions_are_written_and_answers_are_checked() {
    let folder = TINY.path();
    let order = ["export", "tiny", "--format", "questions", "--count", "2", "--seed", "exam"];
    let exported = export("questions", &order[2..]);
    let names: Vec<&str> = exported.keys().map(String::as_str).collect();
    assert_eq!(names, ["README.md", "check.py", "data/test.jsonl", "infinite_arcade_questions.yaml"]);
    let questions = rows(&exported);
    assert_eq!(questions.len(), 12);
    let given = questions.iter().map(|question| {
        let answer = format!("I see.\nANSWER: {}", question["answer"].as_str().unwrap());
        let answer = if question["id"] == "winnable-00001" { "Perhaps.".to_owned() } else { answer };
        serde_json::json!({ "id": question["id"], "answer": answer }).to_string() + "\n"
    });
    fs::write(folder.join("answers.jsonl"), given.skip(1).collect::<String>()).unwrap();
    let check = [&order[..], &["--check", "answers.jsonl", "--json"]].concat();
    let report: Value = serde_json::from_slice(&run(folder, &check, 0).stdout).unwrap();
    let of = |kind: &str, count: &str| report["kinds"][kind][count].as_u64().unwrap();
    assert_eq!((of("next-board", "right"), of("next-board", "unanswered")), (1, 1));
    assert_eq!((of("winnable", "right"), of("winnable", "unreadable")), (1, 1));
    assert_eq!((of("changed-rule", "right"), of("changed-rule", "questions")), (2, 2));
    fs::write(folder.join("unknown.jsonl"), "{\"id\": \"riddle-1\", \"answer\": \"\"}").unwrap();
    run(folder, &[&order[..], &["--check", "unknown.jsonl"]].concat(), 2);
    run(folder, &["export", "tiny", "--format", "jsonl", "--count", "2", "--out", "none"], 2);
}
