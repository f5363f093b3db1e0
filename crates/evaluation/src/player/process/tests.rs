use super::*;
use crate::commitment::Commitment;
use crate::subject::{Subject, SubjectFacts};
use crate::turn::{Before, Played};
use base::MessagePath;
use base::Seed;
use engine::{Observation, Outcome, State};
use rustix::process::{Pid, test_kill_process};
use serde_json::Value;

const GAME: &str = "BasicGame\n  SpriteSet\n    goal > Door\n    coin > Resource limit=2\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    c > coin\n  InteractionSet\n    avatar wall > stepBack\n    coin avatar > collectResource scoreChange=1\n    goal avatar > killSprite scoreChange=2\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    Timeout limit=90\n";
const LEVEL: &str = "wwwwww\nwA c w\nw   gw\nwwwwww\n";

/// An episode on a small board, with a script as the player.
struct Board {
    subject: Subject,
    state: State,
    before: Option<(Observation, Action, f64)>,
    number: u64,
    commit: Commitment,
    agent: Process,
    journal: Journal,
}

impl Board {
    /// Starts an episode with a `sh` script as the player, and with a time limit for the script's answers.
    fn with(script: &str, timeout: Duration) -> Board {
        Board::playing(GAME, script, timeout)
    }

    fn playing(source: &str, script: &str, timeout: Duration) -> Board {
        // Only the reference engine accepts a shooting avatar that shoots nothing.
        let facts = SubjectFacts { as_reference: true, ..SubjectFacts::default() };
        let subject = Subject::read("board", source, &[(0, LEVEL.to_owned(), None)], facts).unwrap();
        let state = subject.game.start(&subject.levels[0].level, Seed::from_text("board"));
        let config = ProcessConfig { timeout, ..ProcessConfig::default() };
        let command = shlex::try_join(["sh", "-c", script]).unwrap();
        let agent = Process::new(&command, config).unwrap();
        let commit = Commitment::ONE;
        Board { subject, state, before: None, number: 0, commit, agent, journal: Journal::in_memory() }
    }

    fn of(script: &str) -> Board {
        Board::with(script, Duration::from_secs(60))
    }

    fn turn<T>(&mut self, use_it: impl FnOnce(&mut Process, &mut Journal, &Turn<'_>) -> T) -> T {
        let observation = self.subject.game.observe(&self.state);
        let actions: Vec<Action> =
            [Action::Nil].iter().chain(self.subject.game.actions(&self.state)).copied().collect();
        let before = self.before.as_ref();
        let played = before.map(|(_, action, reward)| Played {
            asked: *action,
            is_unavailable: false,
            avatar: None,
            reward: *reward,
        });
        let turn = Turn {
            subject: &self.subject,
            level: 0,
            number: self.number,
            limit: 30,
            commit: self.commit,
            played: played.as_slice(),
            observation: &observation,
            before: before.map(|(observation, action, reward)| Before {
                observation,
                action: *action,
                reward: *reward,
            }),
            actions: &actions,
            series: None,
            cause: None,
        };
        use_it(&mut self.agent, &mut self.journal, &turn)
    }

    fn play(&mut self, action: Action) {
        let (observation, score) = (self.subject.game.observe(&self.state), self.state.score());
        self.subject.game.step(&mut self.state, action);
        self.before = Some((observation, action, self.state.score() - score));
        self.number += 1;
    }

    /// Requests one decision and plays it.
    fn decide(&mut self) -> Result<Choice, Halt> {
        let choice = self.turn(|agent, journal, turn| agent.act(turn, journal))?;
        self.play(choice.action(0));
        Ok(choice)
    }

    /// Recalls a previously played decision.
    fn recall(&mut self, action: Action) {
        let choice = Choice::of(action);
        self.turn(|agent, journal, turn| agent.recall(turn, journal, &choice)).unwrap();
        self.play(action);
    }

    fn end(&mut self) {
        self.turn(|agent, _, turn| agent.end(turn));
    }

    fn failure(&mut self) -> String {
        match self.decide() {
            Err(Halt::Infrastructure(message)) => message,
            other => panic!("{other:?}"),
        }
    }
}

/// Reads the messages that a script has copied to a file.
fn heard(path: &std::path::Path) -> Vec<Value> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn an_episode_is_played_in_lines() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("heard");
    let mut board = Board::of(&format!(
        "tee {} | while read line; do case $line in *'\"type\":\"turn\"'*) echo '{{\"action\":\"right\"}}';; esac; done",
        log.in_message()
    ));
    for _ in 0..2 {
        assert_eq!(board.decide(), Ok(Choice::of(Action::Right)));
    }
    board.end();
    assert_eq!(board.journal.events(), []);
    let heard = heard(&log);
    assert_eq!(heard.len(), 4);
    let hello = &heard[0];
    assert_eq!((&hello["type"], &hello["protocol"]), (&"hello".into(), &1.into()));
    assert_eq!((&hello["columns"], &hello["rows"], &hello["step_limit"]), (&6.into(), &4.into(), &30.into()));
    assert!(hello["rules"].as_str().unwrap().contains("You win when no goal is left."));
    assert!(!hello["rules"].as_str().unwrap().contains("characters"));
    // The step limit is reached before the game's Timeout.
    assert!(hello["rules"].as_str().unwrap().contains("Play stops at tick 30"));
    assert!(!hello["rules"].as_str().unwrap().contains("tick 90"));
    assert_eq!(hello["legend"]["w"], serde_json::json!(["wall"]));
    let turn = &heard[2];
    assert_eq!((&turn["turn"], &turn["tick"], &turn["score"]), (&1.into(), &1.into(), &0.0.into()));
    assert_eq!(turn["grid"], serde_json::json!(["wwwwww", "w.@c.w", "w...gw", "wwwwww"]));
    assert_eq!(turn["sprites"][1], serde_json::json!({"name": "coin", "cells": [[3, 1]]}));
    assert_eq!(
        turn["avatar"],
        serde_json::json!({"name": "avatar", "health": 0, "cell": [2, 1], "facing": null})
    );
    let end = &heard[3];
    assert_eq!((&end["type"], &end["outcome"], &end["turn"]), (&"end".into(), &"ongoing".into(), &2.into()));
    assert_eq!(
        (&end["reward"], &end["score"], &end["resources"]["coin"]),
        (&1.0.into(), &1.0.into(), &1.into())
    );
    for secret in ["seed", "hash", "level", "source"] {
        assert!(heard.iter().all(|message| message.get(secret).is_none()), "{secret}");
    }
}

