//! Tests of evaluations with built-in players: the files written, and interruptions, which must not affect
//! the results.

use crate::games::corridor;
use agents::Budget;
use engine::{Action, Episode, SEMANTICS};
use evaluation::log::{Status, read, without_times};
use evaluation::player::{Agent, Choice, Contestant, Replay};
use evaluation::run::{Answers, FORMAT, PlayResult, Progress, Tally, Task};
use evaluation::{
    Commitment, Entrant, Evaluation, EvaluationError, Event, Halt, Journal, Settings, Subject, Turn, Validity,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

struct Silent;

impl Progress for Silent {
    fn episode(&self, _: &Task<'_>, _: &PlayResult) {}
}

fn settings(subjects: &[Subject]) -> Settings {
    Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: "test".into(),
        snapshot: None,
        entrant: Entrant {
            name: "mcts:60".into(),
            mode: None,
            aids: Vec::new(),
            details: serde_json::Value::Null,
        },
        seed: "test".into(),
        runs: 2,
        max_steps: 25,
        commit: Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(subjects),
    }
}

fn planner(name: &str) -> Contestant {
    Contestant::Planner { spec: name.parse().unwrap(), budget: Budget(60) }
}

fn evaluate(folder: &Path) -> Tally {
    let subjects = vec![corridor()];
    let evaluation = Evaluation::create(folder, settings(&subjects), subjects).unwrap();
    evaluation.run(|_| Ok(planner("mcts")), &Silent).unwrap()
}

fn logs(folder: &Path) -> Vec<(PathBuf, Vec<Event>)> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder.join("episodes")).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let timeless = |path: PathBuf| {
        let events = read(&path).unwrap().iter().map(without_times).collect();
        (PathBuf::from(path.file_name().unwrap()), events)
    };
    paths.into_iter().map(timeless).collect()
}

#[test]
fn a_results_folder_is_enough_for_a_replay() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("results");
    let tally = evaluate(&folder);
    assert_eq!((tally.episodes, tally.ended, tally.open), (4, 4, 0));
    let evaluation = Evaluation::open(&folder).unwrap();
    for task in evaluation.tasks() {
        let events = evaluation.events(&task).unwrap();
        let Some(Event::Start { seed, game_digest, level_digest, .. }) = events.first() else { panic!() };
        let Some(Event::End { outcome, score, steps, status }) = events.last() else { panic!() };
        let (mut actions, mut hashes) = (Vec::new(), Vec::new());
        for event in &events {
            if let Event::Step { action, hash, .. } = event {
                actions.push(*action);
                hashes.push(*hash);
            }
        }
        assert_eq!(*steps, actions.len() as u64);
        let (outcome, score) = (*outcome, *score);
        let (game, level, seed) = (*game_digest, *level_digest, *seed);
        let episode = Episode { game, level, seed, actions, hashes, outcome, score, path: Vec::new() };
        let state = episode.replay(&task.subject.game, &task.level.level).unwrap();
        assert_eq!(*status == Status::Over, state.is_over());
    }
}

/// Seeds depend only on the game, level and run, so that all players get the same randomness.
#[test]
fn players_are_paired() {
    let subjects = [corridor()];
    let home = tempfile::tempdir().unwrap();
    let starts = |name: &str| {
        let folder = home.path().join(name);
        let evaluation = Evaluation::create(&folder, settings(&subjects), subjects.to_vec()).unwrap();
        evaluation.run(|_| Ok(planner(name)), &Silent).unwrap();
        logs(&folder).into_iter().map(|(_, events)| events[0].clone()).collect::<Vec<_>>()
    };
    let (random, idle) = (starts("random"), starts("do-nothing"));
    assert_eq!(random, idle);
    assert_ne!(random[0], random[1]);
}

