use super::{corpus, page, texts};
use crate::{File, game_report};
use base::Seed;
use engine::{Game, Level};
use forge::games::report::{GameSetReport, GamesSample};
use forge::survey::SurveyedGame;
use forge::{JudgeCost, Tally};
use std::collections::BTreeMap;
use validators::{Criteria, Criterion, CriterionSet, Effort, Judging, Panel};

/// Corpus games that are treated as generated games, with two levels each.
const GAMES: [(&str, &str); 3] =
    [("quiet-jars", "Quiet Jars"), ("hailglass", "Hailglass"), ("turnip-heist", "Turnip Heist")];

fn judged((name, title): (&str, &str), criteria: &Criteria) -> SurveyedGame {
    let (source, levels) = texts(name);
    let game = Game::from_source(&source).unwrap();
    let levels: Vec<Level> = levels.iter().step_by(3).map(|text| game.level(text).unwrap()).collect();
    let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
    let report = panel.judge(Judging::game(&game, &levels, Seed::from_text("judged")));
    SurveyedGame { name: title.to_owned(), goal: "Win.".to_owned(), game, levels, report }
}

fn made() -> (GameSetReport, Vec<File>) {
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<String>>();
    let criteria = Criteria {
        ask: CriterionSet::of(&[Criterion::Winnable, Criterion::Skill, Criterion::RuleUse]),
        budget: 100_000,
        ladder: names(&["do-nothing", "random", "mcts:30"]),
        held_out: names(&["olets:30"]),
        ladder_plays: 2,
        most_ticks: 200,
        ..Criteria::full()
    };
    let games: Vec<SurveyedGame> = GAMES.iter().map(|&game| judged(game, &criteria)).collect();
    let known = |name: String| {
        let game = Game::from_source(&texts(&name).0).unwrap();
        (name, game)
    };
    let known: Vec<(String, Game)> = corpus().into_iter().map(known).collect();
    let rejections = BTreeMap::from([("winnable".to_owned(), 7)]);
    let winnable =
        JudgeCost { asked: 9, refused: 7, calls_accepted: 30_000, calls_refused: 90_000, calls_lost: 3_456 };
    let judges = BTreeMap::from([("winnable".to_owned(), winnable)]);
    let cost = Tally { calls: 123_456, games_tried: 10, rejections, judges, ..Tally::default() };
    let sample = GamesSample {
        method: "constructive",
        games: &games,
        corpus: &known,
        criteria: &criteria,
        cost: Some(&cost),
        seed: Seed::from_text("report"),
    };
    let report = GameSetReport::of(&sample);
    let files =
        game_report(&report, &games, Some(&cost), ("Three games", "constructive", Some(3.5))).unwrap();
    (report, files)
}

#[test]
fn a_report_is_three_files_and_the_page_needs_no_other() {
    let (report, files) = made();
    let page = page(&files, GAMES.len());
    // A copy of a corpus game is reported as close to the corpus.
    let near = report.set.share("novelty", "near_corpus").unwrap();
    assert_eq!(near.count, GAMES.len() as u64);
    assert_eq!(report.games[0].nearest_corpus.as_ref().map(|near| near.name.as_str()), Some("quiet-jars"));
    for part in [
        "Quiet Jars",
        "Does skill pay?",
        "made in 3.5 s",
        "Every game",
        "3 of 10",
        "Cost of the judges",
        "0.1 M",
        "olets:30 wins",
    ] {
        assert!(page.contains(part), "{part}");
    }
}
