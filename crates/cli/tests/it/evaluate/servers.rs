//! `arcade evaluate` with a model behind a server that misbehaves. Evaluations are also killed and resumed.

use super::*;

#[test]
fn model_answers_are_recorded_and_counted() {
    let server = Server::start(answer);
    for mode in ["zero-shot", "contextual"] {
        let home = tempfile::tempdir().unwrap();
        let played = json(&run(home.path(), &asking(&server.base_url(), &["--mode", mode]), 0));
        assert_eq!(played["entrant"]["mode"], mode);
        let (mut steps, mut replies, mut invalid) = (0, 0, 0);
        for event in logs(&home.path().join("results")).into_values().flatten() {
            match event {
                Event::Step { validity, .. } => {
                    steps += 1;
                    invalid += u64::from(validity == Validity::Invalid);
                }
                Event::Reply(reply) => {
                    replies += 1;
                    assert_eq!(reply.class == ReplyClass::Invalid, reply.text.starts_with("I cannot"));
                    assert_eq!(reply.usage.input_tokens, Some(100));
                }
                _ => {}
            }
        }
        assert_eq!(played["spent"]["requests"], replies);
        assert_eq!(played["spent"]["tokens"], replies * 110);
        assert!(
            replies > steps && invalid > 0,
            "{mode}: {replies} replies, {steps} steps, {invalid} invalid"
        );
    }
}

/// Evaluations are killed at many moments and resumed. Their logs equal those of an undisturbed run, and no
/// recorded answer is requested again.
#[test]
fn killed_evaluations_lose_nothing() {
    let slow = |number: usize, asked: &ReceivedRequest| {
        std::thread::sleep(Duration::from_millis(3));
        answer(number, asked)
    };
    let home = tempfile::tempdir().unwrap();
    let (whole, broken) = (home.path().join("whole"), home.path().join("broken"));
    std::fs::create_dir_all(&whole).unwrap();
    std::fs::create_dir_all(&broken).unwrap();
    let undisturbed = Server::start(slow);
    let more = ["--mode", "contextual", "--concurrency", "2", "--runs", "2"];
    let spent = json(&run(&whole, &asking(&undisturbed.base_url(), &more), 0))["spent"].clone();

    let server = Server::start(slow);
    let url = server.base_url();
    let kills = if sweeping() { 20 } else { 8 };
    for kill in 0..kills {
        let mut command = arcade(&broken);
        // Nothing can be resumed before the folder exists.
        command
            .args(asking(&url, &more))
            .args((kill > 0).then_some("--resume"))
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        let answered = server.received().len();
        // The moment depends on progress, so that runs on slow machines are killed at the same points.
        while server.received().len() < answered + 1 + kill % 7 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(kill as u64 % 5));
        let _ = child.kill();
        child.wait().unwrap();
    }
    let done = json(&run(&broken, &asking(&url, &[&more[..], &["--resume"]].concat()), 0));
    assert_eq!(logs(&broken.join("results")), logs(&whole.join("results")));
    assert_eq!(done["spent"], spent);
    // Only the requests in progress at a kill were repeated.
    let (asked, needed) = (server.received().len(), undisturbed.received().len());
    assert!(asked <= needed + 2 * kills, "{asked} requests for {needed} answers");
}

/// An evaluation of a model without a single usable answer stops, unless the user insists. An evaluation with
/// too few usable answers gets a warning.
#[test]
fn useless_answers_stop_the_evaluation() {
    let server = Server::start(|_, _| Response::completion("I would rather not."));
    let home = tempfile::tempdir().unwrap();
    let url = server.base_url();
    let long = ["--runs", "2", "--concurrency", "1", "--reasks", "0"];
    let stopped = run(home.path(), &asking(&url, &long), 1);
    assert_eq!(server.received().len(), 20);
    let tally = &json(&stopped)["tally"];
    assert_eq!((&tally["steps"], &tally["invalid"], &tally["ended"]), (&20.into(), &20.into(), &1.into()));
    let halted = "the evaluation was stopped because 20 of 20 decisions have no usable answer (20 invalid); the logs contain the answers";
    assert_eq!((&tally["halted"], &tally["infrastructure"]), (&halted.into(), &false.into()));
    let told = text(&stopped.stderr);
    assert!(
        told.contains("no answer is usable, so no more requests are sent; --resume --keep-going continues"),
        "{told}"
    );
    // It may be mended, or not.
    run(home.path(), &asking(&url, &[&long[..], &["--resume"]].concat()), 1);
    assert_eq!(server.received().len(), 40);
    let ended = run(home.path(), &asking(&url, &[&long[..], &["--resume", "--keep-going"]].concat()), 0);
    assert_eq!(server.received().len(), 48);
    assert_eq!(json(&ended)["tally"]["invalid"], 48);

    let server = Server::start(|number, _| {
        Response::completion(if number % 3 == 0 { "I cannot say." } else { "ACTION: left" })
    });
    let home = tempfile::tempdir().unwrap();
    let warned = run(home.path(), &asking(&server.base_url(), &long), 0);
    let told = text(&warned.stderr);
    assert!(told.starts_with("warning: 7 of 20 decisions have no usable answer (7 invalid)"), "{told}");
    assert!(told.contains("warning: 16 of 48 decisions have no usable answer (16 invalid)"), "{told}");
}

