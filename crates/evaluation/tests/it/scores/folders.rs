//! Tests of results folders of built-in players that are read together. Another test checks invariants of
//! episodes on all games.

use super::logs::subject;
use agents::Budget;
use base::Seed;
use engine::{Action, SEMANTICS};
use evaluation::metrics::{EpisodeMetrics, replay};
use evaluation::player::Contestant;
use evaluation::run::{FORMAT, PlayResult, Progress, Task, play};
use evaluation::study::{Player, Study};
use evaluation::{Commitment, Entrant, Evaluation, Journal, Settings, Subject, SubjectFacts};
use std::fs;
use std::path::{Path, PathBuf};

struct Silent;

impl Progress for Silent {
    fn episode(&self, _: &Task<'_>, _: &PlayResult) {}
}

fn planner(name: &str) -> Contestant {
    Contestant::Planner { spec: name.parse().expect("a planner"), budget: Budget(30) }
}

/// Evaluates a built-in player on all levels of the given games, with two runs of up to 30 steps each.
pub(super) fn evaluate(folder: &Path, name: &str, subjects: Vec<Subject>) -> PathBuf {
    with_details(folder, name, subjects, serde_json::Value::Null)
}

/// Evaluates a built-in player with the given details on all levels of the given games, with two runs of up
/// to 30 steps each.
pub(super) fn with_details(
    folder: &Path,
    name: &str,
    subjects: Vec<Subject>,
    details: serde_json::Value,
) -> PathBuf {
    let settings = Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: "test".to_owned(),
        snapshot: None,
        entrant: Entrant { name: name.to_owned(), mode: None, aids: Vec::new(), details },
        seed: "test".to_owned(),
        runs: 2,
        max_steps: 30,
        commit: Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(&subjects),
    };
    let evaluation = Evaluation::create(folder, settings, subjects).expect("the folder is new");
    evaluation.run(|_| Ok(planner(name)), &Silent).expect("the folder can be written");
    folder.to_owned()
}

#[test]
fn folders_are_read_together() {
    let home = tempfile::tempdir().unwrap();
    let folders =
        ["random", "mcts"].map(|name| evaluate(&home.path().join(name), name, vec![subject()])).to_vec();
    let study = Study::read(&folders).unwrap();
    assert_eq!(study.players, [Player::reference("random"), Player::reference("mcts")]);
    assert_eq!((study.games.len(), study.games[0].levels.len(), study.episodes.len()), (1, 2, 8));
    assert_eq!(study.games[0].levels[0].optimal_ticks, Some(4));
    assert!(study.notes.is_empty(), "{:?}", study.notes);
    assert!(!study.games[0].taxonomy.is_empty() && !study.taxonomy.is_empty());
    assert_eq!(study.pairs.by_level.len(), 2);
    for (player, time) in study.times.iter().enumerate() {
        let steps: u64 = study.on(player, None, None).iter().map(|episode| episode.metrics.steps).sum();
        assert_eq!(time.decisions, steps);
    }
    assert!(study.times[1].median_calls.is_some_and(|calls| calls > 0.0));
}

#[test]
fn incompatible_folders_are_rejected() {
    let home = tempfile::tempdir().unwrap();
    let once = evaluate(&home.path().join("once"), "random", vec![subject()]);
    let check = |folders: &[PathBuf], expect: &str| {
        let error = Study::read(folders).unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    };
    check(&[once.clone(), once.clone()], "rename one of the two players");
    let other = Subject { source: subject().source.replace("scoreChange=2", "scoreChange=3"), ..subject() };
    let levels: Vec<(usize, String, Option<usize>)> =
        other.levels.iter().map(|level| (level.number, level.text.clone(), None)).collect();
    let other = Subject::read(&other.id, &other.source, &levels, SubjectFacts::default()).unwrap();
    let other = evaluate(&home.path().join("other"), "mcts", vec![other]);
    check(&[once.clone(), other], "differs from that in an earlier folder");
    check(&[home.path().join("nowhere")], "contains no evaluation results");

    // One episode was not started, and one was interrupted.
    fs::remove_file(once.join("episodes/hall-lvl0-run0.jsonl")).unwrap();
    let path = once.join("episodes/hall-lvl3-run1.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    fs::write(&path, lines[..5].join("\n") + "\n").unwrap();
    let study = Study::read(std::slice::from_ref(&once)).unwrap();
    let scores = &study.leaderboard[0].scores;
    assert_eq!((scores.episodes, scores.excluded), (2, 1));
    assert_eq!(study.notes.len(), 2, "{:?}", study.notes);

    // A step in the log is altered.
    fs::write(&path, text.replacen("\"action\":\"", "\"action\":\"nil\",\"was\":\"", 1)).unwrap();
    check(std::slice::from_ref(&once), "not an event");
}

/// Plays random episodes on all corpus games. Every log replays, ratios are between 0 and 1, and each sum
/// equals the total of its parts.
#[test]
fn invariants_of_any_episode() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora");
    let mut folders: Vec<PathBuf> = fs::read_dir(corpus)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .collect();
    folders.sort();
    assert!(folders.len() > 20);
    for folder in folders {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let source = fs::read_to_string(folder.join("game.vgdl")).unwrap();
        let level = fs::read_to_string(folder.join("lvl0.txt")).unwrap();
        let subject = Subject::read(&name, &source, &[(0, level, None)], SubjectFacts::default()).unwrap();
        let seed = Seed::from_text("any episode");
        let task = Task {
            subject: &subject,
            level: &subject.levels[0],
            run: 0,
            seed,
            max_steps: 60,
            commit: Commitment::ONE,
            max_output_tokens: None,
            track: None,
            series: None,
        };
        let mut journal = Journal::in_memory();
        play(&task, &mut planner("random"), &mut journal).unwrap();
        let metrics = EpisodeMetrics::of(&subject, journal.events()).unwrap();
        let replayed = replay(&subject, journal.events()).unwrap();
        assert_eq!(metrics.choices.total(), metrics.steps, "{name}");
        let movement = &metrics.movement;
        assert_eq!(
            movement.bump_rate,
            metrics.meaningful.map(|ratio| {
                let bumps = replayed.meaningful.iter().filter(|flag| !**flag).count();
                assert!((1.0 - ratio - bumps as f64 / metrics.steps as f64).abs() < 1e-12, "{name}");
                bumps as f64 / metrics.steps as f64
            })
        );
        let shares = [
            metrics.meaningful,
            metrics.meaningful_as_code,
            movement.late_bump_rate,
            movement.oscillation_rate,
            movement.still_rate,
            movement.coverage,
        ];
        assert!(shares.into_iter().flatten().all(|share| (0.0..=1.0).contains(&share)), "{name}: {shares:?}");
        // Doing nothing is meaningful only with a reward, and a step with a reward is always meaningful.
        for ((flag, action), reward) in
            replayed.meaningful.iter().zip(&replayed.actions).zip(&replayed.rewards)
        {
            assert!(*reward == 0.0 || *flag, "{name}");
            assert!(*action != Action::Nil || *flag == (*reward != 0.0), "{name}");
        }
    }
}
