//! Tests of `arcade serve-player`, and of other people's agents under `arcade evaluate`, as users run them.

use crate::arcade::{arcade, run, text};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};

#[test]
fn served_players_print_their_address() {
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
    stream.write_all(b"GET /v1/models HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").unwrap();
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

/// Returns the lines of the only log in a results folder.
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
fn external_agents_play_and_resume() {
    let folder = tempfile::tempdir().unwrap();
    // The agent exits after three answers. After the resume it does not, because past turns count.
    fs::write(
        folder.path().join("agent.sh"),
        "n=0; while read line; do case $line in *'\"past\":true'*) n=9;; *'\"type\":\"turn\"'*) n=$((n+1)); \
         [ $n = 4 ] && { echo tired >&2; exit 7; }; echo '{\"action\":\"left\"}';; esac; done\n",
    )
    .unwrap();
    let player = "cmd:sh agent.sh";
    let failed = run(folder.path(), &evaluate(player, &[]), 3);
    let message = text(&failed.stderr);
    assert!(
        message.contains("exited at step 3 (exit status: 7); the end of its standard error: tired"),
        "{message}"
    );
    run(folder.path(), &evaluate(player, &["--resume"]), 0);
    let log = log(&folder.path().join("results"));
    let steps = log.iter().filter(|event| event["event"] == "step");
    let actions: Vec<&Value> = steps.map(|event| &event["action"]).collect();
    assert_eq!(actions, vec!["left"; 6]);
    let malformed = run(folder.path(), &evaluate("cmd:sh 'agent.sh", &["--resume"]), 2);
    assert!(text(&malformed.stderr).contains("is not a command line"), "{}", text(&malformed.stderr));
}

/// An evaluation without a usable answer ends with a message.
#[test]
fn unusable_answers_are_counted_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let script = "while read line; do case $line in *'\"type\":\"turn\"'*|*'\"type\":\"invalid\"'*) \
                  echo '{\"action\":\"fly\"}';; esac; done\n";
    fs::write(folder.path().join("agent.sh"), script).unwrap();
    let played = run(folder.path(), &evaluate("cmd:sh agent.sh", &["--json"]), 0);
    let tally = &serde_json::from_slice::<Value>(&played.stdout).unwrap()["tally"];
    assert_eq!((&tally["steps"], &tally["unusable"]), (&6.into(), &6.into()));
    let told = text(&played.stderr);
    assert!(told.contains("6 of 6 decisions have no usable answer"), "{told}");
    // Resuming an evaluation that has already ended also ends with a message.
    let again = run(folder.path(), &evaluate("cmd:sh agent.sh", &["--resume"]), 0);
    assert!(
        text(&again.stderr).contains("6 of 6 decisions have no usable answer"),
        "{}",
        text(&again.stderr)
    );
    fs::remove_dir_all(folder.path().join("results")).unwrap();
    fs::write(folder.path().join("agent.sh"), script.replace("fly", "left")).unwrap();
    let usable = run(folder.path(), &evaluate("cmd:sh agent.sh", &[]), 0);
    assert!(!text(&usable.stderr).contains("usable"), "{}", text(&usable.stderr));
}

/// An agent that answers three times, and then waits for a file `go`. It has child processes, one of which
/// leaves the group and the session, and ignores termination signals.
#[cfg(target_os = "linux")]
const STUBBORN: &str = "trap '' TERM HUP INT QUIT\nsetsid sleep 600 & echo $! > $1/setsid\nsleep 600 & echo $! > $1/child\n\
     pwd > $1/folder\nn=0\nwhile read line; do case $line in *'\"past\":true'*) n=$((n+1));; *'\"type\":\"turn\"'*) n=$((n+1))\n\
     [ $n -gt 3 ] && [ ! -e $1/go ] && { echo $$ > $1/shell; sleep 600; }\necho '{\"action\":\"left\"}';; esac; done\nexec sleep 600\n";

/// Returns `true` if a signal has its default effect. Tests started in the background may ignore it.
#[cfg(target_os = "linux")]
fn is_heeded(signal: u32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & (1 << (signal - 1)) == 0
}

/// Waits until a condition holds, for about twenty seconds.
#[cfg(target_os = "linux")]
#[track_caller]
fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    for _ in 0..1000 {
        if is_so() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    panic!("{what}: never");
}

/// Returns `true` if a process has exited, even if it is still in the process table.
#[cfg(target_os = "linux")]
fn is_gone(pid: &str) -> bool {
    fs::read_to_string(format!("/proc/{pid}/stat")).map_or(true, |stat| stat.contains(") Z "))
}