/// As in model prompts, the use key is not offered to an avatar that could shoot but has nothing to shoot.
#[test]
fn the_use_key_is_offered_where_it_does_something() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("heard");
    let script = format!(
        "tee {} | while read line; do case $line in *turn*|*invalid*) echo '{{\"action\":\"use\"}}';; esac; done",
        log.in_message()
    );
    let keys = |avatar: &str, choice: Choice| {
        let source = GAME.replace("MovingAvatar", avatar);
        let mut board = Board::playing(&source, &script, Duration::from_secs(60));
        assert_eq!(board.decide(), Ok(choice), "{avatar}");
        board.end();
        let heard = heard(&log);
        assert_eq!(heard[0]["actions"], heard[1]["actions"]);
        heard[1]["actions"].clone()
    };
    let all = serde_json::json!(["nil", "left", "right", "use"]);
    assert_eq!(keys("FlakAvatar stype=coin", Choice::of(Action::Use)), all);
    let without = serde_json::json!(["nil", "left", "right"]);
    assert_eq!(keys("FlakAvatar", Choice::nothing(Validity::Invalid)), without);
}

#[test]
fn directions_of_movers_are_sent() {
    let source = GAME.replace("    coin >", "    bird > Missile orientation=LEFT\n    coin >");
    let source = source.replace("    c > coin", "    c > coin\n    b > bird");
    let subject = Subject::read("board", &source, &[(0, "Abg\n".to_owned(), None)], SubjectFacts::default());
    let subject = subject.unwrap();
    let state = subject.game.start(&subject.levels[0].level, Seed::from_text("board"));
    let observation = subject.game.observe(&state);
    let seen = serde_json::to_value(Seen::of(&observation, Vec::new(), Some(0.0))).unwrap();
    let bird = serde_json::json!([{"name": "bird", "cell": [1, 0], "facing": "left"}]);
    assert_eq!(seen["movers"], bird);
}

