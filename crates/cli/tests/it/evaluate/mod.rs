//! Tests of `arcade evaluate` as users run it, with built-in players, and with a model behind a server that
//! misbehaves. Evaluations are also killed and resumed.

mod servers;

use crate::arcade::{arcade, copy_of_tiny, files, run, sweeping, text};
use crate::server::{ReceivedRequest, Response, Server};
use base::Digest;
use evaluation::log::{Event, ReplyClass, read, without_times};
use evaluation::player::Validity;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

/// A deterministic model. Equal prompts get equal answers, some of which are unusable.
fn answer(_: usize, asked: &ReceivedRequest) -> Response {
    let messages = &asked.json()["messages"];
    let draw = Digest::of(messages.to_string().as_bytes()).to_string().as_bytes()[0] % 6;
    let words =
        ["ACTION: left", "ACTION: right", "ACTION: use", "I cannot say.", "I cannot see.", "I cannot."];
    Response::completion(words[usize::from(draw)])
}

/// Returns the logs in a results folder, with all times removed.
fn logs(folder: &Path) -> BTreeMap<String, Vec<Event>> {
    let names = files(&folder.join("episodes")).into_keys();
    let timeless = |name: &String| {
        let events = read(&folder.join("episodes").join(name)).unwrap();
        events.iter().map(without_times).collect()
    };
    names.map(|name| (name.clone(), timeless(&name))).collect()
}

fn json(output: &std::process::Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

const STEPS: &str = "12";

/// Returns the arguments for evaluating a model on two small levels.
fn asking<'a>(url: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec!["--json", "evaluate", "hailglass", "--levels", "0,1", "--model", "scripted"];
    args.extend(["--base-url", url, "--max-steps", STEPS, "--out", "results"]);
    args.extend(more);
    args
}

#[test]
fn built_in_players() {
    let home = tempfile::tempdir().unwrap();
    let args = ["--json", "evaluate", "hailglass", "--levels", "0", "--max-steps", "20", "--runs", "2"];
    let with = |player: &str, out: &str| {
        let more = ["--player", player, "--out", out];
        json(&run(home.path(), &[&args[..], &more].concat(), 0))
    };
    let played = with("mcts:20", "mcts");
    assert_eq!((&played["entrant"]["name"], &played["tally"]["ended"]), (&"mcts:20".into(), &2.into()));
    let idle = run(home.path(), &[&args[..], &["--player", "nil", "--out", "nil"]].concat(), 0);
    assert_eq!(json(&idle)["entrant"]["name"], "do-nothing");
    assert!(
        text(&idle.stderr).contains("2 episodes reached the limit of 20 steps"),
        "{}",
        text(&idle.stderr)
    );
    let log = read(&home.path().join("nil/episodes/hailglass-lvl0-run1.jsonl")).unwrap();
    assert!(matches!(log.last(), Some(Event::End { steps: 20, .. })));
    let played = with("random", "one");
    let again = with("random", "two");
    assert_eq!(played["tally"], again["tally"]);
    assert_eq!(logs(&home.path().join("one")), logs(&home.path().join("two")));
}

/// A commitment is part of the player's name, of the log, and of the data that `--resume` compares.
#[test]
fn players_commit_to_plans() {
    let home = tempfile::tempdir().unwrap();
    let args =
        ["--json", "evaluate", "hailglass", "--levels", "0", "--max-steps", "7", "--player", "mcts:20"];
    let with = |more: &[&str], status: i32| run(home.path(), &[&args[..], more].concat(), status);
    let played = json(&with(&["--commit", "3", "--out", "plans"], 0));
    assert_eq!(played["entrant"]["aids"], serde_json::json!(["commit=3"]));
    let log = read(&home.path().join("plans/episodes/hailglass-lvl0-run0.jsonl")).unwrap();
    let plans = log.iter().filter_map(|event| match event {
        Event::Plan { step, actions, .. } => Some((*step, actions.len())),
        _ => None,
    });
    assert_eq!(plans.collect::<Vec<_>>(), [(0, 3), (3, 3), (6, 1)]);
    let other = with(&["--commit", "all", "--out", "plans", "--resume"], 2);
    assert!(text(&other.stderr).contains("was started with a different --commit"), "{}", text(&other.stderr));
    let none = with(&["--commit", "0", "--out", "none"], 2);
    assert!(
        text(&none.stderr).contains("`0` isn't a valid number of actions to commit to"),
        "{}",
        text(&none.stderr)
    );
    let report = run(home.path(), &["report", "plans", "--out", "report"], 0);
    assert!(text(&report.stdout).contains("mcts:20 (commit=3)"), "{}", text(&report.stdout));
}

