//! Tests of tracks (bundles of prompt settings): their prompts, the information that the prompts must hide, and series
//! of levels.
//!
//! `BLESS=1 cargo test -p infinite-arcade-evaluation --test it tracks` rewrites the files in `golden/`. A change to any
//! word requires a new version of the track.

use crate::games::corridor;
use crate::prompts::{golden, text};
use crate::walk::{Walk, corpus, game};
use engine::{Action, SEMANTICS};
use evaluation::client::{
    ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Decoding, Finish, Model,
};
use evaluation::log::{read, without_times};
use evaluation::metrics::EpisodeMetrics;
use evaluation::player::{Contestant, ModelPlayer, Touching};
use evaluation::predictions::{TouchFact, Trials, truth};
use evaluation::prompt::{Attempt, Past, PromptSettings, Prompter, sections};
use evaluation::run::{FORMAT, PlayResult, Progress, Tally, Task};
use evaluation::study::{Player, Study};
use evaluation::{
    Commitment, Entrant, Evaluation, Event, LevelEnd, SeriesPlace, SeriesView, Settings, Subject, Track,
};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

fn prompter(subject: &Subject, track: Track) -> Prompter {
    Prompter::within(subject, track.settings(), 200, Commitment::ONE).unwrap()
}

/// Returns the conversation over two levels of a game on the track `discover`, with up to `steps` random
/// steps on each level.
fn series(subject: &Subject, steps: usize) -> Vec<ChatMessage> {
    let prompter = prompter(subject, Track::Discover);
    let (mut past, mut previous, mut messages) = (Vec::new(), None::<LevelEnd>, Vec::new());
    // The question is given sprite types under the game's own names.
    let first = Walk::new(subject, 0);
    let own = |name: &String| first.now.avatar.as_ref().is_some_and(|avatar| avatar.name == *name);
    let kinds: BTreeSet<String> =
        first.now.cells.iter().flatten().filter(|name| !own(name)).cloned().collect();
    let kinds: Vec<String> = kinds.into_iter().collect();
    for index in 0..2 {
        let mut walk = Walk::new(subject, index as usize);
        let place = SeriesPlace { index, of: 2 };
        for _ in 0..steps {
            let series = Some(SeriesView { place, previous: previous.as_ref() });
            let shown = prompter.prompt(&evaluation::Turn { series, ..walk.turn() }, &past, &[]).shown;
            let goes_on = walk.step();
            let played = walk.before.as_ref().unwrap().1;
            let answer = Attempt { answer: format!("ACTION: {played}"), complaint: None };
            past.push(Past::new(shown, &[answer], played));
            if !goes_on {
                break;
            }
        }
        let before = walk.before.clone().map(|(seen, action, _)| (seen, action));
        messages = prompter.question(&walk.turn(), &kinds, &past, &[]).messages;
        previous = Some(LevelEnd { last: walk.now.clone(), before, steps: walk.turn().number });
    }
    messages
}

#[test]
fn prompts_of_tracks_to_read() {
    assert_eq!(Track::Told.settings(), PromptSettings::default(), "told is the default");
    for track in [Track::Masked, Track::Vision] {
        let subject = game("first-ice");
        let prompt = prompter(&subject, track).prompt(&Walk::new(&subject, 0).turn(), &[], &[]);
        assert_eq!(prompt.messages.last().unwrap().image.is_some(), track == Track::Vision);
        golden(&format!("track_{}.txt", track.name()), &text(&prompt.messages));
    }
    golden("track_discover.txt", &text(&series(&game("first-ice"), 3)));
    let complaint = prompter(&game("first-ice"), Track::Discover);
    assert_eq!(
        complaint.question_complaint("it has no line KILLS:", &["wall".to_owned()]).split(". ").next(),
        Some("Your answer cannot be used: it has no line KILLS:")
    );
}

/// Returns a text's words, which consist of letters and digits.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty()).collect()
}

/// Returns `true` if a word reveals nothing, because it is a neutral name, a number or in capitals.
fn says_nothing(word: &str) -> bool {
    let rest = word.strip_prefix('t').unwrap_or(word).trim_end_matches('s');
    !rest.is_empty() && rest.chars().all(|c| c.is_ascii_digit())
}