/// Server failures are not the model's fault: the episode stays open, no step is lost, and `--resume`
/// continues the episode.
#[test]
fn failing_servers_leave_episodes_open() {
    let bad: [fn() -> Response; 5] = [
        || Response::reply(429, "slow down"),
        || Response::reply(500, "oops"),
        || Response::Cut(Vec::new()),
        || Response::reply(200, ""),
        || Response::reply(200, "<html>not now</html>"),
    ];
    let once = ["--tries", "1", "--concurrency", "1"];
    let server = Server::start(answer);
    let undisturbed = tempfile::tempdir().unwrap();
    run(undisturbed.path(), &asking(&server.base_url(), &once), 0);
    for (kind, act) in bad.into_iter().enumerate() {
        let home = tempfile::tempdir().unwrap();
        let failing =
            Server::start(move |number, asked| if number < 5 { answer(number, asked) } else { act() });
        let output = run(home.path(), &asking(&failing.base_url(), &once), 3);
        assert!(text(&output.stderr).contains("with --resume"), "{kind}: {}", text(&output.stderr));
        let open = logs(&home.path().join("results"));
        let halts = open
            .values()
            .flatten()
            .filter(|event| matches!(event, Event::Halt { reason, .. } if reason == "infrastructure"));
        assert!(halts.count() >= 1, "{kind}");
        drop(failing);
        // The server is back on a different port. The address does not affect the answers of a model on this
        // machine.
        let server = Server::start(answer);
        let url = server.base_url();
        let again = [&once[..], &["--resume"]].concat();
        let resumed = asking(&url, &again);
        let played = json(&run(home.path(), &resumed, 0));
        assert_eq!(played["tally"]["open"], 0);
        let without_halts = |folder: &Path| {
            let mut logs = logs(&folder.join("results"));
            logs.values_mut().for_each(|log| log.retain(|event| !matches!(event, Event::Halt { .. })));
            logs
        };
        assert_eq!(without_halts(home.path()), without_halts(undisturbed.path()), "{kind}");
    }
}

/// If no server is running, the evaluation ends at once, and can be continued when the server runs.
#[test]
fn an_absent_server_is_reported_at_once() {
    let server = Server::start(answer);
    let url = server.base_url();
    drop(server);
    let home = tempfile::tempdir().unwrap();
    let told = text(&run(home.path(), &asking(&url, &[]), 3).stderr);
    let host = url.trim_start_matches("http://").trim_end_matches("/v1");
    let expect = format!(
        "error: 2 episodes are unfinished; continue with --resume: no server answers at {host} (connection refused); \
         is it running?\n"
    );
    assert_eq!(told, expect);
    let server = Server::start(answer);
    let played = json(&run(home.path(), &asking(&server.base_url(), &["--resume"]), 0));
    assert_eq!((&played["tally"]["open"], &played["tally"]["ended"]), (&0.into(), &2.into()));
}

/// A failed attempt is reported before the evaluation ends, also if standard error is not a terminal.
#[test]
fn failed_attempts_are_reported() {
    let server = Server::start(|number, asked| match number {
        0 => Response::reply(500, "oops"),
        _ => answer(number, asked),
    });
    let home = tempfile::tempdir().unwrap();
    let told = text(&run(home.path(), &asking(&server.base_url(), &["--concurrency", "1"]), 0).stderr);
    assert!(told.contains("failed (500: oops); it is tried up to 8 times"), "{told}");
}

