//! Tests of mailboxes, including files that are not answers, folders that are not mailboxes, and
//! interruptions.

use crate::games::corridor;
use base::Seed;
use engine::SEMANTICS;
use evaluation::log::{read, without_times};
use evaluation::player::Contestant;
use evaluation::player::mailbox::{Delivery, Desk, MAX_ANSWER, Mailbox, MailboxPlayer, OpenPrompt};
use evaluation::prompt::{PromptSettings, Prompter};
use evaluation::run::{FORMAT, PlayResult, Progress, Tally, Task};
use evaluation::{Commitment, Entrant, Evaluation, Event, Halt, Journal, Settings, Subject, Validity};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

struct Silent;

impl Progress for Silent {
    fn episode(&self, _: &Task<'_>, _: &PlayResult) {}
}

/// Returns settings with one run of each level and at most three decisions per episode.
fn settings(subjects: &[Subject], seed: &str) -> Settings {
    Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: "test".into(),
        snapshot: None,
        entrant: Entrant {
            name: "alice".into(),
            mode: Some("zero-shot".into()),
            aids: Vec::new(),
            details: serde_json::Value::Null,
        },
        seed: seed.into(),
        runs: 1,
        max_steps: 3,
        commit: Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(subjects),
    }
}

fn open(folder: &Path, seed: &str, resume: bool) -> Result<Mailbox, String> {
    let settings = settings(&[corridor()], seed);
    Mailbox::open(folder, &settings, resume, Arc::new(|_| ())).map_err(|error| error.to_string())
}

/// Plays the second level of the corridor through the mailbox in `home`, and returns the tally and the notices.
fn play(home: &Path, resume: bool) -> (Tally, Vec<String>) {
    let mut subject = corridor();
    subject.levels.remove(0);
    let subjects = vec![subject];
    let (settings, folder) = (settings(&subjects, "test"), home.join("results"));
    let told = Arc::new(Mutex::new(Vec::new()));
    let notices = told.clone();
    let tell = move |text: &str| notices.lock().unwrap().push(text.to_owned());
    let mailbox = Mailbox::open(&home.join("box"), &settings, resume, Arc::new(tell)).unwrap();
    let mailbox = Arc::new(mailbox);
    let evaluation = match resume {
        true => Evaluation::resume(&folder, &settings).unwrap(),
        false => Evaluation::create(&folder, settings, subjects.clone()).unwrap(),
    };
    let prompter = Arc::new(Prompter::new(&subjects[0], PromptSettings::default()).unwrap());
    let player = |task: &Task<'_>| {
        let player = MailboxPlayer::new(mailbox.clone(), task, prompter.clone(), 1);
        Ok(Contestant::Agent(Box::new(player)))
    };
    let tally = evaluation.run(player, &Silent).unwrap();
    mailbox.finish(&tally).unwrap();
    let told = told.lock().unwrap().clone();
    (tally, told)
}

/// Waits until `found` returns a value for the mailbox.
fn wait<T>(home: &Path, found: impl Fn(&Desk) -> Option<T>) -> T {
    loop {
        if let Some(found) = Desk::open(&home.join("box")).ok().and_then(|desk| found(&desk)) {
            return found;
        }
        thread::sleep(Duration::from_millis(10));
    }
}

/// Waits for the prompt with the given step and attempt.
fn prompt(home: &Path, step: u64, attempt: u32) -> OpenPrompt {
    wait(home, |desk| {
        let is_it =
            |open: &OpenPrompt| (open.prompt.address.step, open.prompt.address.attempt) == (step, attempt);
        desk.view().unwrap().waiting.into_iter().find(is_it)
    })
}

fn answer(home: &Path, open: &OpenPrompt, text: &str) {
    let delivered = Desk::open(&home.join("box")).unwrap().answer(&open.prompt, text).unwrap();
    assert_eq!(delivered, Delivery::Delivered);
}

fn log(home: &Path) -> PathBuf {
    home.join("results/episodes/corridor-lvl1-run0.jsonl")
}