/// A budget of thought is part of the player's name, and of the data that `--resume` compares. Two budgets give a thinking
/// horizon.
#[cfg(unix)]
#[test]
fn budgets_of_thought_are_reported() {
    let home = tempfile::tempdir().unwrap();
    // The program wins only if it may use 100 tokens: it walks along the first level of the game in the folder.
    let script = "while read line; do case $line in *'\"type\":\"turn\"'*) echo '{\"action\":\"right\",\"output_tokens\":60}';; esac; done";
    let player = format!("cmd:sh -c {}", shlex::try_quote(script).unwrap());
    let game = "BasicGame\n  SpriteSet\n    goal > Door\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n  InteractionSet\n    avatar wall > stepBack\n    goal avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=goal win=True\n";
    std::fs::write(home.path().join("hall.vgdl"), game).unwrap();
    std::fs::write(home.path().join("hall_lvl0.txt"), "wwwwwww\nwA   gw\nwwwwwww\n").unwrap();
    let evaluate = |tokens: &'static str, more: &[&str], status| {
        let args = [
            "--json",
            "evaluate",
            "hall.vgdl",
            "--max-steps",
            "6",
            "--player",
            &player,
            "--max-output-tokens",
            tokens,
        ];
        run(home.path(), &[&args, more].concat(), status)
    };
    let won = json(&evaluate("100", &["--out", "wide"], 0));
    assert_eq!(
        (&won["entrant"]["aids"], &won["tally"]["won"]),
        (&serde_json::json!(["max-output-tokens=100"]), &1.into())
    );
    assert_eq!(json(&evaluate("50", &["--out", "narrow"], 0))["tally"]["won"], 0);
    let other = evaluate("70", &["--out", "wide", "--resume"], 2);
    assert!(text(&other.stderr).contains("different"), "{}", text(&other.stderr));
    run(home.path(), &["report", "wide", "narrow", "--out", "report"], 0);
    let report = std::fs::read_to_string(home.path().join("report/report.md")).unwrap();
    assert!(report.contains("50: 0%, 100: 100%") && report.contains("50: –, 100: 240"), "{report}");
    assert!(
        std::fs::read_to_string(home.path().join("report/report.html"))
            .unwrap()
            .contains("How much players must think")
    );
}

/// A person at a terminal sees the same prompts as a model, and may leave in the middle of an episode.
#[test]
fn human_players_resume() {
    use std::io::Write;
    let home = tempfile::tempdir().unwrap();
    let args = ["evaluate", "hailglass", "--levels", "0", "--player", "human", "--max-steps", "3"];
    let sit = |typed: &str, more: &[&str]| {
        let mut command = arcade(home.path());
        command.args(args).args(["--out", "me"]).args(more);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        child.stdin.take().unwrap().write_all(typed.as_bytes()).unwrap();
        child.wait_with_output().unwrap()
    };
    let left = sit("left\nfly\n", &[]);
    assert_eq!(left.status.code(), Some(1));
    let shown = text(&left.stderr);
    assert!(
        shown.contains("You win when no drifter and no squall is left.")
            && shown.contains("`fly` isn't one of")
    );
    let ended = sit("right\nnil\n", &["--resume"]);
    assert_eq!(ended.status.code(), Some(0), "{}", text(&ended.stderr));
    let ending = "## End\nThe limit of 3 actions was reached before the game was over, which is not a win.";
    assert!(text(&ended.stderr).contains(ending), "{}", text(&ended.stderr));
    let log = read(&home.path().join("me/episodes/hailglass-lvl0-run0.jsonl")).unwrap();
    let actions: Vec<String> = log
        .iter()
        .filter_map(|event| match event {
            Event::Step { action, .. } => Some(action.to_string()),
            _ => None,
        })
        .collect();
    assert_eq!(actions, ["left", "right", "nil"]);
}