#[test]
fn past_turns_are_sent_without_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("heard");
    // The script answers only messages that are not marked as past.
    let mut board = Board::of(&format!(
        "tee {} | while read line; do case $line in *'\"past\":true'*|*hello*|*'\"end\"'*) ;; *) echo '{{\"action\":\"down\"}}';; esac; done",
        log.in_message()
    ));
    board.recall(Action::Right);
    board.recall(Action::Nil);
    assert_eq!(board.decide().map(|choice| choice.action(0)), Ok(Action::Down));
    board.end();
    let heard = heard(&log);
    let told =
        |at: usize| (heard[at]["turn"].clone(), heard[at]["past"].clone(), heard[at]["action"].clone());
    assert_eq!(told(1), (0.into(), true.into(), "right".into()));
    assert_eq!(told(2), (1.into(), true.into(), "nil".into()));
    assert_eq!(told(3), (2.into(), Value::Null, Value::Null));
}

#[test]
fn a_wrong_answer_is_asked_again_once() {
    // The first answer is invalid, and the answer after the `invalid` message is valid. Later, two answers
    // are invalid.
    let mut board = Board::of(
        "read hello; read turn; echo '{\"action\":\"jump\"}'; read invalid; echo \"$invalid\" >&2; echo '{\"action\":\"left\"}'; \
         read turn; echo hm; read invalid; echo '{\"act\":\"left\"}'; read turn; exit 3",
    );
    assert_eq!(board.decide(), Ok(Choice::of(Action::Left)));
    assert_eq!(board.decide(), Ok(Choice::nothing(Validity::Invalid)));
    let wrong = |event: &Event| match event {
        Event::Reply(reply) => (reply.step, reply.attempt, reply.class, reply.text.clone()),
        other => panic!("{other:?}"),
    };
    let wrong: Vec<_> = board.journal.events().iter().map(wrong).collect();
    let invalid = ReplyClass::Invalid;
    let texts = ["{\"action\":\"jump\"}", "hm", "{\"act\":\"left\"}"].map(str::to_owned);
    let [first, second, third] = texts;
    assert_eq!(wrong, [(0, 0, invalid, first), (1, 0, invalid, second), (1, 1, invalid, third)]);
    let message = board.failure();
    assert!(message.contains("exited at step 2") && message.contains("exit status: 3"), "{message}");
    assert!(
        message.contains("the action `jump` is not available now; available: nil, up, left, down, right"),
        "{message}"
    );
}

/// An answer that states its turn is never used for a different turn.
#[test]
fn late_answers_are_skipped() {
    let mut board = Board::of(
        "read hello; read turn; echo '{\"turn\":0,\"action\":\"up\"}'; echo '{\"turn\":0,\"action\":\"up\"}'; read turn; \
         echo '{\"turn\":1,\"action\":\"right\"}'; read end",
    );
    assert_eq!(board.decide().map(|choice| choice.action(0)), Ok(Action::Up));
    assert_eq!(board.decide().map(|choice| choice.action(0)), Ok(Action::Right));
}

/// An answer to a later turn is invalid, because accepting it would put all further answers out of sync.
#[test]
fn answers_to_future_turns_are_invalid() {
    let mut board = Board::of(
        "read hello; read turn; echo '{\"turn\":5,\"action\":\"up\"}'; read invalid; echo \"$invalid\" >&2; \
         echo '{\"turn\":0,\"action\":\"left\"}'; read turn; exit 3",
    );
    assert_eq!(board.decide().map(|choice| choice.action(0)), Ok(Action::Left));
    let message = board.failure();
    assert!(message.contains("this answers turn 5, but the current turn is 0"), "{message}");
}

/// Answers to earlier turns neither restart the timeout nor use unlimited memory.
#[test]
fn late_answers_do_not_extend_the_timeout() {
    let begin = "read hello; read turn; echo '{\"turn\":0,\"action\":\"up\"}'; read turn; ";
    let mut slow = Board::with(
        &format!(
            "{begin} for n in 1 2 3 4 5 6 7 8 9 10; do echo '{{\"turn\":0,\"action\":\"up\"}}'; sleep 0.3; done; \
             echo '{{\"turn\":1,\"action\":\"up\"}}'; exec sleep 600"
        ),
        Duration::from_millis(900),
    );
    slow.decide().unwrap();
    let message = slow.failure();
    assert!(message.contains("did not answer at step 1 within 0.9 s"), "{message}");
    let mut endless = Board::of(&format!("{begin} exec yes '{{\"turn\":0,\"action\":\"up\"}}'"));
    endless.decide().unwrap();
    let message = endless.failure();
    assert!(
        message.contains("more than 1024 KiB of outdated answers (to earlier steps) at step 1"),
        "{message}"
    );
}