/// However `arcade` ends, the player, its processes and its folder are removed, and `--resume` continues the
/// evaluation.
#[cfg(target_os = "linux")]
#[test]
fn players_end_with_arcade() {
    let check = |name: &str, signal: u32| {
        let home = tempfile::tempdir().unwrap();
        fs::write(home.path().join("agent.sh"), STUBBORN).unwrap();
        let player = format!("cmd:sh agent.sh {}", home.path().display());
        let command = || {
            let mut command = arcade(home.path());
            command.args(evaluate(&player, &[])).stdout(Stdio::null()).stderr(Stdio::piped());
            command
        };
        let child = command().spawn().unwrap();
        let said =
            |name: &str| fs::read_to_string(home.path().join(name)).unwrap_or_default().trim().to_owned();
        wait_until("the player waits", || !said("shell").is_empty());
        let [folder, shell, setsid, own] = ["folder", "shell", "setsid", "child"].map(said);
        assert!(Path::new(&folder).exists() && ![&shell, &setsid, &own].into_iter().any(|pid| is_gone(pid)));
        Command::new("kill").args(["-s", name, &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        let told = text(&output.stderr);
        if name == "KILL" {
            assert_eq!(output.status.code(), None);
        } else {
            assert_eq!(output.status.code(), Some(128 + i32::try_from(signal).unwrap()), "{name}: {told}");
            assert!(told.contains("interrupted") && told.contains("--resume"), "{name}: {told}");
        }
        for pid in [&shell, &setsid, &own] {
            wait_until(&format!("{name}: process {pid} is gone"), || is_gone(pid));
        }
        wait_until(&format!("{name}: the folder is gone"), || !Path::new(&folder).exists());
        fs::write(home.path().join("go"), "").unwrap();
        let resumed = command().arg("--resume").output().unwrap();
        assert_eq!(resumed.status.code(), Some(0), "{name}: {}", text(&resumed.stderr));
        let log = log(&home.path().join("results"));
        let events: Vec<&str> = log.iter().map(|event| event["event"].as_str().unwrap()).collect();
        assert_eq!(events, ["start", "step", "step", "step", "step", "step", "step", "end"], "{name}");
    };
    // The players wait most of the time.
    std::thread::scope(|scope| {
        for (name, signal) in [("INT", 2), ("TERM", 15), ("HUP", 1), ("QUIT", 3), ("KILL", 9)] {
            if is_heeded(signal) {
                scope.spawn(move || check(name, signal));
            }
        }
    });
}

/// At the end of an episode, all of its player's processes are gone, regardless of their group.
#[cfg(target_os = "linux")]
#[test]
fn detached_processes_end_with_the_episode() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("agent.sh"), STUBBORN).unwrap();
    fs::write(home.path().join("go"), "").unwrap();
    run(home.path(), &evaluate(&format!("cmd:sh agent.sh {}", home.path().display()), &[]), 0);
    let said = |name: &str| fs::read_to_string(home.path().join(name)).unwrap().trim().to_owned();
    // The guard ends last, and it has already ended.
    assert!(is_gone(&said("setsid")) && is_gone(&said("child")));
    assert!(!Path::new(&said("folder")).exists());
}

/// A program that does not exist is a malformed question, and leaves no files.
#[cfg(unix)]
#[test]
fn misspelt_programs_are_reported_before_writing() {
    use std::os::unix::fs::PermissionsExt;
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("agent.sh"), "exit 1\n").unwrap();
    for (player, words) in [
        ("cmd:./agnet.sh", "there is no file `./agnet.sh`; did you mean `./agent.sh`?"),
        ("cmd:sh agnet.sh", "there is no file `agnet.sh`; did you mean `agent.sh`?"),
        ("cmd:agent.sh", "write `./agent.sh` for the file in this folder"),
        ("cmd:no-such-program-anywhere", "there is no program `no-such-program-anywhere` in PATH"),
    ] {
        for more in [&[][..], &["--resume"], &["--dry-run"]] {
            let told = text(&run(home.path(), &evaluate(player, more), 2).stderr);
            assert!(told.contains(words), "{told}");
        }
        assert!(!home.path().join("results").exists());
    }
    // A failure that only the operating system can detect is still reported.
    fs::write(home.path().join("broken"), "\u{1}").unwrap();
    fs::set_permissions(home.path().join("broken"), fs::Permissions::from_mode(0o755)).unwrap();
    let told = text(&run(home.path(), &evaluate("cmd:./broken", &[]), 3).stderr);
    assert!(told.contains("`./broken` cannot be started: ") && !told.contains("player-guard"), "{told}");
}

#[test]
#[allow(clippy::print_stdout, reason = "a skipped test says so")]
fn the_example_in_the_page_plays() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("SKIPPED: no python3");
        return;
    }
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/how-to/agents.md"))
        .unwrap();
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