#[test]
fn malformed_requests_are_reported() {
    let home = tempfile::tempdir().unwrap();
    let refusal = |args: &[&str]| {
        let output = run(home.path(), &[&["evaluate"], args].concat(), 2);
        text(&output.stderr)
    };
    for (args, words) in [
        (&["hailglas", "--player", "random"][..], "did you mean the corpus game `hailglass`?"),
        (&["hailglass", "--player", "mtcs"], "did you mean `mcts`?"),
        (&["hailglass"], "--player"),
        (&["hailglass"], "--model"),
        (&["corpus", "--player", "random", "--games", "jars"], "did you mean `quiet-jars`?"),
        (&["corpus", "--player", "random", "--games", "zzzz"], "the games are belfry-sling, "),
        (&["hailglass", "--player", "random", "--runs", "1000000000"], "1000000000 is not in 1..=1000000"),
        (
            &["hailglass", "--player", "random", "--max-steps", "18446744073709551615"],
            "18446744073709551615 is not in 1..=1000000",
        ),
        (&["hailglass", "--player", "random", "--jobs", "0"], "at least 1"),
        (&["hailglass", "--player", "random", "--levels", "9"], "no level to play"),
        (&["hailglass", "--player", "random", "--games", "hailgas"], "did you mean `hailglass`?"),
        (&["hailglass", "hailglass", "--player", "random"], "two games have the id `hailglass`"),
        (&["hailglass", "--player", "random", "--runs", "0"], "0 is not in 1..=1000000"),
        (&["hailglass", "--player", "replay:no.json"], "no.json: there is no such file"),
        (&["hailglass", "--model", "gpt"], "openai:"),
        (
            &["hailglass", "--model", "openai:m", "--with", "grid", "--without", "grid"],
            "both --with and --without",
        ),
        (&["hailglass", "--model", "openai:m", "--player", "random"], "cannot be used with"),
        (&["hailglass", "--model", "openai:m", "--temperature", "nan"], "a number from 0 to 2"),
        (&["hailglass", "--model", "openai:m", "--temperature", "-1"], "a number from 0 to 2"),
        (&["hailglass", "--model", "openai:m", "--top-p", "7"], "a number from 0 to 1"),
        (&["hailglass", "--model", "openai:m", "--max-output-tokens", "0"], "at least 1"),
        (&["hailglass", "--model", "openai:m", "--tries", "0"], "at least 1"),
        (&["hailglass", "--model", "openai:m", "--prices", "nope.toml"], "nope.toml: there is no such file"),
        (&["hailglass", "--model", "openai:m", "--jobs", "3"], "--concurrency"),
        (&["hailglass", "--model", "m", "--base-url", "http://127.0.0.1:99999/v1"], "from 1 to 65535"),
        (&["hailglass", "--player", "random", "--timeout", "0"], "0 is not in 1.."),
        (&["hailglass", "--player", "random", "--tries", "2"], "--tries applies only to language models"),
        (
            &["hailglass", "--player", "mcts", "--timeout", "9"],
            "--timeout applies only to language models (--model) and",
        ),
        (
            &["hailglass", "--player", "random", "--max-output-tokens", "5"],
            "--max-output-tokens applies only to language models (--model), mailboxes and programs",
        ),
        (
            &["hailglass", "--model", "anthropic:m", "--max-output-tokens", "50", "--reasoning-effort", "50"],
            "--reasoning-effort 50 leaves no tokens for the answer",
        ),
        (
            &["hailglass", "--player", "random", "--max-cost", "5"],
            "--max-cost applies only to language models",
        ),
        (&["hailglass", "--player", "random", "--temperature", "1"], "remove it for the player `random`"),
        (&["hailglass", "--player", "random", "--with", "image"], "remove them for the player `random`"),
        (
            &["hailglass", "--player", "random", "--resume", "--out", "nothere"],
            "nothing to resume in nothere",
        ),
    ] {
        let told = refusal(args);
        assert!(told.contains(words), "{args:?}: {told}");
    }
    std::fs::write(home.path().join("alone.vgdl"), "BasicGame\n").unwrap();
    assert!(refusal(&["alone.vgdl", "--player", "random"]).contains("pass level files after it"));
    assert!(refusal(&["alnoe.vgdl", "--player", "random"]).contains("did you mean `alone.vgdl`?"));
    let pasted = refusal(&["hailglass", "--model", "openai:m", "--key-variable", "sk-SECRET123"]);
    assert!(pasted.contains("takes the name") && !pasted.contains("SECRET"), "{pasted}");
    std::fs::create_dir(home.path().join("full")).unwrap();
    std::fs::write(home.path().join("full/mine"), "").unwrap();
    let full = refusal(&["hailglass", "--player", "random", "--out", "full"]);
    assert!(full.contains("not empty") && !full.contains("pass --resume"), "{full}");
    // Nothing is written before there is a key.
    let mut keyless = arcade(home.path());
    keyless.args(["evaluate", "hailglass", "--model", "openai:m", "--out", "k"]).env_remove("OPENAI_API_KEY");
    let told = keyless.output().unwrap();
    assert_eq!(told.status.code(), Some(2));
    assert!(text(&told.stderr).contains("OPENAI_API_KEY is not set") && !home.path().join("k").exists());
    // The folder holds the results of a different evaluation.
    run(home.path(), &["evaluate", "hailglass", "--levels", "0", "--player", "random", "--out", "r"], 0);
    let other = ["hailglass", "--levels", "0", "--player", "nil", "--out", "r", "--resume"];
    assert!(refusal(&other).contains("a different player, model, prompt or decoding"));
    assert!(refusal(&["hailglass", "--player", "nil", "--out", "r"]).contains("not empty"));
}

