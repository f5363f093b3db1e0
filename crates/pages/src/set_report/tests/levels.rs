use super::{page, read, texts};
use crate::{File, level_report};
use base::Seed;
use engine::{Analysis, Game, Level};
use forge::Tally;
use forge::levels::report::{LevelSetReport, Sample};
use forge::survey::{LevelSurvey, SurveyedLevel};
use validators::{Criteria, Difficulty};

/// Returns the report on a set that consists of the corpus game's own levels, fully judged. For every other
/// level, hard difficulty was requested.
fn made() -> (LevelSetReport, Vec<File>) {
    let (source, levels) = texts("quiet-jars");
    let game = Game::from_source(&source).unwrap();
    let analysis = Analysis::of(&game);
    let levels: Vec<Level> = levels.iter().map(|text| game.level(text).unwrap()).collect();
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
    let survey = LevelSurvey::new(&analysis, &criteria, Seed::from_text("survey")).unwrap();
    let set: Vec<SurveyedLevel> = survey.judge(&asked);
    let cost = Tally { calls: 123_456, ..Tally::default() };
    let report = LevelSetReport::of(&Sample {
        analysis: &analysis,
        method: "constructive",
        levels: &set,
        examples: &set[..1],
        pool: &[Difficulty::Easy, Difficulty::Hard, Difficulty::Hard],
        cost: &cost,
    });
    let made = ("quiet-jars", "constructive", Some(3.5));
    let files = level_report(&report, &analysis, [&levels, &levels[..1]], made).unwrap();
    (report, files)
}

#[test]
fn a_report_is_three_files_and_the_page_needs_no_other() {
    let (report, files) = made();
    let json: serde_json::Value = serde_json::from_slice(&read(&files, "report.json")).unwrap();
    assert_eq!(json["levels"].as_array().unwrap().len(), report.levels.len());
    let page = page(&files, report.levels.len() + 1);
    assert_eq!(page.matches("<svg class=\"plot heat\"").count(), report.ranges.len());
    // Rules are escaped, so they are not interpreted as markup.
    assert!(page.contains("&gt; "));
    for part in ["Can the levels be won?", "Does skill pay?", "As hard", "made in 3.5 s", "Every level"] {
        assert!(page.to_lowercase().contains(&part.to_lowercase()), "{part}");
    }
}
