use super::*;
use crate::input;
use engine::Seed;
use forge::levels::report::{Expense, Judged, Sample, Survey};
use std::path::Path;
use validators::{Criteria, Difficulty};

/// The corpus game's own levels as a set, judged in earnest; every other one asked to be hard.
fn write(name: &str, dir: &Path) -> LevelSetReport {
    let input = input::game(name).unwrap();
    let game = input.compile(false).unwrap();
    let analysis = Analysis::of(&game);
    let levels: Vec<Level> =
        input.levels().unwrap().iter().map(|level| game.level(&level.text).unwrap()).collect();
    let criteria = Criteria {
        budget: 20_000,
        ladder: ["do-nothing", "random", "one-step", "mcts:30"].map(str::to_owned).to_vec(),
        held_out: vec!["olets:30".to_owned()],
        ladder_plays: 2,
        most_ticks: 200,
        ask: Criteria::full().ask,
        ..Criteria::default()
    };
    let asked = |at| Some(if at % 2 == 0 { Difficulty::Hard } else { Difficulty::Easy });
    let asked: Vec<_> = levels.iter().cloned().enumerate().map(|(at, level)| (level, asked(at))).collect();
    let survey = Survey::new(&analysis, &criteria, Seed::from_text("survey")).unwrap();
    let set: Vec<Judged> = survey.judge(&asked);
    let cost = Expense { calls: 123_456, looks: 40, accepted: levels.len() as u64, ..Expense::default() };
    let report = LevelSetReport::of(&Sample {
        analysis: &analysis,
        method: "constructive",
        levels: &set,
        examples: &set[..1],
        pool: &[Difficulty::Easy, Difficulty::Hard, Difficulty::Hard],
        cost: &cost,
    });
    let pictures = Pictures {
        title: name,
        analysis: &analysis,
        levels: &levels,
        examples: &levels[..1],
        seconds: Some(3.5),
    };
    write_level_report(Draft::create(dir).unwrap(), &report, &pictures).unwrap();
    report
}

#[test]
fn a_report_is_three_files_and_the_page_needs_no_other() {
    let home = tempfile::tempdir().unwrap();
    let dir = home.path().join("report");
    let report = write("quiet-jars", &dir);
    let read = |name: &str| std::fs::read(dir.join(name)).unwrap();
    let json: LevelSetReport = serde_json::from_slice(&read("report.json")).unwrap();
    assert_eq!(json, report);
    assert!(
        !String::from_utf8(read("report.json")).unwrap().contains("seconds"),
        "time is no part of the report"
    );
    assert!(read("sheet.png").starts_with(b"\x89PNG"));
    let page = String::from_utf8(read("report.html")).unwrap();
    assert_eq!(page.matches("<img src=\"data:image/png;base64,").count(), report.levels.len() + 1);
    assert_eq!(page.matches("<svg class=\"heat\"").count(), report.ranges.len());
    for outside in ["http://", "https://", "src=\"/", "href=", "<script"] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Rules are text, not markup.
    assert!(page.contains("&gt; "));
    for part in ["Can they be won?", "Does skill pay?", "As hard", "made in 3.5 s", "Every level"] {
        assert!(page.to_lowercase().contains(&part.to_lowercase()), "{part}");
    }
}
