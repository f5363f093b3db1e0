//! Tests of `cargo xtask conformance`, with the golden traces and with traces in which one field is altered.

use flate2::read::GzDecoder;
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SIX: [&str; 6] = ["aliens", "boulderdash", "escape", "realsokoban", "sokoban", "zelda"];

/// Runs the comparison with the given flags, and checks that it reports the expected result: all episodes are
/// identical, or some differ.
#[track_caller]
fn conformance(folder: &Path, args: &[&str], is_identical: bool) -> Output {
    let xtask = env!("CARGO_BIN_EXE_xtask");
    let output = Command::new(xtask).current_dir(folder).arg("conformance").args(args).output();
    let output = output.expect("the binary starts");
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| text(bytes));
    assert_eq!(output.status.success(), is_identical, "{args:?}\n--- stdout\n{out}\n--- stderr\n{err}");
    output
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns the folders with the reference's games and traces, which are not part of the repository. If they
/// are missing, prints a note and returns `None`.
#[allow(clippy::print_stdout, reason = "a skipped test says so")]
fn reference() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/gvgai");
    let found = folder.is_dir();
    if !found {
        println!("SKIPPED: no golden traces at {}", folder.display());
    }
    found.then_some(folder)
}

fn folders(reference: &Path) -> [String; 4] {
    let path = |name: &str| reference.join(name).display().to_string();
    ["--games".into(), path("games"), "--traces".into(), path("traces")]
}

#[test]
fn the_six_games_are_identical_in_every_field_of_every_tick() {
    let Some(reference) = reference() else { return };
    let folders = folders(&reference);
    let mut args: Vec<&str> = Vec::new();
    args.extend(folders.iter().map(String::as_str));
    args.extend(SIX.iter().flat_map(|name| ["--game", name]));
    let output = conformance(Path::new("."), &args, true);
    assert_eq!(text(&output.stdout).lines().last(), Some("identical: 60 of 60 episodes"));
}

/// Compares one recorded episode of each public game, or all 1,122 recorded episodes in a sweep.
#[test]
fn every_public_game_is_identical() {
    let Some(reference) = reference() else { return };
    let (games, traces) = (reference.join("games"), reference.join("traces"));
    let some = tempfile::tempdir().unwrap();
    let mut episodes = 0;
    for folder in fs::read_dir(&traces).unwrap().map(|entry| entry.unwrap().path()) {
        let mut files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.truncate(if std::env::var_os("ARCADE_SWEEP").is_some() { usize::MAX } else { 1 });
        let to = some.path().join(folder.file_name().unwrap());
        fs::create_dir(&to).unwrap();
        for file in &files {
            fs::copy(file, to.join(file.file_name().unwrap())).unwrap();
        }
        episodes += files.len();
    }
    assert!(
        episodes >= if std::env::var_os("ARCADE_SWEEP").is_some() { 1122 } else { 116 },
        "{episodes} episodes"
    );
    let games = games.display().to_string();
    let output = conformance(some.path(), &["--traces", ".", "--games", &games], true);
    let last = text(&output.stdout).lines().last().unwrap().to_owned();
    assert_eq!(last, format!("identical: {episodes} of {episodes} episodes"));
}

/// Compares the games in `corpora/` with traces recorded by the reference (`tests/ref/traces/README.md`).
#[test]
fn the_corpus_is_identical_in_every_field_of_every_tick() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let output = conformance(&root, &["--games", "corpora", "--traces", "tests/ref/traces"], true);
    assert_eq!(text(&output.stdout).lines().last(), Some("identical: 405 of 405 episodes"));
}

#[test]
fn a_missing_game_or_trace_is_named() {
    let Some(reference) = reference() else { return };
    let [_, games, _, traces] = folders(&reference);
    let empty = tempfile::tempdir().unwrap();
    let nothing = empty.path().display().to_string();
    conformance(empty.path(), &["--games", &games, "--traces", &nothing], false);
    conformance(empty.path(), &["--games", &games, "--traces", "nowhere"], false);
    let output =
        conformance(empty.path(), &["--games", &nothing, "--traces", &traces, "--game", "zelda"], false);
    assert!(text(&output.stderr).contains("zelda"), "{}", text(&output.stderr));
    let output =
        conformance(empty.path(), &["--games", &games, "--traces", &traces, "--game", "zleda"], false);
    assert!(text(&output.stderr).contains("did you mean `zelda`?"), "{}", text(&output.stderr));
    fs::create_dir(empty.path().join("zelda")).unwrap();
    fs::write(empty.path().join("zelda/lvl0.cut1.jsonl.gz"), b"not gzip").unwrap();
    let output = conformance(empty.path(), &["--games", &games, "--traces", &nothing], false);
    assert!(text(&output.stderr).contains("lvl0.cut1"), "{}", text(&output.stderr));
}