/// A name counts as leaked if a masked prompt contains it and no masked prompt of another game does, because
/// then it is not part of the common wording. Walls and avatars are also renamed.
#[test]
fn masked_prompts_tell_no_names() {
    let games = corpus();
    let told: Vec<String> = games
        .iter()
        .map(|subject| {
            let mut walk = Walk::new(subject, 0);
            walk.step();
            text(&prompter(subject, Track::Masked).prompt(&walk.turn(), &[], &[]).messages)
        })
        .collect();
    for (subject, own) in games.iter().zip(&told) {
        for stype in subject.game.sprite_types() {
            let name = subject.game.name(stype);
            let others = games.iter().zip(&told).filter(|(other, _)| other.id != subject.id);
            let mut others = others.map(|(_, text)| text);
            let is_our_word =
                !["wall", "avatar"].contains(&name) && others.any(|text| words(text).contains(name));
            assert!(is_our_word || !words(own).contains(name), "{}: {name}", subject.id);
        }
        let board = sections(own).into_iter().find(|(heading, _)| *heading == "Board").unwrap().1;
        assert!(!board.contains(['@', '#', '$']), "characters are drawn: {board}");
    }
}

/// The words that prompts without rules may contain, in addition to neutral names, numbers and the characters
/// of the legend and the board.
const VOCABULARY: &str = "You are at facing up left down right nil use Level of which is for practice counts Tick most hold nothing Your health \
     Actions now was played did not move moved here from turned to face became gone back met cell cells before new in and more Moved \
     have won lost The score after action actions It over without a winner Its limit reached win All levels What do you expect touching \
     each these kinds End your answer with four lines the it true separated by commas or none KILLS kills least while STOPS cannot \
     enter its GOES disappears turns into another kind once when what takes SCORES changes over ACTION wait";

/// On the track `discover`, the prompts of different games differ only in neutral names and characters, and
/// in whether there is anything to shoot.
#[test]
fn prompts_without_rules_tell_no_rules() {
    let vocabulary: BTreeSet<&str> = VOCABULARY.split_whitespace().collect();
    let mut fixed: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for subject in corpus() {
        let messages = series(&subject, 25);
        let mut parts = sections(&messages[0].text);
        parts.retain(|(heading, _)| *heading != "Legend");
        let actions = parts.iter().find(|(heading, _)| *heading == "Actions").unwrap().1;
        fixed.entry(actions.to_owned()).or_default().insert(format!("{parts:?}"));
        for message in &messages[1..] {
            for (heading, body) in sections(&message.text) {
                if heading == "Board" {
                    continue;
                }
                let unknown: Vec<&str> = words(body)
                    .into_iter()
                    .filter(|word| !says_nothing(word) && !vocabulary.contains(word))
                    .collect();
                assert!(unknown.is_empty(), "{}: {heading}: {unknown:?}", subject.id);
            }
        }
        let legend = prompter(&subject, Track::Discover);
        let legend = sections(legend.static_part()).into_iter().find(|(heading, _)| *heading == "Legend");
        let lines = legend.unwrap().1.to_owned();
        let is_neutral = |line: &str| {
            words(&line[1..])
                .into_iter()
                .all(|word| says_nothing(word) || ["you", "or", "nothing"].contains(&word))
        };
        assert!(lines.lines().all(is_neutral), "{}: {lines}", subject.id);
        let score = messages[1..messages.len() - 1].iter().any(|message| message.text.contains("Score"));
        assert!(!score, "{}: the score is told at the end", subject.id);
    }
    assert!(fixed.values().all(|parts| parts.len() == 1), "{fixed:?}");
}

