//! `arcade report`: files that need nothing else, the same bytes for the same results, what is said of models and of failures,
//! and clear refusals.

mod arcade;

use arcade::{files, run, text};
use engine::Action;
use evaluation::client::{Finish, Role, Usage};
use evaluation::log::{Reply, ReplyClass};
use evaluation::player::Contestant;
use evaluation::run::{FORMAT, Left, Progress, Task};
use evaluation::{
    Agent, Choice, Entrant, Evaluation, Event, Halt, Journal, Settings, Subject, SubjectFacts, Turn, Validity,
};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Carry a lamp to each lantern; moths take it away.
const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    lantern > Immovable color=YELLOW\n    moth > RandomNPC cooldown=3\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    A > avatar floor\n    l > lantern floor\n    m > moth floor\n  InteractionSet\n    avatar wall > stepBack\n    moth wall > stepBack\n    lantern avatar > killSprite scoreChange=1\n    avatar moth > killSprite\n  TerminationSet\n    SpriteCounter stype=lantern win=True\n    SpriteCounter stype=avatar win=False\n";
const LEVELS: [&str; 2] = ["wwwwww\nwA..lw\nwwwwww\n", "wwwwwww\nwA...lw\nw..m..w\nw.l...w\nwwwwwww\n"];

fn game(id: &str) -> Subject {
    let levels: Vec<_> =
        LEVELS.iter().enumerate().map(|(number, text)| (number, (*text).to_owned(), None)).collect();
    let facts = SubjectFacts { title: format!("The <{id}>"), ..SubjectFacts::default() };
    Subject::read(id, GAME, &levels, facts).unwrap()
}

/// A model that goes right and says so; every fourth answer says nothing that can be read.
struct Talker {
    /// Halts before this decision.
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
            true => Choice { action: Action::Right, validity: Validity::Valid },
            false => Choice { action: Action::Nil, validity: Validity::Invalid },
        })
    }

    fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        Ok(())
    }
}

struct Silent;

impl Progress for Silent {
    fn episode(&self, _: &Task<'_>, _: &Left) {}
}

/// Results of [`Talker`] on a game, two runs of each level.
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
        games: Evaluation::entries(&subjects),
    };
    let evaluation = Evaluation::create(folder, settings, subjects).unwrap();
    let contestant = |task: &Task<'_>| {
        let halt = halt.filter(|_| task.level.number == 1);
        Ok(Contestant::Agent(Box::new(Talker { halt })))
    };
    evaluation.run(contestant, &Silent).unwrap();
}

/// Results of a player that comes with the suite, on the same game.
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
fn a_page_tables_and_numbers_that_need_nothing_else() {
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
    assert_eq!(told["files"].as_array().unwrap().len(), made.len());

    let file = |name: &str| text(&made[name]);
    let page = file("report.html");
    for outside in ["http://", "https://", "src=\"/", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    let shown = [
        "4 players on 1 game, 2 levels",
        "2 broken off by network, server or process",
        "because no answer could be read",
        "talker (zero-shot)",
        "Zero-shot against contextual",
        "&lt;/script&gt;&lt;b&gt;what&lt;&#x2f;b&gt; &amp; why?",
        "I see a light.",
        "Board &lt;0&gt;",
        "The &lt;lanterns&gt;, level 0, run 0",
        "prefers-color-scheme: dark",
    ];
    for part in shown {
        assert!(page.replace("&#x2f;script", "/script").contains(part), "{part}");
    }
    for never in ["NaN", ">inf<", "</script><b>"] {
        assert!(!page.contains(never), "{never}");
    }
    let json: Value = serde_json::from_slice(&made["report.json"]).unwrap();
    assert_eq!(json["study"]["players"].as_array().unwrap().len(), 4);
    assert!(file("report.md").contains("| talker (zero-shot) |"));
    assert!(file("tables/leaderboard.csv").starts_with("player,"));
    assert!(file("tables/leaderboard.tex").contains("\\begin{tabular}"));
}

/// A player that does nothing on levels where nothing happens: nearly all is missing, and said to be.
#[test]
fn little_is_told_of_little() {
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
fn what_cannot_be_reported_is_refused_with_the_next_move() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    play(home.path(), "random", "random");
    talk(&at("zero"), "lanterns", "zero-shot", None);
    // The same name, other rules.
    let other = GAME.replace("scoreChange=1", "scoreChange=2");
    fs::write(at("lanterns/game.vgdl"), &other).unwrap();
    run(home.path(), &["evaluate", "lanterns", "--player", "nil", "--max-steps", "3", "--out", "other"], 0);
    // A log that is none, and one whose episode leads elsewhere.
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
        (&["lanterns"], &["lanterns", "no results of an evaluation"]),
        (&["missing"], &["missing", "no results of an evaluation"]),
        (&["random", "random"], &["random", "run 0"]),
        (&["random", "other"], &["other", "lanterns"]),
        (&["damaged"], &["lanterns-lvl0-run0.jsonl:1", "not an event"]),
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