/// A resumed evaluation produces the same logs, whatever was written before the program was killed.
#[test]
fn interrupted_evaluations_are_resumed() {
    let home = tempfile::tempdir().unwrap();
    let whole = home.path().join("whole");
    evaluate(&whole);
    let undisturbed = logs(&whole);
    let subjects = vec![corridor()];
    for (part, cut) in [0, 1, 5, 9].into_iter().enumerate() {
        let folder = home.path().join(format!("cut{part}"));
        Evaluation::create(&folder, settings(&subjects), subjects.clone()).unwrap();
        // One log is complete, one is truncated within a line, and the others do not exist.
        for (at, (name, _)) in undisturbed.iter().take(2).enumerate() {
            let bytes = fs::read(whole.join("episodes").join(name)).unwrap();
            let kept = if at == 0 { bytes.len() } else { bytes.len() * cut / 10 };
            fs::write(folder.join("episodes").join(name), &bytes[..kept]).unwrap();
        }
        let evaluation = Evaluation::resume(&folder, &settings(&subjects)).unwrap();
        let tally = evaluation.run(|_| Ok(planner("mcts")), &Silent).unwrap();
        assert_eq!(tally.ended, 4);
        assert_eq!(logs(&folder), undisturbed);
    }
}

#[test]
fn an_agents_episode_is_resumed_at_the_end_of_its_log() {
    let home = tempfile::tempdir().unwrap();
    let subjects = vec![corridor()];
    let actions = vec![Action::Right; 3];
    let agent = || {
        let level = &subjects[0].levels[1];
        let (mut episode, _) = Episode::begin(&subjects[0].game, &level.level, base::Seed::from_text("any"));
        episode.actions.clone_from(&actions);
        Contestant::Agent(Box::new(Replay::of(&episode)))
    };
    let whole = home.path().join("whole");
    let evaluation = Evaluation::create(&whole, settings(&subjects), subjects.clone()).unwrap();
    assert_eq!(evaluation.run(|_| Ok(agent()), &Silent).unwrap().won, 2);
    let undisturbed = logs(&whole);
    let bytes = fs::read(whole.join("episodes").join(&undisturbed[2].0)).unwrap();
    for cut in (0..bytes.len()).step_by(97) {
        let folder = home.path().join(format!("cut{cut}"));
        Evaluation::create(&folder, settings(&subjects), subjects.clone()).unwrap();
        fs::write(folder.join("episodes").join(&undisturbed[2].0), &bytes[..cut]).unwrap();
        let evaluation = Evaluation::resume(&folder, &settings(&subjects)).unwrap();
        evaluation.run(|_| Ok(agent()), &Silent).unwrap();
        assert_eq!(logs(&folder), undisturbed, "cut at byte {cut}");
    }
}

/// An episode aborted by the network or the server stays open, and is resumed later.
#[test]
fn environment_failures_do_not_count_against_the_player() {
    let home = tempfile::tempdir().unwrap();
    let subjects = vec![corridor()];
    let folder = home.path().join("results");
    let evaluation = Evaluation::create(&folder, settings(&subjects), subjects.clone()).unwrap();
    let down = |task: &Task<'_>| match task.level.number {
        0 => Err(Halt::Infrastructure("the server is down".into())),
        _ => Ok(planner("random")),
    };
    let tally = evaluation.run(down, &Silent).unwrap();
    assert_eq!((tally.ended, tally.open, tally.infrastructure), (2, 2, true));
    assert_eq!(tally.halted.as_deref(), Some("the server is down"));
    drop(evaluation);
    let evaluation = Evaluation::resume(&folder, &settings(&subjects)).unwrap();
    assert_eq!(evaluation.run(|_| Ok(planner("random")), &Silent).unwrap().ended, 4);
}

fn refusal(result: Result<Evaluation, EvaluationError>) -> String {
    result.expect_err("refused").to_string()
}