/// `--resume` rejects logs that a report would reject.
#[test]
fn edited_logs_are_not_certified() {
    let home = tempfile::tempdir().unwrap();
    let args =
        ["evaluate", "hailglass", "--levels", "0,1", "--max-steps", "9", "--player", "random", "--out", "r"];
    run(home.path(), &args, 0);
    let resume = [&args[..], &["--resume"]].concat();
    run(home.path(), &resume, 0);
    let log = |level: usize| home.path().join(format!("r/episodes/hailglass-lvl{level}-run0.jsonl"));
    let sound = std::fs::read_to_string(log(0)).unwrap();
    let (steps, end) = sound.trim_end().rsplit_once('\n').unwrap();
    let mut claimed: Value = serde_json::from_str(end).unwrap();
    claimed["outcome"] = "won".into();
    let (first, rest) = sound.split_once('\n').unwrap();
    let (_, rest) = rest.split_once('\n').unwrap();
    for changed in [
        format!("{steps}\n{claimed}\n"),
        format!("{first}\n{rest}"),
        std::fs::read_to_string(log(1)).unwrap(),
    ] {
        std::fs::write(log(0), &changed).unwrap();
        let told = text(&run(home.path(), &resume, 2).stderr);
        assert!(told.contains("hailglass-lvl0-run0.jsonl: line ") && told.contains("remove it"), "{told}");
    }
    std::fs::remove_file(log(0)).unwrap();
    run(home.path(), &resume, 0);
    assert_eq!(logs(&home.path().join("r")).len(), 2);
}

/// Each planner may be specified only once, and the answer is not lost if its table cannot be written.
#[test]
fn runs_are_refused_before_they_are_played() {
    let home = tempfile::tempdir().unwrap();
    let refused = |more: &[&str]| {
        text(
            &run(home.path(), &[&["run", "hailglass", "--runs", "1", "--max-ticks", "3"], more].concat(), 2)
                .stderr,
        )
    };
    let told = refused(&["--planner", "random,random"]);
    assert!(told.contains("`random` and `random` are the same player"), "{told}");
    let told = refused(&["--planner", "mcts,mcts:20", "--budget", "20"]);
    assert!(told.contains("`mcts` and `mcts:20` are the same player"), "{told}");
    let told = refused(&["--planner", "random", "--csv", "nope/x.csv"]);
    assert!(told.contains("its folder does not exist") && !told.contains("episodes"), "{told}");
}