/// A trace as JSON lines, in which fields can be altered.
struct Trace {
    lines: Vec<Value>,
}

impl Trace {
    fn read(reference: &Path, name: &str) -> Trace {
        let mut plain = String::new();
        let file = File::open(reference.join("traces").join(name)).unwrap();
        GzDecoder::new(file).read_to_string(&mut plain).unwrap();
        Trace { lines: plain.lines().map(|line| serde_json::from_str(line).unwrap()).collect() }
    }

    /// Returns the first tick from `from` onwards that satisfies a condition.
    fn tick(&self, from: usize, condition: impl Fn(&Value) -> bool) -> usize {
        let found = self.lines[from + 2..].iter().position(condition);
        from + found.expect("the trace has such a tick")
    }

    fn at(&mut self, tick: usize) -> &mut Value {
        &mut self.lines[tick + 2]
    }

    /// Alters one field at a tick, and checks that the first difference reported by the comparison is at that
    /// tick and in that field.
    #[track_caller]
    fn check(&self, reference: &Path, tick: usize, field: &str, alter: impl FnOnce(&mut Value)) {
        let mut altered = Trace { lines: self.lines.clone() };
        alter(altered.at(tick));
        let game = self.lines[0]["game"].as_str().unwrap();
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join(game)).unwrap();
        let plain: Vec<String> = altered.lines.iter().map(Value::to_string).collect();
        fs::write(folder.path().join(game).join("lvl.jsonl"), plain.join("\n") + "\n").unwrap();
        let games = reference.join("games").display().to_string();
        let traces = folder.path().display().to_string();
        let output = conformance(folder.path(), &["--json", "--games", &games, "--traces", &traces], false);
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let difference = &report["differing"][0]["difference"];
        assert_eq!(difference["tick"], json!(tick), "{field}: {difference}");
        assert_eq!(difference["fields"][0]["field"], json!(field), "{difference}");
        assert_eq!(
            difference["fields"].as_array().unwrap().len(),
            1,
            "only that field differs: {difference}"
        );
    }
}

fn has(list: &'static str) -> impl Fn(&Value) -> bool {
    move |line: &Value| line[list].as_array().is_some_and(|list| !list.is_empty())
}

#[test]
fn an_altered_field_is_reported_at_its_tick() {
    let Some(reference) = reference() else { return };
    let reference = reference.as_path();
    let trace = Trace::read(reference, "boulderdash/lvl0.planner3.jsonl.gz");
    let plain = 7;
    trace.check(reference, plain, "score", |line| {
        line["score"] = json!(line["score"].as_f64().unwrap() + 1.0)
    });
    trace.check(reference, plain, "winner", |line| line["winner"] = json!("PLAYER_WINS"));
    trace.check(reference, plain, "ended", |line| line["ended"] = json!(true));
    trace.check(reference, plain, "avatar", |line| line["avatar"] = json!(0));
    trace.check(reference, plain, "rng", |line| line["rng"] = json!(line["rng"].as_u64().unwrap() ^ 1));
    let rich = trace.tick(5, |line| line["resources"].as_object().is_some_and(|held| !held.is_empty()));
    trace.check(reference, rich, "resources", |line| {
        let first = line["resources"].as_object_mut().unwrap().values_mut().next().unwrap();
        *first = json!(first.as_i64().unwrap() + 1);
    });

    let moving = trace.tick(9, has("mod"));
    for (place, field) in [(2, "x"), (3, "y"), (4, "w"), (5, "h"), (9, "hp")] {
        trace.check(reference, moving, field, |line| {
            let value = &mut line["mod"][0][place];
            *value = json!(value.as_i64().unwrap() + 1);
        });
    }
    for (place, field) in [(6, "orientation.x"), (7, "orientation.y"), (8, "speed")] {
        trace.check(reference, moving, field, |line| {
            let value = &mut line["mod"][0][place];
            *value = json!(value.as_f64().unwrap() + 0.5);
        });
    }
    trace.check(reference, moving, "flags", |line| line["mod"][0][10] = json!(9));
    let extra = |line: &mut Value, extra: Value| {
        let record = line["mod"][0].as_array_mut().unwrap();
        record.truncate(11);
        record.push(extra);
    };
    let unencumbered = trace.tick(9, |line| {
        has("mod")(line) && line["mod"][0].as_array().is_some_and(|record| record.len() == 11)
    });
    trace.check(reference, unencumbered, "res", |line| extra(line, json!({ "res": { "6": 1 } })));
    trace.check(reference, unencumbered, "rot", |line| extra(line, json!({ "rot": 0.25 })));

    let born = trace.tick(0, has("add"));
    trace.check(reference, born, "presence", |line| drop(line["add"].as_array_mut().unwrap().remove(0)));
    trace.check(reference, plain, "presence", |line| {
        let mut add = line["add"].as_array().cloned().unwrap_or_default();
        add.push(json!([99999, 1, 0, 0, 10, 10, 0.0, 0.0, 0.0, 0, 0]));
        line["add"] = json!(add);
    });
}