#[test]
fn results_folders_are_locked_and_checked() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("results");
    let subjects = vec![corridor()];
    let evaluation = Evaluation::create(&folder, settings(&subjects), subjects.clone()).unwrap();
    let again = Evaluation::create(&folder, settings(&subjects), subjects.clone());
    assert!(refusal(again).contains("pass --resume to continue"));
    let busy = Evaluation::resume(&folder, &settings(&subjects));
    assert!(refusal(busy).contains("another `arcade evaluate` is writing"));
    drop(evaluation);
    let other = Settings { runs: 7, ..settings(&subjects) };
    assert!(refusal(Evaluation::resume(&folder, &other)).contains("a different --runs"));
    assert!(refusal(Evaluation::open(home.path())).contains("this folder contains no evaluation results"));

    fs::write(folder.join("games/corridor/lvl1.txt"), "wwww\nwAew\nwwww\n").unwrap();
    assert!(
        refusal(Evaluation::open(&folder)).contains("lvl1.txt has changed since this evaluation started")
    );
    let settings_file = folder.join("evaluation.json");
    let text = fs::read_to_string(&settings_file).unwrap();
    fs::write(&settings_file, text.replace("\"corridor\"", "\"../corridor\"")).unwrap();
    assert!(refusal(Evaluation::open(&folder)).contains("is not the name of a game"));
    fs::write(&settings_file, "{}").unwrap();
    assert!(refusal(Evaluation::open(&folder)).contains("not valid evaluation settings"));
}

/// An episode is not resumed if its log does not replay, or is not a log.
#[test]
fn damaged_logs_are_reported() {
    let home = tempfile::tempdir().unwrap();
    let subjects = vec![corridor()];
    let evaluation =
        Evaluation::create(home.path().join("r").as_path(), settings(&subjects), subjects).unwrap();
    let tasks = evaluation.tasks();
    let path = home.path().join("r/episodes").join(tasks[0].file_name());
    let agent = |_: &Task<'_>| {
        let (subject, level) = (&tasks[0].subject, &tasks[0].level.level);
        let (episode, _) = Episode::begin(&subject.game, level, base::Seed::from_text("any"));
        Ok(Contestant::Agent(Box::new(Replay::of(&episode))))
    };
    evaluation.run(agent, &Silent).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let damaged: Vec<&str> = text.lines().take(4).collect();
    fs::write(&path, damaged.join("\n").replace("\"action\":\"nil\"", "\"action\":\"right\"") + "\n")
        .unwrap();
    let error = evaluation.run(agent, &Silent).unwrap_err().to_string();
    assert!(error.contains("replaying step 0 gives a result that differs from the log"), "{error}");
    fs::write(&path, "no log\n").unwrap();
    let error = evaluation.run(agent, &Silent).unwrap_err().to_string();
    assert!(error.contains(": line 1 is not an event of an episode"), "{error}");
}

/// A player that never gives a usable answer.
struct Mute;

impl Agent for Mute {
    fn act(&mut self, _: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        Ok(Choice::nothing(Validity::Invalid))
    }

    fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        Ok(())
    }
}

#[derive(Default)]
struct Stopping(Mutex<Vec<Halt>>);

impl Progress for Stopping {
    fn episode(&self, _: &Task<'_>, _: &PlayResult) {}

    fn unusable(&self, _: &Answers, is_all: bool) -> bool {
        !is_all
    }

    fn stopped(&self, halt: &Halt) {
        self.0.lock().unwrap().push(halt.clone());
    }
}

/// Stopping an evaluation also aborts episodes that are waiting for answers.
#[test]
fn a_stop_reaches_waiting_episodes() {
    let (home, subjects) = (tempfile::tempdir().unwrap(), vec![corridor()]);
    let evaluation = Evaluation::create(home.path(), settings(&subjects), subjects).unwrap();
    let progress = Stopping::default();
    let tally = evaluation.run(|_| Ok(Contestant::Agent(Box::new(Mute))), &progress).unwrap();
    let told = progress.0.into_inner().unwrap();
    assert!(
        matches!(told.first(), Some(Halt::Unusable(why)) if Some(why) == tally.halted.as_ref()),
        "{told:?}"
    );
    assert!(tally.open > 0);
}