#[test]
fn files_that_are_no_answers_are_set_aside() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let episode = home.join("box/corridor-lvl1-run0");
    let (tally, told) = thread::scope(|scope| {
        let playing = scope.spawn(|| play(home, false));
        let first = prompt(home, 0, 0);
        let problem = || {
            wait(home, |desk| {
                let view = desk.view().unwrap();
                let problem = view.waiting.first()?.problem.clone()?;
                fs::remove_file(episode.join("problem.txt")).unwrap();
                Some(problem)
            })
        };
        let bad: [(&str, &[u8], &str); 4] = [
            ("0000-0.answer.txt", b"ACTION: \xffright", "not valid UTF-8 (at byte 8)"),
            ("0000-0.answer.txt", &vec![b'a'; MAX_ANSWER + 1], "the limit for an answer is 256 KiB"),
            ("0001-0.answer.txt", b"ACTION: right", "the file answers 0001-0, but the open prompt is 0000-0"),
            ("0000-1.answer.txt", b"ACTION: right", "the file answers 0000-1, but the open prompt is 0000-0"),
        ];
        for (name, bytes, expect) in bad {
            fs::write(home.join("whole"), bytes).unwrap();
            fs::rename(home.join("whole"), episode.join(name)).unwrap();
            let told = problem();
            assert!(told.contains(expect) && told.contains("renamed to"), "{told}");
        }
        fs::create_dir(episode.join("0000-0.answer.txt")).unwrap();
        assert!(problem().contains("not a regular file"));
        // Redirected output creates an empty file first.
        fs::write(episode.join("0000-0.answer.txt"), " \n").unwrap();
        assert_eq!(Desk::open(&home.join("box")).unwrap().view().unwrap().waiting, []);
        let desk = Desk::open(&home.join("box")).unwrap();
        assert_eq!(desk.answer(&first.prompt, "up").unwrap(), Delivery::TooLate);
        fs::write(episode.join("0000-0.answer.txt"), "ACTION: up\n").unwrap();
        let again = prompt(home, 1, 0);
        assert!(matches!(desk.answer(&again.prompt, " ").unwrap(), Delivery::Refused(_)));
        assert!(matches!(desk.answer(&again.prompt, &"a".repeat(MAX_ANSWER)).unwrap(), Delivery::Refused(_)));
        assert_eq!(desk.answer(&first.prompt, "ACTION: up").unwrap(), Delivery::TooLate);
        answer(home, &again, "I do not know.");
        let complaint = prompt(home, 1, 1);
        assert!(complaint.prompt.messages.last().unwrap().text.contains("it names no action"));
        answer(home, &complaint, "Nor now.");
        answer(home, &prompt(home, 2, 0), "ACTION: right");
        playing.join().unwrap()
    });
    assert_eq!((tally.ended, tally.answers.steps, tally.answers.unusable), (1, 3, 1));
    assert_eq!(told.len(), 5, "{told:?}");
    let view = Desk::open(&home.join("box")).unwrap().view().unwrap();
    assert_eq!((view.waiting.len(), view.ended.len()), (0, 1));
    assert_eq!(view.finished.map(|finished| (finished.episodes, finished.won)), Some((1, 0)));
    let ending = Desk::open(&home.join("box")).unwrap().ending("corridor-lvl1-run0").unwrap().unwrap();
    assert!(ending.starts_with("## End\nThe limit of 3 actions was reached"), "{ending}");
    let steps = read(&log(home)).unwrap().into_iter().filter_map(|event| match event {
        Event::Step { validity, .. } => Some(validity),
        _ => None,
    });
    assert_eq!(steps.collect::<Vec<_>>(), [Validity::Valid, Validity::Invalid, Validity::Valid]);
}

