//! `tests/suite/levels/`: bad and good games with one level each, and the verdicts expected for them.
//!
//! A case is a folder with `game.vgdl`, `lvl0.txt` and `expect.toml`. A bad case specifies the criterion that
//! it does not meet, the expected verdict, and words that the reason and the evidence must contain. A good
//! case meets every criterion.

use base::Seed;
use engine::{Game, Level};
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};
use std::slice::from_ref;
use tests::sweep::VARIABLE;
use validators::{
    CheckedCriteria, Criteria, Criterion, CriterionSet, Effort, Finding, Judgement, Judging, Panel, Report,
    Verdict,
};

/// The content of `expect.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Expect {
    /// A note for readers about the merits or faults of the case.
    about: String,
    /// The criterion that a bad level fails.
    criterion: Option<Criterion>,
    /// The expected verdict: `pass`, `fail` or `unknown`.
    verdict: String,
    /// The words that the reason and the evidence must contain.
    #[serde(default)]
    words: Vec<String>,
    /// The criteria to check, or empty to check all of them.
    #[serde(default)]
    ask: CriterionSet,
    /// The criteria settings that differ from these tests' defaults.
    #[serde(default)]
    criteria: toml::Table,
}

struct Case {
    name: String,
    game: Game,
    level: Level,
    expect: Expect,
}

fn cases(kind: &str) -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("suite/levels").join(kind);
    let mut folders: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let case = |folder: &PathBuf| {
        let read = |file: &str| fs::read_to_string(folder.join(file)).unwrap();
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let game =
            Game::from_source(&read("game.vgdl")).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        let level = game.level(&read("lvl0.txt")).unwrap_or_else(|problems| panic!("{name}: {problems}"));
        let expect = toml::from_str(&read("expect.toml")).unwrap_or_else(|error| panic!("{name}: {error}"));
        Case { name, game, level, expect }
    };
    folders.iter().map(case).collect()
}

/// Returns all criteria, with budgets sufficient for small levels.
fn criteria(expect: &Expect) -> CheckedCriteria {
    let base = Criteria { budget: 600_000, ..Criteria::full() };
    let mut table = toml::Table::try_from(&base).unwrap();
    table.extend(expect.criteria.clone());
    let mut criteria: Criteria = table.try_into().unwrap();
    if !expect.ask.is_empty() {
        criteria.ask = expect.ask;
    }
    criteria.check().unwrap()
}

fn word(finding: &Finding) -> &'static str {
    match finding.verdict {
        Verdict::Pass { .. } => "pass",
        Verdict::Fail { .. } => "fail",
        Verdict::Unknown { .. } => "unknown",
    }
}

/// Returns the complete text of a finding.
fn told(finding: &Finding) -> String {
    let mut text = match &finding.verdict {
        Verdict::Fail { reason, .. } => reason.0.clone(),
        _ => String::new(),
    };
    for seen in &finding.evidence {
        text.push_str(&format!("\n{}", seen.text));
        let cell = seen.cell.map(|(column, row)| format!("\ncolumn {column}, row {row}"));
        let rule = seen.rule.as_ref().map(|rule| rule.text.clone());
        for part in [cell, rule, seen.advice.clone()].into_iter().flatten() {
            text.push_str(&format!("\n{part}"));
        }
    }
    text
}

/// Checks that every witness in the report replays.
fn replays(case: &Case, report: &Report) {
    for episode in report.episodes() {
        assert!(episode.replay(&case.game, &case.level).is_ok(), "{}", case.name);
    }
}

#[allow(clippy::print_stderr, reason = "a case that is put off says so")]
#[test]
fn bad_levels_fail_for_the_expected_reason() {
    let cases = cases("bad");
    assert!(cases.len() >= 20, "{} cases", cases.len());
    for case in &cases {
        let Case { name, game, level, expect } = case;
        let criterion = expect.criterion.unwrap_or_else(|| panic!("{name} names no criterion"));
        let panel = Panel::new(criteria(expect), Effort::Full);
        let report = panel.judge(Judging::game(game, from_ref(level), Seed::from_text("suite")));
        replays(case, &report.levels[0]);
        assert!(!report.passes(), "{name} passes: {}", expect.about);
        let all = report.levels[0].judgements.iter().chain(&report.judgements);
        let judgement = all.into_iter().find(|judgement| judgement.criterion == criterion);
        let finding = &judgement.unwrap_or_else(|| panic!("{name}: {criterion} was not asked")).finding;
        assert_eq!(word(finding), expect.verdict, "{name}: {}\n{}", expect.about, told(finding));
        let told = told(finding);
        for words in &expect.words {
            assert!(told.contains(words), "{name}: `{words}` is not in\n{told}");
        }
    }
}

#[test]
fn good_levels_meet_every_criterion() {
    let cases = cases("good");
    assert!(cases.len() >= 8, "{} cases", cases.len());
    for case in &cases {
        let Case { name, game, level, expect } = case;
        let panel = Panel::new(criteria(expect), Effort::Full);
        let report = panel.judge(Judging::game(game, from_ref(level), Seed::from_text("suite")));
        replays(case, &report.levels[0]);
        let all = report.levels[0].judgements.iter().chain(&report.judgements);
        let obstacle = all.into_iter().find(|judgement| !judgement.finding.verdict.is_pass());
        if let Some(Judgement { criterion, finding }) = obstacle {
            panic!("{name}: {}\n{criterion}: {} {}", expect.about, word(finding), told(finding));
        }
    }
}

/// The corpus levels that meet every criterion for levels.
const CORPUS: &[(&str, usize)] = &[
    ("bog-lantern", 0),
    ("bog-lantern", 2),
    ("diving-bell", 0),
    ("diving-bell", 1),
    ("foxglove-round", 0),
    ("foxglove-round", 1),
    ("garden-post", 0),
    ("garden-post", 1),
    ("hailglass", 3),
    ("hailglass", 4),
    ("kiln-gecko", 0),
    ("quiet-jars", 0),
    ("tinkers-attic", 0),
    ("tinkers-attic", 1),
];

#[test]
fn levels_of_the_corpus_meet_the_criteria_of_levels() {
    let criteria = Criteria { ask: CriterionSet::LEVEL, ..Criteria::default() };
    let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
    let step = if std::env::var_os(VARIABLE).is_some() { 1 } else { 2 };
    for (name, number) in CORPUS.iter().step_by(step) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpora").join(name);
        let game = Game::from_source(&fs::read_to_string(folder.join("game.vgdl")).unwrap()).unwrap();
        let level =
            game.level(&fs::read_to_string(folder.join(format!("lvl{number}.txt"))).unwrap()).unwrap();
        let report = panel.judge(Judging::level(&game, &level, Seed::from_text("suite")));
        let obstacle = report.first_obstacle();
        assert!(
            obstacle.is_none(),
            "{name} {number}: {:?}",
            obstacle.map(|judgement| (judgement.criterion, told(&judgement.finding)))
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_answer_on_any_number_of_threads() {
    for case in cases("good").iter().take(3).chain(cases("bad").iter().take(4)) {
        let criteria = Criteria { budget: 100_000, ladder_calls: 300_000, ..Criteria::full() };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let judging = || Judging::game(&case.game, from_ref(&case.level), Seed::from_text("threads"));
        let judge = || panel.judge(judging());
        let [one, two] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(judge)
        });
        assert_eq!(
            serde_json::to_string(&one).unwrap(),
            serde_json::to_string(&two).unwrap(),
            "{}",
            case.name
        );
        assert_eq!(one, two, "{}", case.name);
    }
}