/// The truth about the sprite types in the corpus follows from the rules, and predictions are graded against
/// it.
#[test]
fn truths_of_the_corpus() {
    let mut lines = String::new();
    for subject in corpus() {
        let analysis = &subject.analysis;
        for stype in subject.game.sprite_types().filter(|&stype| analysis.facts(stype).possible) {
            if analysis.avatars().iter().any(|avatar| avatar.stype == stype) {
                continue;
            }
            let told = TouchFact::ALL.map(|fact| match truth(analysis, stype, fact) {
                Some(true) => fact.name().to_owned(),
                Some(false) => "-".to_owned(),
                None => format!("{}?", fact.name()),
            });
            writeln!(lines, "{} {}: {}", subject.id, subject.game.name(stype), told.join(" ")).unwrap();
        }
        let trials = Trials::of(&subject);
        let kinds = [&trials.costly, &trials.gated, &trials.idle].map(|kinds| kinds.join(" "));
        writeln!(lines, "{}: costly {}; gated {}; idle {}", subject.id, kinds[0], kinds[1], kinds[2])
            .unwrap();
    }
    golden("touch_facts.txt", &lines);
}

/// During play, an avatar that holds nothing never shares a cell with a type that stops it. It never survives
/// a tick in a cell that contained a type that kills it.
#[test]
fn truths_hold_in_play() {
    let mut contacts = 0;
    for subject in corpus() {
        for level in 0..subject.levels.len().min(3) {
            let mut walk = Walk::new(&subject, level);
            for _ in 0..200 {
                let goes_on = walk.step();
                let now = &walk.now;
                let Some(avatar) = &now.avatar else { break };
                let (before, ..) = walk.before.as_ref().unwrap();
                let holds_nothing =
                    |seen: &engine::Observation| seen.resources.iter().all(|(_, amount)| *amount == 0);
                let from = before.avatar.as_ref().map(|avatar| (avatar.column, avatar.row));
                let has_entered = from != Some((avatar.column, avatar.row));
                let cell = avatar.row as usize * now.columns + avatar.column as usize;
                if !(has_entered && holds_nothing(now) && holds_nothing(before)) || cell >= now.cells.len() {
                    continue;
                }
                // A sprite that appeared after the move was not touched.
                for name in before.cells[cell].iter().filter(|name| now.cells[cell].contains(name)) {
                    let kind = subject.game.sprite_type(name).unwrap();
                    contacts += 1;
                    for fact in [TouchFact::Kills, TouchFact::Stops] {
                        let is_true = truth(&subject.analysis, kind, fact) == Some(true);
                        assert!(!is_true, "{} {level}: {name} {}", subject.id, fact.name());
                    }
                }
                if !goes_on {
                    break;
                }
            }
        }
    }
    assert!(contacts > 1000, "{contacts}");
}

/// A program gets the same information as a model: neutral names, no rules and no score. At the end, it is
/// asked for predictions.
#[cfg(unix)]
#[test]
fn a_program_plays_a_series() {
    use evaluation::player::process::{Process, ProcessConfig};
    let (home, subjects) = (tempfile::tempdir().unwrap(), vec![three_levels()]);
    let settings = Settings { runs: 1, ..settings("cmd", Track::Discover, &subjects) };
    let script = format!(
        "echo start >> {0}.starts; tee {0} | while read line; do case $line in *'\"type\":\"turn\"'*) echo '{{\"action\":\"right\"}}';; \
         *'\"type\":\"predict\"'*) echo '{{\"turn\":8,\"kills\":[],\"stops\":[],\"goes\":[],\"scores\":[]}}';; esac; done",
        home.path().join("heard").display()
    );
    let command = format!("sh -c {}", shell_quoted(&script));
    let evaluation = Evaluation::create(&home.path().join("results"), settings, subjects).unwrap();
    let player = |_: &Task<'_>| {
        let process = Process::new(&command, ProcessConfig::default()).unwrap().on_track(Track::Discover);
        Ok(Contestant::Agent(Box::new(process)))
    };
    assert_eq!(evaluation.run(player, &Silent).unwrap().ended, 3);
    assert_eq!(fs::read_to_string(home.path().join("heard.starts")).unwrap(), "start\n");
    let heard = fs::read_to_string(home.path().join("heard")).unwrap();
    let types: Vec<String> = heard
        .lines()
        .map(|line| {
            serde_json::from_str::<serde_json::Value>(line).unwrap()["type"].as_str().unwrap().to_owned()
        })
        .filter(|kind| kind != "turn")
        .collect();
    assert_eq!(types, ["hello", "end", "hello", "end", "hello", "predict", "end"]);
    for name in ["bug", "floor", "wall", "door", "Door"] {
        assert!(!heard.contains(name), "{name}: {heard}");
    }
    assert!(heard.contains("\"score\":null,\"reward\":null") && heard.contains("\"rules\":\"\""), "{heard}");
    assert!(heard.contains("\"series\":{\"index\":0,\"of\":3}"), "{heard}");
    let last = evaluation.tasks()[2];
    let log = evaluation.events(&last).unwrap();
    assert!(
        log.iter().any(|event| matches!(event, Event::Predictions { predicted: Some(_), .. })),
        "{log:?}"
    );
}