/// The user is notified before the timeout that the agent ignores `invalid` messages.
#[test]
fn silence_after_an_invalid_answer_is_reported() {
    let script = "read hello; read turn; echo '{\"action\":\"fly\"}'; exec sleep 600";
    let mut board = Board::with(script, Duration::from_millis(600));
    let shown = Arc::new(std::sync::Mutex::new(Vec::new()));
    let notices = shown.clone();
    let agent = std::mem::replace(&mut board.agent, Process::new("x", ProcessConfig::default()).unwrap());
    board.agent = agent.with_notices(Arc::new(move |words| notices.lock().unwrap().push(words.to_owned())));
    let message = board.failure();
    let refused = "did not answer at step 0 within 0.6 s after its answer was rejected as `invalid`";
    assert!(message.contains(refused), "{message}");
    let shown = shown.lock().unwrap();
    assert_eq!(shown.len(), 1, "{shown:?}");
    assert!(shown[0].contains("has not answered since its answer at step 0 was rejected"), "{shown:?}");
    // No notice is shown if the answer arrives in time.
    let mut prompt = Board::of(
        "read hello; read turn; echo '{\"action\":\"fly\"}'; read invalid; echo '{\"action\":\"up\"}'; exec sleep 600",
    );
    let agent = std::mem::replace(&mut prompt.agent, Process::new("x", ProcessConfig::default()).unwrap());
    prompt.agent = agent.with_notices(Arc::new(|words| panic!("{words}")));
    assert_eq!(prompt.decide().map(|choice| choice.action(0)), Ok(Action::Up));
}

#[test]
fn failures_are_reported_with_the_end_of_stderr() {
    let check = |script: &str, timeout: Duration, expected: &[&str]| {
        let message = Board::with(script, timeout).failure();
        assert!(expected.iter().all(|words| message.contains(words)), "{script}: {message}");
    };
    let (soon, late) = (Duration::from_millis(300), Duration::from_secs(60));
    check("echo no such module >&2; exit 1", late, &["exited at step 0 (exit status: 1)", "no such module"]);
    check(
        "read hello; exec sleep 600",
        soon,
        &["did not answer at step 0 within 0.3 s", "its standard error is empty"],
    );
    check("yes | tr -d '\\n'; echo over >&2", late, &["a line of more than 1024 KiB"]);
    check("kill -9 $$", late, &["exited"]);
}

#[test]
fn a_missing_program_stops_the_evaluation() {
    let mut board = Board::of("true");
    board.agent = Process::new("no-such-program-anywhere x", ProcessConfig::default()).unwrap();
    assert!(
        matches!(board.decide(), Err(Halt::Rejected(message)) if message.contains("no-such-program-anywhere"))
    );
    for command in ["", "  ", "python3 'agent.py"] {
        assert!(Process::new(command, ProcessConfig::default()).is_err(), "{command}");
    }
}

