//! Tests of `arcade report`: self-contained files, identical bytes for identical results, statements about
//! models and failures, and clear errors.

use crate::arcade::{files, run, text};
use engine::Action;
use evaluation::client::{Finish, Role, Usage};
use evaluation::log::{Reply, ReplyClass};
use evaluation::player::Contestant;
use evaluation::run::{FORMAT, PlayResult, Progress, Task};
use evaluation::{
    Agent, Choice, Entrant, Evaluation, Event, Halt, Journal, Settings, Subject, SubjectFacts, Turn, Validity,
};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A game in which the player carries a lamp to each lantern. Moths take the lamp away.
const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    lantern > Immovable color=YELLOW\n    moth > RandomNPC cooldown=3\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    A > avatar floor\n    l > lantern floor\n    m > moth floor\n  InteractionSet\n    avatar wall > stepBack\n    moth wall > stepBack\n    lantern avatar > killSprite scoreChange=1\n    avatar moth > killSprite\n  TerminationSet\n    SpriteCounter stype=lantern win=True\n    SpriteCounter stype=avatar win=False\n";
const LEVELS: [&str; 2] = ["wwwwww\nwA..lw\nwwwwww\n", "wwwwwww\nwA...lw\nw..m..w\nw.l...w\nwwwwwww\n"];

fn game(id: &str) -> Subject {
    let levels: Vec<_> =
        LEVELS.iter().enumerate().map(|(number, text)| (number, (*text).to_owned(), None)).collect();
    let facts = SubjectFacts { title: format!("The <{id}>"), ..SubjectFacts::default() };
    Subject::read(id, GAME, &levels, facts).unwrap()
}

/// A model that goes right and says so. Every fourth of its answers is unreadable.
struct Talker {
    /// The decision before which the model halts, or `None` if it never halts.
    halt: Option<u64>,
}

impl Agent for Talker {
    fn act(&mut self, turn: &Turn<'_>, journal: &mut Journal) -> Result<Choice, Halt> {
        let step = turn.number;
        if self.halt == Some(step) {
            return Err(Halt::Infrastructure("the server is gone".to_owned()));
        }
        let id = u32::try_from(step).unwrap();
        let told = Event::Message { id, role: Role::User, text: format!("Board <{step}>"), image: None };
        let readable = step % 4 != 3;
        let reply = Reply {
            step,
            attempt: 0,
            class: if readable { ReplyClass::Strict } else { ReplyClass::Invalid },
            text: if readable {
                "Action: right".to_owned()
            } else {
                "</script><b>what</b> & why?".to_owned()
            },
            reasoning: Some("I see a light.".to_owned()),
            action: readable.then_some(Action::Right),
            plan: None,
            stage: None,
            finish: Finish::Stop,
            usage: Usage { input_tokens: Some(100), output_tokens: Some(5), ..Usage::default() },
            served_by: None,
            failures: Vec::new(),
            cached: false,
            latency_ms: 12.0,
        };
        let asked = Event::Request { step, attempt: 0, messages: vec![id], tokens: 9 };
        for event in [told, asked, Event::Reply(reply)] {
            journal.push(event).map_err(|error| Halt::Log(error.to_string()))?;
        }
        Ok(match readable {
            true => Choice::of(Action::Right),
            false => Choice::nothing(Validity::Invalid),
        })
    }

    fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        Ok(())
    }
}

struct Silent;

impl Progress for Silent {
    fn episode(&self, _: &Task<'_>, _: &PlayResult) {}
}

/// Records the results of [`Talker`] on a game, with two runs of each level.
fn talk(folder: &Path, id: &str, mode: &str, halt: Option<u64>) {
    let subjects = vec![game(id)];
    let entrant = Entrant {
        name: "talker".to_owned(),
        mode: Some(mode.to_owned()),
        aids: Vec::new(),
        details: Value::Null,
    };
    let settings = Settings {
        format: FORMAT,
        semantics: engine::SEMANTICS,
        suite: "test".to_owned(),
        snapshot: None,
        entrant,
        seed: "test".to_owned(),
        runs: 2,
        max_steps: 12,
        commit: evaluation::Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(&subjects),
    };
    let evaluation = Evaluation::create(folder, settings, subjects).unwrap();
    let contestant = |task: &Task<'_>| {
        let halt = halt.filter(|_| task.level.number == 1);
        Ok(Contestant::Agent(Box::new(Talker { halt })))
    };
    evaluation.run(contestant, &Silent).unwrap();
}

