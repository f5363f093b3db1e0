//! Tests with a small hand-made set whose figures are easy to count.

use super::*;
use crate::survey::LevelSurvey;
use base::Seed;
use engine::{Action, Episode, Game, Level};
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use validators::{
    Criteria, Criterion, Finding, Judgement, Ladder, Measures, PlayerResult, Rate, Reason, Report, Verdict,
};

const GAME: &str = "BasicGame\n  SpriteSet\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite\n    avatar EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n";

fn finding(verdict: Verdict, wins: u64, plays: u64) -> Finding {
    let rate = Rate { wins, plays, interval: [0.0, 1.0], calls: 0, mean_score: 0.0 };
    Finding::from(verdict).measured(rate)
}

fn fared(player: &str, looks_ahead: bool, wins: u64) -> PlayerResult {
    let rate = Rate { wins, plays: 4, interval: [0.0, 1.0], calls: 0, mean_score: wins as f64 };
    PlayerResult {
        player: player.to_owned(),
        looks_ahead,
        rate,
        win_ticks: None,
        reward: Some(wins as f64 / 4.0),
    }
}

/// Returns a level that is won by moving right `steps` times, with made-up verdicts. If `steps` is 0, the level is not
/// won.
fn judged(game: &Game, text: &str, steps: usize, [random, weak, strong]: [u64; 3]) -> SurveyedLevel {
    let level = game.level(text).unwrap();
    let (mut episode, mut state) = Episode::begin(game, &level, Seed::from_text("made up"));
    for _ in 0..steps {
        episode.play(game, &mut state, Action::Right);
    }
    let witness = (steps > 0).then_some(episode);
    let impossible = Verdict::Fail { reason: Reason("no way to win".to_owned()), witness: None };
    let winnable = match &witness {
        Some(won) => Verdict::Pass { witness: Some(won.clone()) },
        None => impossible,
    };
    let optimal = witness.is_some().then_some(steps);
    let rungs =
        vec![fared("random", false, random), fared("weak", true, weak), fared("strong", true, strong)];
    let difficulty = if strong > 2 { Difficulty::Easy } else { Difficulty::Hard };
    let ladder = Ladder { rungs, held_out: Vec::new(), ease: Some(0.5), difficulty };
    let judgements = [
        (Criterion::WellFormed, Verdict::pass().into()),
        (Criterion::NotIdle, finding(Verdict::pass(), 0, 1)),
        (Criterion::NotRandom, finding(Verdict::pass(), random, 20)),
        (Criterion::Winnable, Finding { optimal, ..winnable.into() }),
    ];
    let judgements =
        judgements.map(|(criterion, finding)| Judgement { criterion, finding }).into_iter().collect();
    let report = Report { judgements, witness };
    let seed = Seed::from_text("measures");
    let measures = Measures::of(&Analysis::of(game), &level, &report, Some(&ladder), seed);
    let free = level.cells().iter().filter(|symbol| **symbol != b'w').count() as f64;
    let openness = free / level.cells().len() as f64;
    let layout = vec![("openness".to_owned(), openness)];
    SurveyedLevel { level, report, ladder: Some(ladder), measures, layout, asked: None }
}

fn report(levels: &[SurveyedLevel], examples: &[SurveyedLevel], pool: &[Difficulty]) -> LevelSetReport {
    let game = Game::from_source(GAME).unwrap();
    let rejections = BTreeMap::from([("length".to_owned(), 8)]);
    let mut cost = Tally { levels_tried: 12, rejections, ..Tally::default() };
    (0..30).for_each(|_| cost.look(true, 300));
    let analysis = Analysis::of(&game);
    LevelSetReport::of(&Sample { analysis: &analysis, method: "search", levels, examples, pool, cost: &cost })
}