/// −0.0 and 0.0 are equal as numbers, but are reported as different fields.
#[test]
fn the_sign_of_zero_counts() {
    let Some(reference) = reference() else { return };
    let trace = Trace::read(&reference, "boulderdash/lvl0.random1.jsonl.gz");
    let zero = |line: &Value| has("mod")(line) && line["mod"][0][6] == json!(0.0);
    let tick = trace.tick(3, zero);
    trace.check(&reference, tick, "orientation.x", |line| line["mod"][0][6] = json!(-0.0));
}

/// Compares three games: one with its own counters, one that crashes the reference, and one that the
/// reference ends because of its messages.
#[test]
fn counters_notes_and_errors_of_the_reference_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let game = "BasicGame square_size=10 no_counters=2\n  SpriteSet\n    a > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    x > a avatar\n  InteractionSet\n    a avatar > halfSpeed counter=1,0\n  TerminationSet\n    Timeout limit=9\n";
    let rng = 1u64 ^ 0x5_DEEC_E66D;
    let header = |name: &str, width: usize, log: usize| {
        json!({ "format": "vgdl-trace/1", "game": name, "level": 0, "seed": 1, "block_size": 10, "width": 10 * width,
            "height": 10, "types": ["wall", "avatar", "a"], "sprite_order": [0, 2, 1], "avatar": 1,
            "actions": ["ACTION_LEFT", "ACTION_RIGHT", "ACTION_DOWN", "ACTION_UP"], "log": vec!["?"; log] })
    };
    let sprites =
        json!([[0, 2, 0, 0, 10, 10, 0.0, 0.0, 0.0, 0, 0], [1, 1, 0, 0, 10, 10, 0.0, 0.0, 1.0, 0, 2]]);
    let tick = |counters: Value| {
        json!({ "tick": 0, "action": "ACTION_NIL", "score": 0.0, "winner": "NO_WINNER", "ended": false, "rng": rng,
            "avatar": 1, "resources": {}, "counters": counters, "add": [], "del": [], "mod": [] })
    };
    let trace = |name: &str, header: Value, tick: Value| {
        let initial = json!({ "tick": -1, "sprites": sprites, "rng": rng });
        write(&format!("traces/{name}/lvl0.nil4.jsonl"), &format!("{header}\n{initial}\n{tick}\n"));
    };
    write("games/tally/game.txt", game);
    write("games/tally/lvl0.txt", "x\n");
    trace("tally", header("tally", 1, 0), tick(json!([1, 0])));
    write("games/noisy/game.txt", game);
    write("games/noisy/lvl0.txt", &format!("x{}\n", "?".repeat(26)));
    let mut noted = tick(json!([1, 0]));
    (noted["ended"], noted["note"]) = (json!(true), json!("ended by MAX_ALLOWED_WARNINGS"));
    trace("noisy", header("noisy", 27, 26), noted.clone());
    for (name, text) in [
        ("dead", "Game\n".to_owned()),
        ("deadly", game.replace("a avatar\n", "ghost\n")),
        ("deadlier", game.replace("a > Immovable", "a > Statue")),
    ] {
        write(&format!("games/{name}/game.txt"), &text);
        write(&format!("games/{name}/lvl0.txt"), "x\n");
        let header =
            json!({ "format": "vgdl-trace/1", "game": name, "level": 0, "seed": 1, "engine_error": "?" });
        write(&format!("traces/{name}/lvl0.nil4.jsonl"), &format!("{header}\n"));
    }
    let folders = folders(folder.path());
    let mut args: Vec<&str> = Vec::new();
    args.extend(folders.iter().map(String::as_str));
    let output = conformance(folder.path(), &args, true);
    assert_eq!(text(&output.stdout).lines().last(), Some("identical: 5 of 5 episodes"));

    trace("tally", header("tally", 1, 0), tick(json!([1, 1])));
    noted["note"] = Value::Null;
    trace("noisy", header("noisy", 27, 26), noted);
    args.push("--json");
    let output = conformance(folder.path(), &args, false);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let fields = report["differing"]
        .as_array()
        .unwrap()
        .iter()
        .map(|episode| &episode["difference"]["fields"][0]["field"]);
    assert_eq!(fields.collect::<Vec<_>>(), [&json!("note"), &json!("counters")]);
}