/// A request for more concurrent episodes than there are episodes is reported and reduced.
#[test]
fn concurrency_is_bounded_by_episodes() {
    let home = tempfile::tempdir().unwrap();
    let args = ["evaluate", "hailglass", "--levels", "0,1", "--max-steps", "3", "--player", "random"];
    let output = run(home.path(), &[&args[..], &["--jobs", "5000", "--out", "r"]].concat(), 0);
    let told = text(&output.stderr);
    assert!(told.contains("--jobs 5000") && told.contains("2 run at the same time"), "{told}");
}

#[test]
fn archives_are_played_like_folders() {
    let home = tempfile::tempdir().unwrap();
    let release = |args: &[&str]| run(home.path(), args, 0);
    release(&["release", "tiny", "--out", "tiny", "-q"]);
    release(&["export", "tiny", "--format", "archive", "--out", "tiny.tar.zst"]);
    let play = |subject: &str, out: &str| {
        let args = ["--json", "evaluate", subject, "--player", "random", "--max-steps", "5", "--out", out];
        json(&run(home.path(), &args, 0))["tally"].clone()
    };
    assert_eq!(play("tiny.tar.zst", "one"), play("tiny", "two"));
    assert!(files(&home.path().join("one/games")) == files(&home.path().join("two/games")));
    let settings =
        |out: &str| std::fs::read_to_string(home.path().join(out).join("evaluation.json")).unwrap();
    assert_eq!(settings("one"), settings("two"));
    assert!(settings("two").contains("\"kind\": \""), "the kinds of the release are recorded");
    let mut bytes = std::fs::read(home.path().join("tiny.tar.zst")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(home.path().join("bad.tar.zst"), bytes).unwrap();
    std::fs::write(home.path().join("none.tar.zst"), "hello").unwrap();
    for name in ["bad.tar.zst", "none.tar.zst"] {
        let output = run(home.path(), &["evaluate", name, "--player", "random", "--out", "three"], 2);
        assert!(text(&output.stderr).contains(name) && !home.path().join("three").exists());
    }
}

/// A game that the engine stops in its first tick, because its PathChaser has no `obs=`.
const STOPPED: &str = "BasicGame\n SpriteSet\n  ghost > PathChaser stype=hero\n  gem > Immovable\n  hero > MovingAvatar\n \
                       LevelMapping\n  G > ghost\n  g > gem\n  H > hero\n InteractionSet\n  gem hero > killSprite\n \
                       TerminationSet\n  SpriteCounter stype=gem win=True\n";

/// Episodes that the engine stops are not counted as losses of the players. Every table states this, with the
/// reason.
#[test]
fn episodes_stopped_by_the_engine_are_reported() {
    let home = tempfile::tempdir().unwrap();
    let game = home.path().join("halted");
    std::fs::create_dir(&game).unwrap();
    std::fs::write(game.join("game.vgdl"), STOPPED).unwrap();
    std::fs::write(game.join("lvl0.txt"), "H g\n  G\n").unwrap();
    let why = "a path was requested in a game without `obs=`";
    let play = ["run", "halted", "--planner", "random", "--runs", "3"];
    let told = text(&run(home.path(), &play, 1).stdout);
    assert!(told.contains(&format!("the engine stopped 3 of 3 episodes: {why}")), "{told}");
    assert!(told.contains("arcade validate halted"), "{told}");
    let told = json(&run(home.path(), &[&["--json"], &play[..]].concat(), 1));
    assert_eq!((&told["rows"][0]["stopped"], &told["stopped"][0]["reason"]), (&3.into(), &why.into()));
    let asked = ["evaluate", "halted", "--player", "random", "--runs", "2", "--out", "r"];
    let told = text(&run(home.path(), &asked, 1).stdout);
    assert!(told.contains(&format!("halted: the engine stopped 2 episodes: {why}")), "{told}");
    let again = json(&run(home.path(), &[&["--json"], &asked[..], &["--resume"]].concat(), 1));
    assert_eq!(again["tally"]["stopped"][0]["episodes"], 2);
    let told = run(home.path(), &["report", "r", "--out", "report"], 0);
    assert!(text(&told.stderr).contains(&format!("2 episodes were stopped by the engine in halted ({why})")));
    let page = std::fs::read_to_string(home.path().join("report/report.md")).unwrap();
    assert!(page.contains("was stopped by the engine: a path was requested"), "{page}");
    // A report replaces no existing files, and the printed advice works.
    let told = text(&run(home.path(), &["report", "r", "--out", "report"], 2).stderr);
    assert!(told.contains("`report` is not empty") && told.contains("--out report-2"), "{told}");
    let told = text(&run(home.path(), &[&asked[..], &["--resume"]].concat(), 1).stdout);
    assert!(told.contains("next: arcade report r --out report-2"), "{told}");
}

/// Requests that cannot work are rejected before a folder is written, and the printed advice works.
#[test]
fn players_that_cannot_read_the_prompt_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let args = ["evaluate", "quiet-jars", "hailglass", "--levels", "0", "--max-steps", "2"];
    let with = |more: &[&str], status| {
        let player = ["--player", "planner:mcts:10", "--out", "r"];
        text(&run(home.path(), &[&args[..], &player, more].concat(), status).stderr)
    };
    let told = with(&[], 2);
    assert!(told.contains("--rules vgdl") && !home.path().join("r").exists(), "{told}");
    let told = with(&["--rules", "vgdl"], 2);
    assert!(told.contains("the player can play 1 of 2 games: pass --games quiet-jars"), "{told}");
    assert!(!home.path().join("r").exists());
    with(&["--rules", "vgdl", "--games", "quiet-jars"], 0);
}

