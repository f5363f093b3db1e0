//! Tests of `arcade studio` and `arcade gallery` as users run them.

use crate::arcade::{TINY, arcade, copy_of_tiny, files, run, text};
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};

/// A running studio, which is killed on drop.
struct Running {
    child: Child,
    port: u16,
    token: String,
}

impl Running {
    fn start(folder: &Path, args: &[&str]) -> Running {
        let mut child =
            arcade(folder).args(["studio", "--no-open"]).args(args).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let (address, token) = line.trim().split_once("/?token=").unwrap_or_else(|| panic!("{line}"));
        let port = address.strip_prefix("http://127.0.0.1:").unwrap().parse().unwrap();
        Running { child, port, token: token.to_owned() }
    }

    fn ask(&self, method: &str, path: &str, body: &Value) -> (u16, Value) {
        let (status, body) = self.exchange(method, path, body);
        (status, serde_json::from_str(&body).unwrap_or_else(|error| panic!("{error}: {body}")))
    }

    fn exchange(&self, method: &str, path: &str, body: &Value) -> (u16, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        let body = if method == "GET" { String::new() } else { body.to_string() };
        let (port, token, length) = (self.port, &self.token, body.len());
        let request = format!(
            "{method} {path} HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\nX-Arcade-Token: {token}\r\nContent-Length: {length}\r\n\r\n{body}"
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        (status, body.to_owned())
    }

    fn get(&self, path: &str) -> Value {
        let (status, answer) = self.ask("GET", path, &json!(null));
        assert_eq!(status, 200, "{path}: {answer}");
        answer
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_studio_opens_what_it_is_given() {
    let home = tempfile::tempdir().unwrap();
    let at = |path: &str| home.path().join(path);
    fs::create_dir_all(at("mine/game-one")).unwrap();
    let corpus = Running::start(home.path(), &[]);
    let games = corpus.get("/api/workspace");
    assert_eq!((games["kind"].as_str(), games["games"].as_array().map(Vec::len)), (Some("corpus"), Some(27)));
    // The copy is written to the folder opened next, where it can be edited.
    let into = Running::start(home.path(), &["corpus", "--out", "mine"]);
    let (status, copied) = into.ask("POST", "/api/copy", &json!({ "id": "hailglass", "title": "My Hail" }));
    assert_eq!((status, &copied["id"]), (200, &json!("my-hail")), "{copied}");
    let mine = Running::start(home.path(), &["mine"]);
    let games = mine.get("/api/workspace");
    let listed = games["games"].as_array().unwrap();
    assert_eq!(
        (listed.len(), &listed[0]["id"], &listed[0]["writable"]),
        (1, &json!("my-hail"), &json!(true))
    );
    let opened = mine.get("/api/games/my-hail");
    let body = json!({ "text": "new", "base": opened["levels"][0]["digest"] });
    let (status, _) = mine.ask("PUT", "/api/games/my-hail/files/lvl0.txt", &body);
    assert_eq!((status, fs::read_to_string(at("mine/my-hail/lvl0.txt")).unwrap().as_str()), (200, "new"));
    run(home.path(), &["studio", "nothing-there.vgdl"], 2);
    run(home.path(), &["studio", "--port", &corpus.port.to_string(), "--no-open"], 3);
}

#[test]
fn games_are_begun_where_there_are_none() {
    let home = tempfile::tempdir().unwrap();
    let at = |path: &str| home.path().join(path);
    fs::create_dir_all(at("empty/.git")).unwrap();
    for place in ["empty", "not-there/yet", "hailglas"] {
        let running = Running::start(home.path(), &[place]);
        let workspace = running.get("/api/workspace");
        assert_eq!(
            (&workspace["kind"], workspace["games"].as_array().map(Vec::len)),
            (&json!("games"), Some(0))
        );
        let genres: Vec<&str> = workspace["templates"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(|one| one["genre"].as_str())
            .collect();
        assert!(genres.contains(&"puzzle"), "{genres:?}");
        assert!(place == "empty" || !at(place).exists(), "nothing is written before a game is begun");
        let body = json!({ "genre": "puzzle", "title": "River Post" });
        let (status, begun) = running.ask("POST", "/api/new", &body);
        assert_eq!((status, &begun["id"]), (200, &json!("river-post")), "{begun}");
        // The files are the same as those of `arcade new`.
        run(home.path(), &["new", &format!("{place}/like"), "--like", "puzzle"], 0);
        assert_eq!(files(&at(place).join("river-post")), files(&at(place).join("like")));
        let (_, again) = running.ask("POST", "/api/new", &body);
        assert_eq!(again["id"], "river-post-2");
        assert_eq!(running.ask("POST", "/api/new", &json!({ "genre": "x", "title": "y" })).0, 400);
    }
    // A folder with other content is not a place for games.
    fs::create_dir_all(at("releases/2027-01")).unwrap();
    run(home.path(), &["studio", "releases", "--no-open"], 2);
}

#[test]
fn releases_are_shown_and_never_changed() {
    let (home, root) = copy_of_tiny();
    let running = Running::start(home.path(), &["tiny", "--against", "tiny"]);
    let release = running.get("/api/release");
    assert_eq!((&release["name"], release["games"].as_array().map(Vec::len)), (&json!("tiny"), Some(3)));
    let id = release["games"][0]["id"].as_str().unwrap().to_owned();
    let game = running.get(&format!("/api/games/{id}"));
    assert_eq!((&game["writable"], &game["card"]["id"]), (&json!(false), &json!(id)));
    let episode = running.get(&format!("/api/games/{id}/witness/lvl0"));
    let body =
        json!({ "source": game["source"]["text"], "level": game["levels"][0]["text"], "episode": episode });
    let (_, replayed) = running.ask("POST", "/api/replay", &body);
    assert_eq!(replayed["agrees"], true);
    assert_eq!(replayed["frames"].as_array().unwrap().last().unwrap()["outcome"], "won");
    assert_eq!(running.get("/api/release/compare")["kept"].as_array().map(Vec::len), Some(3));
    let (status, _) =
        running.ask("PUT", &format!("/api/games/{id}/files/lvl0.txt"), &json!({ "text": "", "base": null }));
    assert_eq!(status, 403);
    // Games opened inside a release cannot be edited either.
    let inside = Running::start(home.path(), &["tiny/games"]);
    let games = inside.get("/api/workspace");
    assert!(games["games"].as_array().unwrap().iter().all(|game| game["writable"] == false));
    // Cards and wins beside a game are shown, like those of freshly generated games.
    let beside = inside.get(&format!("/api/games/{id}"));
    assert_eq!((&beside["card"], &beside["witnesses"]), (&game["card"], &game["witnesses"]));
    // A release that does not verify is not shown.
    fs::write(root.join("games").join(&id).join("lvl0.txt"), "tampered").unwrap();
    let refused = run(home.path(), &["studio", "tiny", "--no-open"], 2);
    assert!(text(&refused.stderr).contains("does not verify"), "{}", text(&refused.stderr));
}

/// Requests the verification of the opened release. Returns the lines about earlier releases, followed by the
/// verdict.
fn verified(running: &Running) -> (Vec<Value>, Value) {
    let (status, said) = running.exchange("POST", "/api/release/verify", &json!({}));
    assert_eq!(status, 200, "{said}");
    let lines: Vec<Value> =
        said.lines().filter_map(|line| serde_json::from_str(line).ok()).filter(Value::is_object).collect();
    let of = |stage: &str| lines.iter().filter(|line| line["stage"] == stage).cloned().collect::<Vec<_>>();
    assert_eq!(of("done").len(), 1, "{said}");
    let [verdict] = &of("verdict")[..] else { panic!("{said}") };
    (of("ancestor"), verdict.clone())
}

#[test]
fn verification_follows_the_parents() {
    let home = tempfile::tempdir().unwrap();
    let at = |path: &str| home.path().join(path);
    let recipe = "description = 'x'\n[corpus]\ngames = 1\nlevels = 1\ncandidates = 2.0\n[criteria]\ndecision = 100\n\
        budget = 80000\ndepths = [10, 25]\nrandom_plays = 10\n";
    fs::create_dir_all(at("new")).unwrap();
    for (name, out, parent) in [
        ("one", "old/one", None),
        ("two", "old/two", Some("old/one")),
        ("three", "new/three", Some("old/two")),
    ] {
        fs::write(at("recipe.toml"), format!("name = '{name}'\nseed = '{name}'\n{recipe}")).unwrap();
        let parent = parent.map_or(Vec::new(), |parent| vec!["--parent", parent]);
        run(home.path(), &[&["release", "recipe.toml", "--out", out, "--quiet"], &parent[..]].concat(), 0);
    }
    let told = |ancestors: &[Value]| -> Vec<(Value, Value)> {
        ancestors.iter().map(|ancestor| (ancestor["name"].clone(), ancestor["ok"].clone())).collect()
    };
    // No earlier release is found beside this one, which is not a failure.
    let alone = Running::start(home.path(), &["new/three"]);
    let parent = alone.get("/api/release")["parent"].clone();
    let (ancestors, verdict) = verified(&alone);
    assert_eq!((told(&ancestors), &ancestors[0]["root"]), (vec![(json!(null), json!(null))], &parent));
    assert!(ancestors[0]["text"].as_str().unwrap().contains("--chain"), "{ancestors:?}");
    assert_eq!((&verdict["ok"], &verdict["sound"]), (&json!(true), &json!(true)));
    // The specified folder is searched, and so is the folder of the other release.
    for more in [["--chain", "old"], ["--against", "old/two"]] {
        let running = Running::start(home.path(), &[&["new/three"], &more[..]].concat());
        let (ancestors, verdict) = verified(&running);
        assert_eq!(told(&ancestors), [(json!("two"), json!(true)), (json!("one"), json!(true))], "{more:?}");
        assert_eq!((&ancestors[0]["root"], &verdict["ok"]), (&parent, &json!(true)));
        assert!(verdict["lines"].to_string().contains("back to the first"), "{verdict}");
    }
    // Signatures are checked with a key.
    run(home.path(), &["trust", "keygen", "ada", "--no-password"], 0);
    let signed = Running::start(home.path(), &["new/three", "--key", "ada.pub"]);
    let (_, verdict) = verified(&signed);
    assert_eq!((&verdict["ok"], &verdict["sound"]), (&json!(false), &json!(true)));
    assert!(verdict["lines"].to_string().contains("no signatures"), "{verdict}");
    run(home.path(), &["trust", "sign", "new/three", "--secret", "ada.key"], 0);
    let (_, verdict) = verified(&signed);
    assert!(verdict["ok"] == true && verdict["lines"].to_string().contains("signed by"), "{verdict}");
    run(home.path(), &["studio", "new/three", "--key", "absent.pub"], 2);
    run(home.path(), &["studio", "corpus", "--chain", "old"], 2);
    // An altered parent is a failure, also while the studio runs.
    let running = Running::start(home.path(), &["new/three", "--chain", "old"]);
    fs::write(at("old/two/README.md"), "tampered").unwrap();
    let (ancestors, verdict) = verified(&running);
    assert_eq!(told(&ancestors), [(json!("two"), json!(false))]);
    assert!(ancestors[0]["text"].as_str().unwrap().contains("README.md"), "{ancestors:?}");
    assert_eq!((&verdict["ok"], &verdict["sound"]), (&json!(false), &json!(true)));
    assert!(!verdict.to_string().contains(&*home.path().to_string_lossy()), "{verdict}");
}

/// Logs can claim anything. Their claims are displayed as data, never executed as markup.
#[test]
fn results_are_replayed_with_their_words() {
    let home = tempfile::tempdir().unwrap();
    let args = [
        "evaluate",
        "quiet-jars",
        "--player",
        "reflex",
        "--levels",
        "0",
        "--max-steps",
        "5",
        "--out",
        "results/reflex",
    ];
    run(home.path(), &args, 0);
    let log = home.path().join("results/reflex/episodes");
    let log = fs::read_dir(&log).unwrap().next().unwrap().unwrap().path();
    let recorded = fs::read_to_string(&log).unwrap();
    let misbehaving = "</script><img src=x onerror=alert(1)>\u{2028}";
    let said = |number: usize| {
        [
            json!({ "event": "message", "id": number, "role": "user", "text": misbehaving }),
            json!({ "event": "request", "step": number, "attempt": 0, "messages": [number], "tokens": 1 }),
            json!({ "event": "reply", "step": number, "attempt": 0, "class": "strict", "text": misbehaving,
                "finish": "stop", "usage": {}, "latency_ms": 0 }),
        ]
    };
    let mut written = String::new();
    let mut steps = 0;
    for line in recorded.lines() {
        if line.contains("\"event\":\"step\"") {
            said(steps).iter().for_each(|event| written += &format!("{event}\n"));
            steps += 1;
        }
        written += &format!("{line}\n");
    }
    fs::write(&log, written).unwrap();
    let running = Running::start(home.path(), &["results"]);
    let players = running.get("/api/results");
    let episodes = players["players"][0]["episodes"].as_array().unwrap();
    assert_eq!((episodes.len(), &episodes[0]["steps"]), (1, &json!(5)));
    let shown = running.get(&format!("/api/results/{}", episodes[0]["index"]));
    assert_eq!((&shown["agrees"], shown["frames"].as_array().map(Vec::len)), (&json!(true), Some(6)));
    let talk = shown["talk"].as_array().unwrap();
    assert_eq!(talk.len(), 5);
    assert!(talk[0]["prompt"].as_str().unwrap().contains(misbehaving), "{talk:?}");
    assert_eq!((&talk[4]["answer"], &talk[4]["frame"]), (&json!(misbehaving), &json!(4)));
    // A log that contradicts the game is reported as an error.
    fs::write(&log, recorded.replacen("\"action\":\"", "\"action\":\"nil\",\"x\":\"", 1)).unwrap();
    let (status, _) = running.ask("GET", "/api/results", &json!(null));
    assert_eq!(status, 500);
    assert_eq!(running.ask("GET", "/api/results/99", &json!(null)).0, 404);
}

#[cfg(unix)]
#[test]
fn an_ended_studio_has_done_its_work() {
    let home = tempfile::tempdir().unwrap();
    let mut running = Running::start(home.path(), &["hailglass"]);
    running.get("/api/planners");
    crate::arcade::terminate(&running.child);
    assert_eq!(running.child.wait().unwrap().code(), Some(0));
}

#[test]
fn judgements_are_reported() {
    let home = tempfile::tempdir().unwrap();
    let args = ["--judge", "hailglass", "--judge", "osier-way", "--pairs", "2", "--out", "judged.jsonl"];
    {
        let running = Running::start(home.path(), &args);
        let pair = running.get("/api/judge");
        assert_eq!((&pair["of"], &running.get("/api/workspace")["games"]), (&json!(2), &json!([])));
        let body = json!({ "pair": 0, "better": "left", "again": "left", "machine": "right", "words": "" });
        assert_eq!(running.ask("POST", "/api/judge", &body).0, 200);
    }
    let report = run(home.path(), &["--json", "studio", "--judge-report", "judged.jsonl"], 0);
    let report: Value = serde_json::from_slice(&report.stdout).unwrap();
    assert_eq!((&report["judged"], report["sources"].as_array().map(Vec::len)), (&json!(1), Some(2)));
    let words = run(home.path(), &["studio", "--judge-report", "judged.jsonl"], 0);
    assert!(text(&words.stdout).contains("better in 1, worse in 0"), "{}", text(&words.stdout));
    run(home.path(), &["studio", "--judge", "hailglass", "--judge", "osier-way"], 2);
    run(home.path(), &["studio", "--judge", "hailglass", "--out", "x.jsonl"], 2);
    run(home.path(), &["studio", "--judge-report", "absent.jsonl"], 3);
}

#[test]
fn galleries_are_whole_and_their_data_are_data() {
    let home = tempfile::tempdir().unwrap();
    let tiny = TINY.path().join("tiny");
    let tiny = tiny.to_str().unwrap();
    run(home.path(), &["gallery", tiny, "--out", "page"], 0);
    let page = fs::read_to_string(home.path().join("page/index.html")).unwrap();
    assert!(page.contains("<script src=\"data/release.js\" defer></script>"), "{page}");
    let mut games = 0;
    for entry in fs::read_dir(home.path().join("page/data")).unwrap() {
        let path = entry.unwrap().path();
        let script = fs::read_to_string(&path).unwrap();
        assert!(!script.contains(['<', '>', '&', '\u{2028}', '\u{2029}']), "{}", path.display());
        let inner = script.strip_prefix("arcadeGallery(").and_then(|rest| rest.strip_suffix(");\n")).unwrap();
        let parts: Vec<Value> = serde_json::from_str(&format!("[{inner}]")).unwrap();
        let name = parts[0].as_str().unwrap();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        if name == "release" {
            assert_eq!(parts[1]["games"].as_array().map(Vec::len), Some(3));
            continue;
        }
        assert_eq!(name, format!("game/{stem}"));
        games += 1;
        for witness in parts[1]["witnesses"].as_array().unwrap() {
            let (frames, actions) =
                (witness["frames"].as_array().unwrap(), witness["actions"].as_array().unwrap());
            assert_eq!(frames.len(), actions.len() + 1);
            assert_eq!(frames.last().unwrap()["outcome"], "won");
            assert!(frames[0]["marks"].is_array() && frames[1]["change"].is_array());
        }
    }
    assert_eq!(games, 3);
    // The same release gives an identical page on any number of threads.
    run(home.path(), &["gallery", tiny, "--out", "again", "--jobs", "1"], 0);
    for entry in fs::read_dir(home.path().join("page/data")).unwrap() {
        let path = entry.unwrap().path();
        let other = home.path().join("again/data").join(path.file_name().unwrap());
        assert_eq!(fs::read(&path).unwrap(), fs::read(other).unwrap());
    }
    run(home.path(), &["gallery", tiny, "--out", "page"], 2);
    run(home.path(), &["gallery", "nothing-there", "--out", "other"], 2);
    let (broken, root) = copy_of_tiny();
    fs::remove_file(root.join("README.md")).unwrap();
    run(broken.path(), &["gallery", "tiny", "--out", "other"], 1);
    assert!(!broken.path().join("other").exists());
}