#[test]
fn caps_hold_and_can_be_raised() {
    let server = Server::start(answer);
    let home = tempfile::tempdir().unwrap();
    let url = server.base_url();
    let capped = json(&run(home.path(), &asking(&url, &["--max-requests", "7"]), 1));
    assert_eq!(capped["spent"]["requests"], 7);
    assert_eq!(server.received().len(), 7);
    // All counts of open episodes agree, even if several episodes reach the cap at once.
    assert_eq!(capped["tally"]["halted"], "the next request would exceed --max-requests 7");
    let told = json(&run(home.path(), &["--json", "report", "results", "--out", "capped"], 0));
    let player = &told["players"][0];
    assert_eq!((&player["spending"]["requests"], &player["spending"]["replies"]), (&7.into(), &7.into()));
    let again = asking(&url, &["--max-requests", "7", "--resume"]);
    let again: Vec<&str> = again.into_iter().filter(|arg| *arg != "--json").collect();
    let told = text(&run(home.path(), &again, 1).stdout);
    assert!(
        told.contains("exceed --max-requests 7; continue with --resume and a higher --max-requests"),
        "{told}"
    );
    let done = json(&run(home.path(), &asking(&url, &["--max-requests", "1000", "--resume"]), 0));
    assert_eq!(done["spent"]["requests"], server.received().len());
    assert_eq!(done["tally"]["open"], 0);
}

#[test]
fn dry_runs_send_nothing_and_print_the_forecast() {
    let server = Server::start(answer);
    let home = tempfile::tempdir().unwrap();
    let forecast = json(&run(home.path(), &asking(&server.base_url(), &["--dry-run"]), 0));
    assert_eq!((&forecast["episodes"], &forecast["requests"]), (&2.into(), &24.into()));
    assert!(forecast["input_tokens"].as_u64().unwrap() > 24 * 300);
    // The planned evaluation, and one with the same number of episodes on as many games.
    assert_eq!(forecast["power"].as_array().unwrap().len(), 2);
    assert_eq!((&forecast["answer_tokens"], &forecast["max_output_tokens"]), (&100.into(), &Value::Null));
    let url = server.base_url();
    let bounded = asking(&url, &["--dry-run", "--max-output-tokens", "4000"]);
    let forecast = json(&run(home.path(), &bounded, 0));
    assert_eq!((&forecast["output_tokens"], &forecast["max_output_tokens"]), (&2400.into(), &96_000.into()));
    let said = text(&run(home.path(), &bounded[1..], 0).stdout);
    assert!(said.contains("assuming 100 tokens per answer; at most 0.10 M"), "{said}");
    // A game's Timeout bounds the steps, regardless of --max-steps.
    let unbounded =
        ["--json", "evaluate", "hailglass", "--levels", "0", "--model", "openai:gpt-4o", "--dry-run"];
    assert_eq!(json(&run(home.path(), &unbounded, 0))["requests"], 401);
    let unpaid = ["--json", "evaluate", "hailglass", "--levels", "0,1", "--player", "random", "--dry-run"];
    let forecast = json(&run(home.path(), &unpaid, 0));
    assert_eq!((&forecast["max_steps"], &forecast["steps"]), (&401.into(), &802.into()));
    assert!(server.received().is_empty() && !home.path().join("results").exists());
}

/// An impossible token count from a server neither exhausts a cap nor corrupts a sum.
#[test]
fn impossible_token_counts_are_rejected() {
    let body = r#"{"choices":[{"message":{"content":"ACTION: left"},"finish_reason":"stop"}],
        "usage":{"prompt_tokens":18446744073709551615,"completion_tokens":18446744073709551615}}"#;
    let server = Server::start(move |_, _| Response::reply(200, body));
    let home = tempfile::tempdir().unwrap();
    let played = json(&run(home.path(), &asking(&server.base_url(), &["--max-tokens", "1000000"]), 0));
    assert!(played["spent"]["tokens"].as_u64().unwrap() < 1_000_000, "{played}");
    assert_eq!(played["spent"]["cost"], Value::Null, "its price is not known");
    // Older results may hold such counts.
    let log = home.path().join("results/episodes/hailglass-lvl0-run0.jsonl");
    let before = std::fs::read_to_string(&log).unwrap();
    let huge = before.replace("\"input_tokens\":null", "\"input_tokens\":18446744073709551615");
    assert_ne!(before, huge);
    std::fs::write(&log, huge).unwrap();
    run(home.path(), &["report", "results", "--out", "told"], 0);
}