fn example() -> LevelSetReport {
    let game = Game::from_source(GAME).unwrap();
    let level = |text, steps, fared| judged(&game, text, steps, fared);
    let mut levels = vec![
        level("wwwwww\nwA  gw\nwwwwww\n", 3, [1, 2, 4]),
        level("wwwwww\nwA gpw\nwwwwww\n", 2, [3, 3, 4]),
        // The mirror image of the first level.
        level("wwwwww\nwg  Aw\nwwwwww\n", 0, [0, 0, 0]),
        level("wwwwwww\nwAp w w\nww  wgw\nwwwwwww\n", 0, [0, 0, 0]),
    ];
    for (judged, asked) in levels.iter_mut().zip([Difficulty::Easy, Difficulty::Medium, Difficulty::VeryHard])
    {
        judged.asked = Some(asked);
    }
    let examples = [level("wwwwww\nwA gpw\nwwwwww\n", 2, [0, 2, 4])];
    let pool = [Difficulty::Easy, Difficulty::Easy, Difficulty::Medium, Difficulty::VeryHard];
    report(&levels, &examples, &pool)
}

/// The format of the report is stable. This test may change only with [`REPORT_FORMAT`], or with a figure's
/// meaning.
#[test]
fn a_report_is_what_it_was() {
    let text = example().set.to_json().unwrap();
    assert_eq!(text, include_str!("golden.json"), "the report has moved; it reads\n{text}");
}

/// Parses the report as an external program would.
fn read(report: &LevelSetReport) -> Json {
    serde_json::from_str(&report.set.to_json().unwrap()).unwrap()
}

fn counts(share: &Json) -> [u64; 2] {
    ["count", "of"].map(|key| share[key].as_u64().unwrap())
}

#[test]
fn verdicts_are_counted() {
    let report = example();
    let json = read(&report);
    let solvability = &json["solvability"];
    assert_eq!(
        ["solved", "impossible", "unknown"].map(|key| counts(&solvability[key])),
        [[2, 4], [2, 4], [0, 4]]
    );
    assert_eq!(counts(&json["triviality"]["random"]), [4, 80]);
    assert_eq!(counts(&json["triviality"]["random_levels"]), [3, 4]);
    assert_eq!(json["validity"]["obstacles"]["winnable"], 2);
    assert_eq!(
        (&json["lengths"]["shortest"]["median"], &json["lengths"]["pushes"]),
        (&json!(2.5), &Json::Null)
    );
    let fit: Vec<(&str, u64)> =
        report.fits.iter().map(|fit| (fit.measure.as_str(), fit.within.count)).collect();
    assert_eq!(fit, [("columns", 3), ("rows", 3), ("openness", 3)]);
}

#[test]
fn players_and_rules_are_summed_up() {
    let json = read(&example());
    let skill = &json["skill"];
    assert_eq!(skill["players"][2]["wins"]["count"], 8);
    // The levels without a witness have no measures, and therefore no gap.
    assert_eq!(skill["wins"]["levels"], 2);
    // On the second level, two players do equally well. No order exists where all players do equally well.
    let order = &skill["order"];
    assert_eq!(order["levels"], 2);
    assert!(
        (order["mean"].as_f64().unwrap() - (1.0 + 0.866_025_403_784_438_6) / 2.0).abs() < 1e-12,
        "{order:?}"
    );
    assert_eq!(counts(&json["rules"]["used"]), [1, 3], "the rule at the edge is a guard");
    let lines = json["rules"]["lines"].as_array().unwrap();
    assert_eq!(lines.iter().map(|line| counts(&line["levels"])[0]).collect::<Vec<_>>(), [0, 0, 2, 0]);
}

#[test]
fn mirror_images_are_one_level_and_copies_are_told() {
    let json = read(&example());
    assert_eq!(counts(&json["diversity"]["unique"]), [3, 4]);
    let novelty = &json["novelty"];
    assert_eq!([&novelty["copies"], &novelty["near_duplicates"]].map(|share| counts(share)[0]), [1, 1]);
    let nearest = &novelty["nearest"];
    assert!(nearest["min"] == 0.0 && nearest["max"].as_f64().unwrap() > 0.5, "{nearest:?}");
}