/// A killed program may leave any part of the log and any files. The final log is still the same, and no
/// answered turn is requested again.
#[test]
fn interrupted_episodes_are_resumed() {
    let whole = tempfile::tempdir().unwrap();
    let words = ["ACTION: up", "what now?", "ACTION: right", "ACTION: left"];
    let turns = [(0, 0), (1, 0), (1, 1), (2, 0)];
    thread::scope(|scope| {
        let playing = scope.spawn(|| play(whole.path(), false));
        for ((step, attempt), words) in turns.into_iter().zip(words) {
            answer(whole.path(), &prompt(whole.path(), step, attempt), words);
        }
        playing.join().unwrap();
    });
    let lines = fs::read_to_string(log(whole.path())).unwrap();
    let lines: Vec<&str> = lines.split_inclusive('\n').collect();
    let events = |home: &Path| read(&log(home)).unwrap().iter().map(without_times).collect::<Vec<_>>();
    let replies = lines.iter().enumerate().filter(|(_, line)| line.contains("\"event\":\"reply\""));
    let check = |answered: usize, kept: usize, is_written: bool| {
        let home = tempfile::tempdir().unwrap();
        let home = home.path();
        for name in ["results/games/corridor", "results/episodes", "box/corridor-lvl1-run0"] {
            fs::create_dir_all(home.join(name)).unwrap();
        }
        for name in ["evaluation.json", "games/corridor/game.vgdl", "games/corridor/lvl1.txt"] {
            let name = format!("results/{name}");
            fs::copy(whole.path().join(&name), home.join(&name)).unwrap();
        }
        fs::copy(whole.path().join("box/mailbox.json"), home.join("box/mailbox.json")).unwrap();
        fs::write(log(home), lines[..kept].concat()).unwrap();
        let (step, attempt) = turns[answered];
        if is_written {
            let name = format!("box/corridor-lvl1-run0/{step:04}-{attempt}.answer.txt");
            fs::write(home.join(name), format!("{}\n", words[answered])).unwrap();
        }
        let asked = answered + usize::from(is_written);
        thread::scope(|scope| {
            let playing = scope.spawn(|| play(home, true));
            for (&(step, attempt), words) in turns.iter().zip(words).skip(asked) {
                answer(home, &prompt(home, step, attempt), words);
            }
            let (tally, told) = playing.join().unwrap();
            assert_eq!((tally.ended, told), (1, Vec::new()));
        });
        assert_eq!(events(home), events(whole.path()));
    };
    thread::scope(|scope| {
        for (answered, (at, _)) in replies.enumerate() {
            // Either the answer was logged and its file is still present, or the answer was written but not
            // read, or the answer was not written.
            for (kept, is_written) in [(at + 1, true), (at, true), (at, false)] {
                scope.spawn(move || check(answered, kept, is_written));
            }
        }
    });
}

/// A mailbox that cannot be written aborts the episode, and `--resume` later continues it to its end.
#[test]
fn unwritable_mailboxes_leave_the_episode_open() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let episode = home.join("box/corridor-lvl1-run0");
    fs::create_dir(home.join("box")).unwrap();
    let broken = |tally: &Tally, expect: &str| {
        assert!((tally.open, tally.infrastructure) == (1, true), "{tally:?}");
        let halted = tally.halted.as_ref().unwrap();
        assert!(halted.contains(expect) && halted.contains("corridor-lvl1-run0"), "{halted}");
    };
    let removed = |resume: bool, step: u64| {
        thread::scope(|scope| {
            let playing = scope.spawn(move || play(home, resume).0);
            let open = prompt(home, step, 0);
            answer(home, &open, "ACTION: up");
            prompt(home, step + 1, 0);
            // The folder is renamed rather than removed file by file, because the player may still be writing
            // to it.
            fs::rename(&episode, home.join(format!("taken-{step}"))).unwrap();
            playing.join().unwrap()
        })
    };
    broken(&removed(false, 0), "No such file");
    fs::write(&episode, "a file").unwrap();
    broken(&play(home, true).0, "cannot create");
    fs::remove_file(&episode).unwrap();
    let tally = thread::scope(|scope| {
        let playing = scope.spawn(move || play(home, true).0);
        answer(home, &prompt(home, 1, 0), "ACTION: up");
        answer(home, &prompt(home, 2, 0), "ACTION: up");
        playing.join().unwrap()
    });
    assert_eq!((tally.ended, tally.answers.unusable), (1, 0));
}