fn shell_quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

struct Silent;

impl Progress for Silent {
    fn episode(&self, _: &Task<'_>, _: &PlayResult) {}
}

/// Returns the corridor game with three levels.
fn three_levels() -> Subject {
    let corridor = corridor();
    let levels: Vec<_> = [0, 1, 1]
        .iter()
        .enumerate()
        .map(|(number, &at)| (number, corridor.levels[at].text.clone(), None))
        .collect();
    Subject::read("corridor", &corridor.source, &levels, corridor.facts.clone()).unwrap()
}

fn settings(name: &str, track: Track, subjects: &[Subject]) -> Settings {
    let entrant =
        Entrant { name: name.to_owned(), mode: None, aids: Vec::new(), details: serde_json::Value::Null };
    let settings = Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: "test".into(),
        snapshot: None,
        entrant,
        seed: "test".into(),
        runs: 2,
        max_steps: 8,
        commit: Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(subjects),
    };
    settings.on_track(track).unwrap()
}

/// A model that walks to the right and makes predictions at the end. The network fails after `left` answers.
/// The model checks that its past turns appear in the prompts.
struct Walker {
    left: AtomicU64,
}

impl Model for Walker {
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError> {
        let left = self.left.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |left| left.checked_sub(1));
        if left.is_err() {
            let message = "the network is down".to_owned();
            return Err(ChatError { kind: ChatErrorKind::Infrastructure, message, failures: Vec::new() });
        }
        let last = &request.messages.last().unwrap().text;
        let asked = request.messages.len() / 2;
        let answer = match last.contains("## Question") || last.contains("four lines") {
            // The first answer is unusable, so that the question is repeated.
            true if last.contains("## Question") => "I do not know.".to_owned(),
            true => "KILLS: none\nSTOPS: none\nGOES: none\nSCORES: none".to_owned(),
            false if last.contains("## Level before") => format!("I remember {asked}.\nACTION: right"),
            false => "ACTION: right".to_owned(),
        };
        Ok(ChatReply::new(answer, Finish::Stop))
    }
}

fn evaluate(evaluation: &Evaluation, answers: u64) -> Tally {
    let model: Arc<dyn Model> = Arc::new(Walker { left: AtomicU64::new(answers) });
    let player = |task: &Task<'_>| {
        let prompter = Arc::new(prompter(task.subject, Track::Discover));
        let samples = task.chance();
        let player = ModelPlayer::new(model.clone(), prompter, Decoding::default(), 1, samples);
        Ok(Contestant::Agent(Box::new(player)))
    };
    evaluation.run(player, &Silent).unwrap()
}

fn logs(folder: &Path) -> BTreeMap<String, Vec<Event>> {
    let entries = fs::read_dir(folder.join("episodes")).unwrap();
    let log = |path: std::path::PathBuf| {
        let is_kept = |event: &Event| !matches!(event, Event::Halt { .. });
        let events = read(&path).unwrap();
        let events = events.iter().filter(|event| is_kept(event)).map(without_times).collect();
        (path.file_name().unwrap().to_string_lossy().into_owned(), events)
    };
    entries.map(|entry| log(entry.unwrap().path())).collect()
}