/// A step limit below a release's known wins is reported before anything is paid for, and again in the
/// report.
#[test]
fn limits_below_known_wins_are_told() {
    let (home, _) = copy_of_tiny();
    let folder = home.path();
    std::fs::create_dir(folder.join("releases")).unwrap();
    std::fs::rename(folder.join("tiny"), folder.join("releases/tiny")).unwrap();
    let told = text(&run(folder, &["evaluate", "tiny", "--player", "random"], 2).stderr);
    assert!(told.contains("did you mean `releases/tiny`?"), "{told}");
    let args = ["evaluate", "releases/tiny", "--player", "random", "--max-steps", "1", "--out", "r"];
    let told = text(&run(folder, &[&args[..], &["--dry-run"]].concat(), 0).stdout);
    assert!(told.contains("levels have no known win within 1 step;"), "{told}");
    let told = text(&run(folder, &args, 0).stderr);
    assert!(told.contains("have no known win within 1 step;"), "{told}");
    let told = text(&run(folder, &["report", "r", "--out", "report"], 0).stderr);
    assert!(told.contains("random: ") && told.contains("have no known win within 1 step;"), "{told}");
    let page = std::fs::read_to_string(folder.join("report/report.md")).unwrap();
    assert!(page.contains("Cite this result as: Infinite Arcade, release tiny, root "), "{page}");
    let long = run(folder, &["evaluate", "releases/tiny", "--player", "random", "--dry-run"], 0);
    assert!(!text(&long.stdout).contains("no known win"));
}

/// A folder may have any name.
#[cfg(target_os = "linux")]
#[test]
fn results_and_reports_in_non_utf8_folders() {
    use std::os::unix::ffi::OsStrExt;
    let home = tempfile::tempdir().unwrap();
    let name = |bytes: &[u8]| std::ffi::OsStr::from_bytes(bytes).to_owned();
    for (flags, resume) in [(&[][..], None), (&["--json"], Some("--resume"))] {
        let (results, report) = (name(b"r\xff"), name(b"p\xff"));
        let mut command = arcade(home.path());
        command.args(flags).args([
            "evaluate",
            "hailglass",
            "--levels",
            "0",
            "--player",
            "random",
            "--max-steps",
            "3",
        ]);
        let played = command.args(resume).arg("--out").arg(&results).output().unwrap();
        assert_eq!(played.status.code(), Some(0), "{}", text(&played.stderr));
        let mut command = arcade(home.path());
        let told =
            command.args(flags).arg("report").arg(&results).arg("--out").arg(&report).output().unwrap();
        assert_eq!(told.status.code(), Some(0), "{}", text(&told.stderr));
        std::fs::remove_dir_all(home.path().join(&report)).unwrap();
    }
}