#[test]
fn foreign_folders_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("box");
    let refused = |seed: &str, resume: bool| open(&folder, seed, resume).map(|_| ()).unwrap_err();
    assert!(Desk::open(&folder).unwrap_err().to_string().contains("there is no mailbox here"));
    fs::write(&folder, "a file").unwrap();
    assert!(refused("test", false).contains("a mailbox is a folder, but this is a file"));
    fs::remove_file(&folder).unwrap();
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("notes.txt"), "mine").unwrap();
    assert!(refused("test", false).contains("neither empty nor a mailbox"));
    fs::remove_file(folder.join("notes.txt")).unwrap();

    let first = open(&folder, "test", false).unwrap();
    assert!(refused("test", true).contains("another `arcade evaluate` is writing to this mailbox"));
    assert!(Desk::open(&folder).unwrap().view().unwrap().is_running);
    drop(first);
    assert!(!Desk::open(&folder).unwrap().view().unwrap().is_running);
    // A mailbox without an episode does not belong to any evaluation.
    drop(open(&folder, "another", false).unwrap());
    fs::create_dir(folder.join("corridor-lvl0-run0")).unwrap();
    assert!(refused("another", false).contains("continue the evaluation with --resume"));
    assert!(
        refused("test", true)
            .contains("this mailbox belongs to a different evaluation, with the player `alice`")
    );
    drop(open(&folder, "another", true).unwrap());

    let marker = fs::read_to_string(folder.join("mailbox.json")).unwrap();
    fs::write(folder.join("mailbox.json"), marker.replace("\"format\": 1", "\"format\": 2")).unwrap();
    assert!(refused("another", true).contains("the mailbox has format 2"));
    fs::write(folder.join("mailbox.json"), "{}").unwrap();
    assert!(refused("another", true).contains("not a mailbox file"));
}

/// An evaluation that stops does not wait for answers to its other episodes. The prompts of these episodes
/// stay open.
#[test]
fn waiting_episodes_give_up_when_the_evaluation_stops() {
    let home = tempfile::tempdir().unwrap();
    let (subject, folder) = (corridor(), home.path().join("box"));
    let settings = settings(&[corridor()], "test");
    let mailbox = Arc::new(Mailbox::open(&folder, &settings, false, Arc::new(|_| ())).unwrap());
    let prompter = Arc::new(Prompter::new(&subject, PromptSettings::default()).unwrap());
    let halt = Halt::Unusable("none of 20 answers is usable".to_owned());
    thread::scope(|scope| {
        let waiting = scope.spawn(|| {
            let seed = Seed::from_text("test");
            let task = Task {
                subject: &subject,
                level: &subject.levels[1],
                run: 0,
                seed,
                max_steps: 3,
                commit: Commitment::ONE,
                max_output_tokens: None,
                track: None,
                series: None,
            };
            let player = MailboxPlayer::new(mailbox.clone(), &task, prompter, 1);
            let mut journal = Journal::in_memory();
            evaluation::run::play(&task, &mut Contestant::Agent(Box::new(player)), &mut journal).unwrap()
        });
        prompt(home.path(), 0, 0);
        mailbox.stop(&halt);
        assert_eq!(waiting.join().unwrap(), PlayResult::Halted(halt));
    });
    prompt(home.path(), 0, 0);
}

/// The player shares the mailbox, and could replace the evaluation's files with links. The links' targets
/// stay unchanged.
#[cfg(unix)]
#[test]
fn links_in_the_place_of_our_files_are_not_followed() {
    use std::os::unix::fs::symlink;
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let (victim, folder) = (home.join("victim"), home.join("box"));
    fs::write(&victim, "precious").unwrap();
    fs::create_dir(&folder).unwrap();
    symlink(&victim, folder.join(".lock")).unwrap();
    let error = open(&folder, "test", false).expect_err("refused");
    assert!(error.contains(".lock"), "{error}");
    let subjects = [corridor()];
    let results = home.join("results");
    let begin = || {
        let settings = settings(&subjects, "test");
        Evaluation::create(&results, settings, subjects.to_vec()).map(drop).map_err(|error| error.to_string())
    };
    fs::create_dir(&results).unwrap();
    symlink(&victim, results.join(".lock")).unwrap();
    assert!(begin().unwrap_err().contains(".lock"));
    fs::remove_file(results.join(".lock")).unwrap();
    let games = results.join("games/corridor");
    fs::create_dir_all(&games).unwrap();
    symlink(&victim, games.join("game.vgdl")).unwrap();
    begin().unwrap();
    assert!(!games.join("game.vgdl").is_symlink());
    // A log is started at the target of a link.
    for target in [&victim, &home.join("absent")] {
        let log = results.join("episodes/x.jsonl");
        symlink(target, &log).unwrap();
        assert!(Journal::open(&log).is_err());
        fs::remove_file(&log).unwrap();
    }
    assert!(!home.join("absent").exists());
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
}