#[test]
fn a_series_is_one_conversation() {
    let (home, subjects) = (tempfile::tempdir().unwrap(), vec![three_levels()]);
    let settings = settings("walker", Track::Discover, &subjects);
    assert_eq!((settings.track.as_deref(), settings.series), (Some("discover@1"), 3));
    assert_eq!(settings.entrant.aids, ["track=discover@1"]);
    let whole = home.path().join("whole");
    let evaluation = Evaluation::create(&whole, settings.clone(), subjects.clone()).unwrap();
    let tally = evaluate(&evaluation, u64::MAX);
    assert_eq!((tally.episodes, tally.ended, tally.practice), (6, 6, 2));
    drop(evaluation);
    let undisturbed = logs(&whole);
    let second = &undisturbed["corridor-lvl1-run0.jsonl"];
    let first = second.iter().find_map(|event| match event {
        Event::Request { messages, .. } => Some(messages.len()),
        _ => None,
    });
    let before =
        undisturbed["corridor-lvl0-run0.jsonl"].iter().filter(|event| matches!(event, Event::Step { .. }));
    assert_eq!(first, Some(2 + 2 * before.count()), "the levels before are shown");
    let said = |log: &str| undisturbed[log].iter().any(|event| matches!(event, Event::Predictions { .. }));
    assert_eq!([0, 1, 2].map(|level| said(&format!("corridor-lvl{level}-run1.jsonl"))), [false, false, true]);

    // Failing at any answer and then resuming does not change the results.
    for answers in [0, 3, 9, 11, 13, 14, 15, 20] {
        let folder = home.path().join(format!("after{answers}"));
        let evaluation = Evaluation::create(&folder, settings.clone(), subjects.clone()).unwrap();
        let tally = rayon_one(|| evaluate(&evaluation, answers));
        assert!(tally.infrastructure, "{tally:?}");
        drop(evaluation);
        let evaluation = Evaluation::resume(&folder, &settings).unwrap();
        assert_eq!(evaluate(&evaluation, u64::MAX).ended, 6);
        assert_eq!(logs(&folder), undisturbed, "after {answers} answers");
    }

    let study = Study::read(&[whole]).unwrap();
    assert_eq!(study.episodes.len(), 4, "first levels are for practice");
    assert_eq!(study.players[0].label(), "walker (track=discover@1)");
    assert_eq!(study.predictions[0].answers, 2);
    assert_eq!(study.predictions[0].insight, Some(0.0));
    assert!(study.notes.iter().any(|note| note.contains("for practice")), "{:?}", study.notes);
}

/// Runs a function on a single thread, so that the order of requests is fixed.
fn rayon_one<T: Send>(run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(run)
}

/// A player that remembers earlier levels can be resumed at any byte of any log, with the same final logs.
#[test]
fn series_are_resumed_anywhere() {
    let (home, subjects) = (tempfile::tempdir().unwrap(), vec![three_levels()]);
    let settings = Settings { runs: 1, ..settings("touch-everything", Track::Discover, &subjects) };
    let player = |task: &Task<'_>| Ok(Contestant::Agent(Box::new(Touching::new(task.chance()))));
    let whole = home.path().join("whole");
    Evaluation::create(&whole, settings.clone(), subjects.clone()).unwrap().run(player, &Silent).unwrap();
    let undisturbed = logs(&whole);
    let names: Vec<String> = undisturbed.keys().cloned().collect();
    for kept in 0..names.len() {
        let bytes = fs::read(whole.join("episodes").join(&names[kept])).unwrap();
        for cut in (0..bytes.len()).step_by(211) {
            let folder = home.path().join(format!("{kept}-{cut}"));
            Evaluation::create(&folder, settings.clone(), subjects.clone()).unwrap();
            for name in &names[..kept] {
                fs::copy(whole.join("episodes").join(name), folder.join("episodes").join(name)).unwrap();
            }
            fs::write(folder.join("episodes").join(&names[kept]), &bytes[..cut]).unwrap();
            let evaluation = Evaluation::resume(&folder, &settings).unwrap();
            assert_eq!(evaluation.run(player, &Silent).unwrap().ended, 3);
            assert_eq!(logs(&folder), undisturbed, "{} cut at byte {cut}", names[kept]);
        }
    }
}