/// A wrong model name leaves no results folder behind, because the evaluation could never be resumed.
#[test]
fn rejected_models_leave_no_results() {
    let home = tempfile::tempdir().unwrap();
    let server = Server::start(|_, _| Response::reply(404, "{\"error\": \"no such model\"}"));
    let told = text(&run(home.path(), &asking(&server.base_url(), &[]), 3).stderr);
    assert!(told.contains("no results folder was kept") && told.contains("check the model name"), "{told}");
    assert!(!home.path().join("results").exists());
    let server = Server::start(answer);
    run(home.path(), &asking(&server.base_url(), &[]), 0);
    assert!(home.path().join("results").exists());
}

/// A game that the server rejects is left open, and the other games are played.
#[test]
fn games_that_a_server_rejects_do_not_end_the_run() {
    let home = tempfile::tempdir().unwrap();
    let server = Server::start(|number, asked| match asked.body.contains("jar") {
        true => Response::reply(400, "{\"error\": \"the game is random\"}"),
        false => answer(number, asked),
    });
    let url = server.base_url();
    let args = ["evaluate", "quiet-jars", "hailglass", "--levels", "0,1", "--model", "m", "--base-url", &url];
    let more = ["--max-steps", "3", "--concurrency", "1", "--out", "r"];
    let output = run(home.path(), &[&args[..], &more].concat(), 3);
    let told = text(&output.stdout);
    assert!(told.contains("could not be evaluated on quiet-jars"), "{told}");
    assert!(told.contains("m: 2 of 4 episodes played"), "{told}");
}

#[test]
fn models_can_have_names() {
    let home = tempfile::tempdir().unwrap();
    let server = Server::start(answer);
    let told = json(&run(home.path(), &asking(&server.base_url(), &["--name", "mine"]), 0));
    assert_eq!(told["entrant"]["name"], "mine");
    let told = text(&run(home.path(), &["evaluate", "hailglass", "--limit", "5"], 2).stderr);
    assert!(told.contains("--levels, --games or --max-requests"), "{told}");
}

/// A full disk, simulated by a file size limit, is an environment failure. Once there is room again, the
/// episode continues.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_stops_and_loses_nothing() {
    let server = Server::start(answer);
    let (home, url) = (tempfile::tempdir().unwrap(), server.base_url());
    let more = ["--mode", "contextual", "--concurrency", "1"];
    let limited = |blocks: &str| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let mut command = std::process::Command::new("sh");
        command.current_dir(home.path()).args(["-c", &script, "sh", env!("CARGO_BIN_EXE_arcade")]);
        command.args(asking(&url, &more)).output().unwrap()
    };
    let full = limited("20");
    let told = text(&full.stderr);
    assert_eq!(full.status.code(), Some(3), "{told}");
    assert!(told.contains("cannot write") && told.contains("continue with --resume"), "{told}");
    let log = home.path().join("results/episodes/hailglass-lvl0-run0.jsonl");
    assert!(!matches!(read(&log).unwrap().last(), Some(Event::End { .. })));
    run(home.path(), &asking(&url, &[&more[..], &["--resume"]].concat()), 0);
    let undisturbed = tempfile::tempdir().unwrap();
    run(undisturbed.path(), &asking(&url, &more), 0);
    assert_eq!(logs(&home.path().join("results")), logs(&undisturbed.path().join("results")));
    // If not even the settings fit, nothing that looks like an evaluation is left.
    let other = tempfile::tempdir().unwrap();
    let script = "trap '' XFSZ; ulimit -f 0; exec \"$@\"";
    let mut command = std::process::Command::new("sh");
    command.current_dir(other.path()).args(["-c", script, "sh", env!("CARGO_BIN_EXE_arcade")]);
    let none = command.args(asking(&url, &more)).output().unwrap();
    assert_eq!(none.status.code(), Some(3), "{}", text(&none.stderr));
    assert!(!other.path().join("results/evaluation.json").exists());
    run(other.path(), &asking(&url, &more), 0);
}