#[test]
fn processes_and_folders_are_removed() {
    // The process's child survives the end of its parent's input, and is killed together with the process.
    let folder = tempfile::tempdir().unwrap();
    let pid = folder.path().join("pid");
    let mut board = Board::of(&format!(
        "sleep 600 & echo $! > {}; ls -A >&2; while read line; do echo '{{\"action\":\"nil\"}}'; done; exec sleep 600",
        pid.in_message()
    ));
    board.decide().unwrap();
    let process = &board.agent.running.as_ref().unwrap().process;
    let (own, path) = (process.id(), process.folder().to_owned());
    assert_eq!(std::fs::read_dir(&path).unwrap().count(), 0);
    let child = std::fs::read_to_string(&pid).unwrap().trim().parse().unwrap();
    board.end();
    assert!(!path.exists());
    let gone = |id: i32| test_kill_process(Pid::from_raw(id).unwrap()).is_err();
    assert!(gone(own.cast_signed()));
    // At this point, the child is orphaned, and the process that adopts it may need a moment to reap it.
    let dead = || {
        let status = std::fs::read_to_string(format!("/proc/{child}/stat")).unwrap_or_default();
        gone(child) || status.contains(") Z ")
    };
    for _ in 0..200 {
        if dead() {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("process {child} has outlived its parent");
}

#[test]
fn the_environment_is_small() {
    let mut board = Board::of("env >&2; pwd >&2; exit 0");
    let message = board.failure();
    let (variable, value) = std::env::vars_os()
        .map(|(name, value)| (name.into_string().unwrap_or_default(), value))
        .find(|(name, _)| name.starts_with("CARGO_"))
        .expect("tests are run by cargo");
    assert!(!message.contains(&format!("{variable}=")), "{message} {value:?}");
    assert!(message.contains("PATH=") && message.contains("arcade-player-"), "{message}");
}

#[test]
fn outcomes_are_sent() {
    let mut board = Board::of("while read line; do echo '{\"action\":\"right\"}'; done");
    let path: Vec<Action> = [Action::Right; 3].into_iter().chain([Action::Down]).collect();
    path.into_iter().for_each(|action| board.play(action));
    assert_eq!(board.state.outcome(), Outcome::Won);
    board.end();
}

#[test]
fn programs_commit_to_plans() {
    let mut board = Board::of(
        r#"read hello; case "$hello" in *'"commit":"3"'*) ;; *) exit 1;; esac
        read turn; echo '{"actions": ["right", "right", "jump"]}'
        read again; echo '{"actions": ["right", "right", "down", "down"]}'
        read turn; case "$turn" in *'"played":[{"action":"right"'*) echo '{"action": "up"}';; esac
        read again; echo '{"actions": []}'"#,
    );
    board.commit = "3".parse().unwrap();
    assert_eq!(board.decide(), Ok(Choice::plan(vec![Action::Right, Action::Right, Action::Down])));
    assert_eq!(board.decide(), Ok(Choice::plan(Vec::new())));
    let wrong = |event: &Event| matches!(event, Event::Reply(reply) if reply.class == ReplyClass::Invalid);
    assert_eq!(board.journal.events().iter().filter(|event| wrong(event)).count(), 2);
}

/// A program learns the limit from the first message, and states its tokens or its reasoning in its answers.
#[test]
fn programs_report_their_thought() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("heard");
    let answers = [
        r#"{"action":"right","output_tokens":10}"#,
        r#"{"action":"right","output_tokens":11}"#,
        r#"{"action":"right","reasoning":"go to the right"}"#,
        r#"{"action":"right"}"#,
    ];
    let cases: String = answers
        .iter()
        .zip(0..)
        .map(|(answer, turn)| format!("*'\"turn\":{turn},'*) echo '{answer}';; "))
        .collect();
    let script = format!("tee {} | while read line; do case $line in {cases}esac; done", log.in_message());
    let mut board = Board::of(&script);
    let agent = std::mem::replace(&mut board.agent, Process::new("true", ProcessConfig::default()).unwrap());
    board.agent = agent.with_max_output_tokens(Some(10));
    let right = || Choice::of(Action::Right);
    let none = Choice::nothing(Validity::Truncated);
    for expect in [right(), none, right(), right()] {
        assert_eq!(board.decide(), Ok(expect));
    }
    let replies: Vec<_> = board
        .journal
        .events()
        .iter()
        .filter_map(|event| match event {
            Event::Reply(reply) => Some((reply.class, reply.usage.output_tokens, reply.reasoning.clone())),
            _ => None,
        })
        .collect();
    assert_eq!(
        replies,
        [
            (ReplyClass::Strict, Some(10), None),
            (ReplyClass::Truncated, Some(11), None),
            (ReplyClass::Strict, None, Some("go to the right".to_owned())),
        ]
    );
    assert_eq!(heard(&log)[0]["max_output_tokens"], 10);
}

/// A count that is not a number does not make an answer unlimited.
#[test]
fn a_wrong_count_is_a_wrong_answer() {
    let wrong = r#"{"action":"right","output_tokens":"9"}"#;
    let right = r#"{"action":"right","output_tokens":9}"#;
    let mut board =
        Board::of(&format!("read hello; read turn; echo '{wrong}'; read invalid; echo '{right}'; read turn"));
    assert_eq!(board.decide(), Ok(Choice::of(Action::Right)));
    let replies = board.journal.events().iter().filter_map(|event| match event {
        Event::Reply(reply) => Some((reply.class, reply.usage.output_tokens)),
        _ => None,
    });
    let expect = [(ReplyClass::Invalid, None), (ReplyClass::Strict, Some(9))];
    assert_eq!(replies.collect::<Vec<_>>(), expect);
}