/// Records a built-in player's results on the same game.
fn play(home: &Path, player: &str, out: &str) {
    let folder = home.join("lanterns");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("game.vgdl"), GAME).unwrap();
    for (number, level) in LEVELS.iter().enumerate() {
        fs::write(folder.join(format!("lvl{number}.txt")), level).unwrap();
    }
    let more = ["--runs", "2", "--max-steps", "12", "--seed", "test", "--out", out];
    run(home, &[&["evaluate", "lanterns", "--player", player], &more[..]].concat(), 0);
}

#[test]
fn reports_are_self_contained() {
    let home = tempfile::tempdir().unwrap();
    play(home.path(), "random", "random");
    play(home.path(), "mcts:20", "mcts");
    talk(&home.path().join("zero"), "lanterns", "zero-shot", None);
    talk(&home.path().join("context"), "lanterns", "contextual", Some(5));
    let report = |out: &str, jobs: &str| {
        let args = ["--json", "report", "random", "mcts", "zero", "context", "--out", out, "--jobs", jobs];
        let output = run(home.path(), &args, 0);
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let told = report("one", "1");
    report("two", "2");
    let made = files(&home.path().join("one"));
    assert!(made == files(&home.path().join("two")), "the same results give the same bytes");
    assert_eq!((&told["episodes"], &told["ended"]), (&Value::from(16), &Value::from(14)));
    let lead = told["verdict"][0].as_str().unwrap();
    assert!(lead.starts_with("talker (") && lead.contains(" A single game does not show"), "{lead}");
    assert_eq!(told["files"].as_array().unwrap().len(), made.len());

    let file = |name: &str| text(&made[name]);
    let page = file("report.html");
    for outside in ["http://", "https://", "src=\"/", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    let shown = [
        "4 players on 1 game, 2 levels",
        "2 aborted by network, server or process",
        "because no answer could be read",
        "talker (zero-shot)",
        "Zero-shot against contextual",
        "&lt;/script&gt;&lt;b&gt;what&lt;&#x2f;b&gt; &amp; why?",
        "I see a light.",
        "Board &lt;0&gt;",
        "The &lt;lanterns&gt;, level 0, run 0",
        "prefers-color-scheme: dark",
        "These results do not record the kinds of their games",
        "Why episodes were not won",
    ];
    for part in shown {
        assert!(page.replace("&#x2f;script", "/script").contains(part), "{part}");
    }
    for never in ["NaN", ">inf<", "</script><b>"] {
        assert!(!page.contains(never), "{never}");
    }
    // The talker wins level 0 by going right, and never wins level 1, where a moth or the limit ends its episodes.
    let (_, replays) = page.split_once("id=\"replays\"").unwrap();
    let (_, of_talker) = replays.split_once("<h3>talker (zero-shot)</h3>").unwrap();
    let first = of_talker.split("</summary>").next().unwrap();
    assert!(
        first.ends_with("lost after 9 steps, score 1: died of touching moth; 1 of 2 lantern left"),
        "{first}"
    );
    let json: Value = serde_json::from_slice(&made["report.json"]).unwrap();
    assert_eq!(json["study"]["players"].as_array().unwrap().len(), 4);
    assert!(file("report.md").contains("| talker (zero-shot) |"));
    assert!(file("tables/leaderboard.csv").starts_with("player,"));
    assert!(file("tables/leaderboard.tex").contains("\\begin{tabular}"));
}

/// A player does nothing on levels where nothing happens. Nearly all values are missing, and are reported as missing.
#[test]
fn small_samples_show_little() {
    let home = tempfile::tempdir().unwrap();
    play(home.path(), "nil", "nil");
    run(home.path(), &["-q", "report", "nil", "--out", "report", "--replays", "0"], 0);
    let page = text(&files(&home.path().join("report"))["report.html"]);
    for part in ["1 player on 1 game", "One player", "No model was evaluated in both modes", "no episodes"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("id=\"replays\"") && !page.contains("NaN"));
}

#[test]
fn invalid_results_are_refused_with_advice() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    play(home.path(), "random", "random");
    talk(&at("zero"), "lanterns", "zero-shot", None);
    // The game has the same name but different rules.
    let other = GAME.replace("scoreChange=1", "scoreChange=2");
    fs::write(at("lanterns/game.vgdl"), &other).unwrap();
    run(home.path(), &["evaluate", "lanterns", "--player", "nil", "--max-steps", "3", "--out", "other"], 0);
    // One log is invalid, and the episode in the other log does not replay.
    for (name, from, to) in
        [("damaged", "\"event\"", "\"evnt\""), ("elsewhere", "\"score\":1.0", "\"score\":7.0")]
    {
        talk(&at(name), "lanterns", "zero-shot", None);
        let log = at(name).join("episodes/lanterns-lvl0-run0.jsonl");
        let altered = fs::read_to_string(&log).unwrap().replace(from, to);
        fs::write(&log, altered).unwrap();
    }
    fs::create_dir(at("taken")).unwrap();
    fs::write(at("taken/mine.txt"), "mine").unwrap();
    let cases: [(&[&str], &[&str]); 7] = [
        (&["lanterns"], &["lanterns", "contains no evaluation results"]),
        (&["missing"], &["missing", "contains no evaluation results"]),
        (&["random", "random"], &["random", "run 0"]),
        (&["random", "other"], &["other", "lanterns"]),
        (&["damaged"], &["lanterns-lvl0-run0.jsonl: line 1", "not an event", "--resume"]),
        (&["elsewhere"], &["elsewhere", "lanterns"]),
        (&["random", "--jobs", "0"], &["--jobs"]),
    ];
    for (args, words) in cases {
        let args = [&["report", "--out", "report"], args].concat();
        let message = text(&run(home.path(), &args, 2).stderr);
        for part in words {
            assert!(message.contains(part), "no `{part}` in: {message}");
        }
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(!at("report").exists() && !at("report.partial").exists());
    }
    let message = text(&run(home.path(), &["report", "random", "--out", "taken"], 2).stderr);
    assert!(message.contains("taken"), "{message}");
    assert_eq!(fs::read(at("taken/mine.txt")).unwrap(), b"mine");
}

/// Records results of random play, and then changes one file.
fn tampered(home: &Path, name: &str, file: &str, change: impl FnOnce(Vec<u8>) -> Vec<u8>) {
    play(home, "random", name);
    let path = home.join(name).join(file);
    let content = fs::read(&path).unwrap();
    fs::write(&path, change(content)).unwrap();
}

/// Returns the report's summary of these results.
fn summary(home: &Path, results: &str) -> Value {
    let _ = fs::remove_dir_all(home.join("report"));
    serde_json::from_slice(&run(home, &["--json", "report", results, "--out", "report"], 0).stdout).unwrap()
}

/// A results folder can claim anything. Excessive values are rejected before memory is allocated, and invalid
/// text is reported as malformed.
#[test]
fn results_folders_are_read_within_bounds() {
    let home = tempfile::tempdir().unwrap();
    let replaced = |from: &'static str, to: &'static str| {
        move |content: Vec<u8>| {
            let text = String::from_utf8(content).unwrap();
            assert!(text.contains(from), "{text}");
            text.replacen(from, to, 1).into_bytes()
        }
    };
    let settings = "evaluation.json";
    tampered(home.path(), "runs", settings, replaced("\"runs\": 2", "\"runs\": 1000000000"));
    tampered(home.path(), "more-runs", settings, replaced("\"runs\": 2", "\"runs\": 18446744073709551615"));
    tampered(home.path(), "no-runs", settings, replaced("\"runs\": 2", "\"runs\": 0"));
    tampered(
        home.path(),
        "steps",
        settings,
        replaced("\"max_steps\": 12", "\"max_steps\": 18446744073709551615"),
    );
    tampered(home.path(), "twice", settings, replaced("\"number\": 1", "\"number\": 0"));
    let not_utf8 = |mut content: Vec<u8>| {
        content.insert(3, 0xff);
        content
    };
    tampered(home.path(), "settings", settings, not_utf8);
    tampered(home.path(), "game", "games/lanterns/game.vgdl", not_utf8);
    tampered(home.path(), "level", "games/lanterns/lvl1.txt", not_utf8);
    tampered(home.path(), "log", "episodes/lanterns-lvl0-run0.jsonl", not_utf8);
    tampered(home.path(), "long", "games/lanterns/game.vgdl", |_| vec![b' '; 1 << 18]);
    for (results, words) in [
        ("runs", &["runs/evaluation.json", "`runs` is 1000000000 on 2 levels", "1000000 episodes"][..]),
        ("more-runs", &["`runs` is 18446744073709551615"]),
        ("no-runs", &["`runs` is 0"]),
        ("steps", &["steps/evaluation.json", "`max_steps` is 18446744073709551615"]),
        ("twice", &["level 0 of `lanterns` is listed twice"]),
        ("settings", &["settings/evaluation.json", "byte 3 is not UTF-8"]),
        ("game", &["game.vgdl", "byte 3 is not UTF-8"]),
        ("level", &["lvl1.txt", "byte 3 is not UTF-8"]),
        ("log", &["lanterns-lvl0-run0.jsonl: line 1"]),
        ("long", &["game.vgdl", "larger than 131072 bytes"]),
    ] {
        let message = text(&run(home.path(), &["report", results, "--out", "report"], 2).stderr);
        for part in words {
            assert!(message.contains(part), "{results}: no `{part}` in: {message}");
        }
        assert!(!home.path().join("report").exists());
    }
}

/// An episode whose log is a dangling link counts as started, with its link target missing.
#[cfg(unix)]
#[test]
fn dangling_links_are_told() {
    let home = tempfile::tempdir().unwrap();
    play(home.path(), "random", "random");
    let log = home.path().join("random/episodes/lanterns-lvl0-run0.jsonl");
    fs::remove_file(&log).unwrap();
    std::os::unix::fs::symlink("absent", &log).unwrap();
    let message = text(&run(home.path(), &["report", "random", "--out", "report"], 2).stderr);
    assert!(message.contains("lanterns-lvl0-run0.jsonl: a broken link"), "{message}");
}

/// Statements in a log that follow from its steps, or from the settings, are checked.
#[test]
fn logs_are_compared_with_their_replay() {
    let home = tempfile::tempdir().unwrap();
    let log = "episodes/lanterns-lvl0-run0.jsonl";
    let line = |at: usize, from: &'static str, to: &'static str| {
        move |content: Vec<u8>| {
            let text = String::from_utf8(content).unwrap();
            let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
            let at = if at == usize::MAX { lines.len() - 1 } else { at };
            assert!(lines[at].contains(from), "{}", lines[at]);
            lines[at] = lines[at].replacen(from, to, 1);
            (lines.join("\n") + "\n").into_bytes()
        }
    };
    let (first, last) = (0, usize::MAX);
    tampered(home.path(), "status", log, line(last, "\"status\":\"step_limit\"", "\"status\":\"over\""));
    tampered(home.path(), "limit", log, line(first, "\"max_steps\":12", "\"max_steps\":13"));
    tampered(home.path(), "run", log, line(first, "\"run\":0", "\"run\":1"));
    tampered(home.path(), "invalid", log, line(1, "\"validity\":\"valid\"", "\"validity\":\"invalid\""));
    tampered(home.path(), "score", log, line(3, "\"score\":0.0", "\"score\":1.0"));
    tampered(home.path(), "after", log, |content| {
        let text = String::from_utf8(content).unwrap();
        let step = text.lines().nth(1).unwrap().replacen("\"step\":0", "\"step\":12", 1);
        let (before, end) = text.trim_end().rsplit_once('\n').unwrap();
        format!("{before}\n{step}\n{end}\n").into_bytes()
    });
    // The settings state fewer runs than were played, so the remaining runs would be ignored.
    tampered(home.path(), "fewer", "evaluation.json", |content| {
        String::from_utf8(content).unwrap().replacen("\"runs\": 2", "\"runs\": 1", 1).into_bytes()
    });
    talk(&home.path().join("valid"), "lanterns", "zero-shot", None);
    let path = home.path().join("valid/episodes/lanterns-lvl1-run0.jsonl");
    let altered =
        fs::read_to_string(&path).unwrap().replacen("\"validity\":\"invalid\"", "\"validity\":\"valid\"", 1);
    fs::write(&path, altered).unwrap();
    for (results, words) in [
        ("status", &["line 14: ", "the game is over, but the game is not over"][..]),
        ("limit", &["line 14: ", "12 of 13 steps were taken"]),
        ("run", &["line 1: ", "the log records run 1, but 0 was requested"]),
        ("invalid", &["line 2: ", "step 0 is recorded as invalid, but the step has an action"]),
        ("score", &["line 4: ", "step 2 leads to score 0, but the log records 1"]),
        ("after", &["line 14: ", "a step after its end"]),
        ("fewer", &["run1.jsonl", "evaluation.json does not list this episode"]),
        ("valid", &["recorded as valid, but the last answer contradicts the record"]),
    ] {
        let message = text(&run(home.path(), &["report", results, "--out", "report"], 2).stderr);
        for part in words {
            assert!(message.contains(part), "{results}: no `{part}` in: {message}");
        }
        for rust in ["Some(", "Ongoing", "StepLimit"] {
            assert!(!message.contains(rust), "{message}");
        }
        assert!(results == "fewer" || message.contains("--resume"), "{message}");
    }
}

/// An episode without its last line counts as before, because its steps show how it ended. Without its last steps,
/// the episode does not count, and the report states this.
#[test]
fn unfinished_episodes_are_reported() {
    let home = tempfile::tempdir().unwrap();
    let log = "episodes/lanterns-lvl1-run0.jsonl";
    let cut = |lines: usize| {
        move |content: Vec<u8>| {
            let text = String::from_utf8(content).unwrap();
            let kept: Vec<&str> = text.lines().collect();
            (kept[..kept.len() - lines].join("\n") + "\n").into_bytes()
        }
    };
    play(home.path(), "random", "whole");
    let whole = summary(home.path(), "whole");
    tampered(home.path(), "endless", log, cut(1));
    let endless = summary(home.path(), "endless");
    assert_eq!(endless["players"], whole["players"]);
    assert_eq!((&endless["episodes"], &endless["ended"]), (&4.into(), &4.into()));
    tampered(home.path(), "halted", log, |content| {
        let text = String::from_utf8(content).unwrap();
        let (before, _) = text.trim_end().rsplit_once('\n').unwrap();
        let halt = "{\"event\":\"halt\",\"reason\":\"infrastructure\",\"message\":\"the wire was cut\"}";
        format!("{before}\n{halt}\n").into_bytes()
    });
    assert_eq!(summary(home.path(), "halted")["players"], whole["players"]);
    tampered(home.path(), "cut", log, cut(3));
    let cut = summary(home.path(), "cut");
    assert_eq!((&cut["episodes"], &cut["ended"]), (&4.into(), &3.into()));
    assert_eq!(cut["players"][0]["broken_off"]["interrupted"], 1);
    assert!(cut["notes"].to_string().contains("1 of 4 episodes were aborted"), "{}", cut["notes"]);
    let page = fs::read_to_string(home.path().join("report/report.md")).unwrap();
    assert!(page.contains("Excluded from all figures: 1 interrupted and not finished"), "{page}");
}

/// Names are treated as plain text in every file of a report, and the page runs only its own script.
#[test]
fn names_are_quoted_words() {
    let home = tempfile::tempdir().unwrap();
    for (folder, name) in [
        ("one", "<script>alert(1)</script>"),
        ("two", "=HYPERLINK(\"x\")"),
        ("three", "![x](y)\n# z\u{1b}[2J\u{9b}\u{202e}"),
    ] {
        tampered(home.path(), folder, "evaluation.json", |content| {
            let mut settings: Value = serde_json::from_slice(&content).unwrap();
            settings["entrant"]["name"] = name.into();
            settings["suite"] = "<img src=x>".into();
            serde_json::to_vec(&settings).unwrap()
        });
    }
    run(home.path(), &["-q", "report", "one", "two", "three", "--out", "report"], 0);
    let made = files(&home.path().join("report"));
    let markdown = text(&made["report.md"]);
    assert!(
        markdown.contains("&lt;script&gt;alert(1)&lt;/script&gt;")
            && markdown.contains("!\\[x\\](y)\\\\n# z")
    );
    for raw in ["<script", "<img", "![x]", "\n# z"] {
        assert!(!markdown.contains(raw), "{raw}");
    }
    for (name, content) in made.iter().filter(|(name, _)| !name.ends_with(".json")) {
        let content = String::from_utf8_lossy(content);
        assert!(!content.contains(['\u{1b}', '\u{9b}', '\u{202e}']), "{name}");
    }
    for (name, table) in made.iter().filter(|(name, _)| name.ends_with(".csv")) {
        let mut reader = csv::Reader::from_reader(table.as_slice());
        for record in reader.records() {
            for field in &record.unwrap() {
                let formula = field.starts_with(['=', '+', '-', '@', '\t', '\r']);
                assert!(!formula || field.parse::<f64>().is_ok(), "{name}: {field}");
            }
        }
    }
    assert!(text(&made["tables/leaderboard.csv"]).contains("'=HYPERLINK"));
    let page = text(&made["report.html"]);
    let (_, rest) = page.split_once("script-src 'nonce-").expect("a policy");
    let (nonce, policy) = rest.split_once('\'').unwrap();
    assert!(
        nonce.len() == 64 && page.contains("default-src 'none'; img-src data:; style-src 'unsafe-inline'; ")
    );
    assert!(policy.starts_with("; base-uri 'none'; form-action 'none'\">"));
    // The page's only scripts are the boards' data and the reader.
    let scripts: Vec<&str> =
        page.match_indices("<script").map(|(at, _)| page[at..].split_once('>').unwrap().0).collect();
    let own = format!("<script nonce=\"{nonce}\"");
    assert!(scripts.iter().all(|script| *script == own || *script == "<script type=\"application/json\""));
    assert_eq!(scripts.iter().filter(|script| **script == own).count(), 1);
    for handler in ["onclick=", "onload=", "onerror=", "javascript:"] {
        assert!(!page.contains(handler), "{handler}");
    }
}