#[test]
fn asked_labels_stand_beside_random_picking() {
    // Requested: easy, medium, very hard. Measured: easy, easy, hard.
    let report = example();
    let control = &read(&report)["control"];
    assert_eq!(control["pool"], json!([0, 2, 1, 0, 1, 0]));
    assert_eq!(control["expressible"], json!([Difficulty::Easy, Difficulty::Medium, Difficulty::VeryHard]));
    let all = &control["all"];
    assert_eq!((counts(&all["exact"]), counts(&all["within_one"])[0]), ([1, 3], 3));
    // In the pool of levels without a requested difficulty, 4, 2, 1 and 1 levels have the label, and 3, 3 and 1 levels
    // have the label or a neighbouring one.
    let close = |key: &str, expect: f64| (all[key].as_f64().unwrap() - expect).abs() < 1e-12;
    assert!(close("random_exact", 1.0 / 3.0) && close("random_within_one", 7.0 / 12.0));
    let asked = report.set.tables.iter().find(|table| table.id == "asked").unwrap();
    assert_eq!(asked.rows.len(), 4, "three labels and the pool");
}

#[test]
fn a_level_that_nobody_could_measure_is_a_miss() {
    let game = Game::from_source(GAME).unwrap();
    let asked = |ladder: bool| {
        let level = judged(&game, "wwwwww\nwA  gw\nwwwwww\n", 3, [1, 2, 4]);
        let ladder = level.ladder.clone().filter(|_| ladder);
        SurveyedLevel { asked: Some(Difficulty::Easy), ladder, ..level }
    };
    let control = &read(&report(&[asked(true), asked(false)], &[], &[]))["control"];
    assert_eq!(counts(&control["all"]["exact"]), [1, 2]);
    assert_eq!((&control["table"][1][1], &control["unmeasured"][1]), (&json!(1), &json!(1)));
    assert_eq!(
        control["expressible"].as_array().unwrap().len(),
        5,
        "nobody can ask for a level that is unbeaten"
    );
    assert_eq!(read(&report(&[asked(false)], &[], &[]))["control"], Json::Null);
}

#[test]
fn a_set_of_nothing_has_no_figures() {
    let report = report(&[], &[], &[]);
    let json = read(&report);
    let of = |section: &str, key: &str| json[section][key].clone();
    assert_eq!([&json["skill"], &json["novelty"], &json["control"]], [&Json::Null; 3]);
    assert_eq!([of("diversity", "distance"), of("lengths", "ticks")], [Json::Null, Json::Null]);
    assert!(report.ranges.is_empty() && report.fits.is_empty());
}

#[test]
fn ranges_bin_the_levels_that_have_both_measures() {
    let report = example();
    let axes: Vec<(&str, &str)> =
        report.ranges.iter().map(|range| (range.x.measure.as_str(), range.y.measure.as_str())).collect();
    assert_eq!(axes, [("openness", "ticks"), ("ticks", "branching"), ("mechanics", "skill")]);
    let range = &report.ranges[0];
    assert_eq!((range.levels.len(), range.examples.len(), range.occupied), (2, 1, 2));
    assert_eq!((range.x.high, range.y.high), (1.0, 10.0));
    assert_eq!(range.cells.iter().flatten().sum::<u64>(), 2);
}

#[test]
fn a_survey_is_the_same_on_any_number_of_threads_and_for_a_level_alone() {
    let game = Game::from_source(GAME).unwrap();
    let analysis = Analysis::of(&game);
    let texts = ["wwwwwwwww\nwA   w  w\nw wp wp w\nw  w   gw\nwwwwwwwww\n", "wwwwww\nwA  gw\nwwwwww\n"];
    let levels = texts.map(|text| (game.level(text).unwrap(), Some(Difficulty::Easy)));
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    let criteria = Criteria {
        budget: 20_000,
        ladder: names(&["do-nothing", "random", "mcts:20"]),
        ladder_plays: 2,
        most_ticks: 60,
        ..Criteria::full()
    };
    let survey = LevelSurvey::new(&analysis, &criteria, Seed::from_text("survey")).unwrap();
    let judge = |threads: usize, levels: &[(Level, Option<Difficulty>)]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| report(&survey.judge(levels), &[], &[]))
    };
    let both = judge(1, &levels);
    assert_eq!(both, judge(3, &levels));
    let alone = judge(2, &levels[..1]);
    assert_eq!(LevelRow { nearest: None, ..both.levels[0].clone() }, alone.levels[0]);
    // A level that fails a criterion is still judged by the others, and the reference players still determine its
    // difficulty label.
    assert!(both.levels[0].passes && !both.levels[1].passes && both.levels[1].solved == "solved");
    assert!(both.set.figure("control", "exact").is_some());
    assert!(both.levels[0].measures.contains_key("openness"));
}
