//! `arcade serve-player`, and agents of other people under `arcade evaluate`, as users run them.

mod arcade;

use arcade::{arcade, run, text};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};

#[test]
fn a_served_player_tells_where_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut server = arcade(folder.path())
        .args(["serve-player", "--player", "random", "-q"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(server.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let told: Value = serde_json::from_str(&line).unwrap();
    let port = told["port"].as_u64().unwrap();
    let mut reply = String::new();
    let mut stream = TcpStream::connect(("127.0.0.1", u16::try_from(port).unwrap())).unwrap();
    stream.write_all(b"GET /v1/models HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").unwrap();
    stream.read_to_string(&mut reply).unwrap();
    let taken = run(folder.path(), &["serve-player", "--player", "reflex", "--port", &port.to_string()], 3);
    server.kill().unwrap();
    server.wait().unwrap();
    assert_eq!(
        (&told["model"], &told["base_url"]),
        (&"random".into(), &format!("http://127.0.0.1:{port}/v1").into())
    );
    assert!(reply.starts_with("HTTP/1.1 200") && reply.contains("\"id\":\"random\""), "{reply}");
    assert!(text(&taken.stderr).contains(&format!("127.0.0.1:{port}")), "{}", text(&taken.stderr));
    let unknown = run(folder.path(), &["serve-player", "--player", "refex"], 2);
    assert!(text(&unknown.stderr).contains("did you mean `reflex`?"), "{}", text(&unknown.stderr));
}

/// The lines of the only log in a results folder.
fn log(results: &Path) -> Vec<Value> {
    let mut logs = fs::read_dir(results.join("episodes")).unwrap();
    let path = logs.next().unwrap().unwrap().path();
    fs::read_to_string(path).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn evaluate<'a>(player: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let fixed = [
        "evaluate",
        "quiet-jars",
        "--levels",
        "0",
        "--max-steps",
        "6",
        "--out",
        "results",
        "--player",
        player,
    ];
    fixed.into_iter().chain(more.iter().copied()).collect()
}

#[test]
fn an_agent_of_somebody_else_plays_and_is_taken_up_again() {
    let folder = tempfile::tempdir().unwrap();
    // It leaves after three answers, but not the second time: past turns count.
    fs::write(
        folder.path().join("agent.sh"),
        "n=0; while read line; do case $line in *'\"past\":true'*) n=9;; *'\"type\":\"turn\"'*) n=$((n+1)); \
         [ $n = 4 ] && { echo tired >&2; exit 7; }; echo '{\"action\":\"left\"}';; esac; done\n",
    )
    .unwrap();
    let player = "cmd:sh agent.sh";
    let failed = run(folder.path(), &evaluate(player, &[]), 3);
    let message = text(&failed.stderr);
    assert!(message.contains("has left at step 3 (exit status: 7); its last words: tired"), "{message}");
    run(folder.path(), &evaluate(player, &["--resume"]), 0);
    let log = log(&folder.path().join("results"));
    let steps = log.iter().filter(|event| event["event"] == "step");
    let actions: Vec<&Value> = steps.map(|event| &event["action"]).collect();
    assert_eq!(actions, vec!["left"; 6]);
    let malformed = run(folder.path(), &evaluate("cmd:sh 'agent.sh", &["--resume"]), 2);
    assert!(text(&malformed.stderr).contains("is no command line"), "{}", text(&malformed.stderr));
}

#[test]
#[allow(clippy::print_stdout, reason = "a skipped test says so")]
fn the_example_in_the_page_plays() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("SKIPPED: no python3");
        return;
    }
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/agents.md")).unwrap();
    let (_, example) = page.split_once("```python\n").unwrap();
    let (example, _) = example.split_once("```").unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("my_agent.py"), example).unwrap();
    run(folder.path(), &evaluate("cmd:python3 my_agent.py", &[]), 0);
    let log = log(&folder.path().join("results"));
    let steps: Vec<&Value> = log.iter().filter(|event| event["event"] == "step").collect();
    assert_eq!(steps.len(), 6);
    assert!(steps.iter().all(|step| step["validity"] == "valid"));
}
