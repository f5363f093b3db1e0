use super::*;
use crate::input;
use engine::{Game, Seed};
use snapshots::levels::report::{Cost, Judged, LevelSet, Likeness};
use validators::{Criteria, Difficulty, Measures, Panel};

/// The corpus game's own levels as a set, judged in earnest; every other one asked to be hard.
fn judged(game: &Game, analysis: &Analysis, levels: &[Level], criteria: &Criteria) -> Vec<Judged> {
    let panel = Panel::new(criteria);
    let judge = |(at, level): (usize, &Level)| {
        let seed = Seed::from_text("level report").child("level", at as u64);
        let report = panel.judge(game, level, seed);
        let measures = Measures::of(analysis, level, &report, seed);
        let free = level.cells().iter().filter(|symbol| **symbol == b'.' || **symbol == b' ').count();
        let openness = free as f64 / level.cells().len() as f64;
        let layout = vec![("openness".to_owned(), openness), ("cover".to_owned(), 1.0 - openness)];
        let asked = if at % 2 == 0 { Difficulty::Hard } else { Difficulty::Easy };
        Judged { layout, asked: Some(asked), ..Judged::new(level.clone(), report, measures) }
    };
    levels.iter().enumerate().map(judge).collect()
}

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
    let set = judged(&game, &analysis, &levels, &criteria);
    let differ = |one: &Level, two: &Level| f64::from(u8::from(one != two));
    let likeness = Likeness { canonical: &Level::digest, distance: &differ };
    let cost = Cost { calls: 123_456, candidates: 40, accepted: levels.len() as u64 };
    let (pool, examples) = ([Difficulty::Easy, Difficulty::Hard, Difficulty::Hard], &set[..1]);
    let report = LevelSetReport::of(&LevelSet {
        game: &game,
        method: "constructive",
        levels: &set,
        examples,
        pool: &pool,
        likeness,
        cost,
    });
    let pictures = Pictures {
        title: name,
        analysis: &analysis,
        levels: &levels,
        examples: &levels[..1],
        seconds: Some(3.25),
    };
    write_level_report(dir, &report, &pictures).unwrap();
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
        !String::from_utf8(read("report.json")).unwrap().contains("3.25"),
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
    for part in ["Can they be won?", "Does skill pay?", "As hard", "made in 3.25 s", "Every level"] {
        assert!(page.to_lowercase().contains(&part.to_lowercase()), "{part}");
    }
}