/// A changed grade in a log is detected when the log is read.
#[test]
fn grades_follow_from_the_rules() {
    let (home, subjects) = (tempfile::tempdir().unwrap(), vec![three_levels()]);
    let folder = home.path().join("results");
    let settings = settings("touch-everything", Track::Discover, &subjects);
    let evaluation = Evaluation::create(&folder, settings, subjects.clone()).unwrap();
    let player =
        |task: &Task<'_>| Ok(Contestant::Agent(Box::new(Touching::new(task.chance()).without_score())));
    assert_eq!(evaluation.run(player, &Silent).unwrap().ended, 6);
    let again = home.path().join("again");
    let second = Evaluation::create(&again, evaluation.settings.clone(), subjects.clone()).unwrap();
    second.run(player, &Silent).unwrap();
    assert_eq!(logs(&folder), logs(&again));
    let path = folder.join("episodes/corridor-lvl2-run0.jsonl");
    let metrics = EpisodeMetrics::of(&subjects[0], &read(&path).unwrap()).unwrap();
    assert!(metrics.predictions.is_some() && !metrics.is_practice());
    assert_eq!(metrics.track.as_deref(), Some("discover@1"));
    let text = fs::read_to_string(&path).unwrap();
    let changed = text.replace("\"right\":", "\"right\":1");
    assert_ne!(text, changed);
    fs::write(&path, changed).unwrap();
    let error = Study::read(&[folder]).unwrap_err().to_string();
    assert!(error.contains("the recorded grade of the predictions differs"), "{error}");
}

#[test]
fn tracks_are_never_mixed() {
    let episode = |track: Option<Track>, run: u64| EpisodeMetrics {
        track: track.map(Track::id),
        score: run as f64,
        ..EpisodeMetrics::ended("maze", 0, run, engine::Outcome::Won)
    };
    let player = |name: &str, track: Option<Track>| Player {
        aids: track.map(Track::aid).into_iter().collect(),
        ..Player::model(name, "zero-shot")
    };
    let (told, masked) = (Some(Track::Told), Some(Track::Masked));
    let results = [("a", told), ("b", told), ("a", masked), ("b", None)]
        .map(|(name, track)| (player(name, track), vec![episode(track, 0), episode(track, 2)]));
    let random = (Player::reference("random"), vec![episode(None, 5)]);
    let study = Study::new(results.into_iter().chain([random]).collect(), Vec::new());
    let pairs: Vec<[usize; 2]> = study.pairs.overall.iter().map(|pair| pair.players).collect();
    // Baselines that read no prompts are compared with all other players.
    assert_eq!(pairs, [[0, 1], [0, 4], [1, 4], [2, 4], [3, 4]]);
    assert!(study.aids.is_empty(), "a track is no aid");
    assert_eq!(study.episodes[1].normalised_reward.map(|reward| reward > 0.99), Some(true));
    assert!(study.notes.iter().any(|note| note.contains("different tracks")), "{:?}", study.notes);
    assert_eq!(study.tested().count(), 4, "numbers about several players are of the first track");
}

#[test]
fn a_series_takes_two_levels() {
    let mut subject = corridor();
    subject.levels.truncate(1);
    let mut settings = settings("a", Track::Told, &[corridor()]);
    settings.games = Evaluation::entries(&[subject]);
    let refused = settings.on_track(Track::Discover).unwrap_err();
    assert!(refused.contains("at least two levels per game") && refused.contains("--levels"), "{refused}");
}

#[test]
fn discover_asks_for_one_action() {
    let subject = game("first-ice");
    let commit = "5".parse().unwrap();
    let error = Prompter::within(&subject, Track::Discover.settings(), 200, commit).unwrap_err().to_string();
    assert!(error.contains("leave out --commit"), "{error}");
    let prompter = prompter(&subject, Track::Discover);
    assert!(prompter.complaint("it is silly").contains("ACTION: followed by one of"));
    assert!(prompter.actions().contains(&Action::Nil));
}
