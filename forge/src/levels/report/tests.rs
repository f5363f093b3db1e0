//! A small set made by hand, whose figures can be counted on fingers.

use super::*;
use engine::{Action, Episode, Game, Seed};
use validators::{Criteria, Fared, Finding, Judgement, Ladder, Rate, Reason, Verdict};

const GAME: &str = "BasicGame\n  SpriteSet\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite\n    avatar EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n";

fn finding(verdict: Verdict, wins: u64, plays: u64) -> Finding {
    let rate = Rate { wins, plays, interval: [0.0, 1.0], calls: 0, mean_score: 0.0 };
    Finding::from(verdict).measured(rate)
}

fn fared(player: &str, looks_ahead: bool, wins: u64) -> Fared {
    let rate = Rate { wins, plays: 4, interval: [0.0, 1.0], calls: 0, mean_score: wins as f64 };
    Fared { player: player.to_owned(), looks_ahead, rate, win_ticks: None, reward: Some(wins as f64 / 4.0) }
}

/// A level that is won by so many steps to the right, if any, and what its judges may have said.
fn judged(game: &Game, text: &str, steps: usize, [random, weak, strong]: [u64; 3]) -> Judged {
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
        ("well-formed", Verdict::pass().into()),
        ("not-idle", finding(Verdict::pass(), 0, 1)),
        ("not-random", finding(Verdict::pass(), random, 20)),
        ("winnable", Finding { optimal, ..winnable.into() }),
    ];
    let judgements =
        judgements.map(|(criterion, finding)| Judgement { criterion, finding }).into_iter().collect();
    let report = Report { judgements, witness };
    let seed = Seed::from_text("measures");
    let measures = Measures::of(&Analysis::of(game), &level, &report, Some(&ladder), seed);
    let free = level.cells().iter().filter(|symbol| **symbol != b'w').count() as f64;
    let openness = free / level.cells().len() as f64;
    let layout = vec![("openness".to_owned(), openness)];
    Judged { level, report, ladder: Some(ladder), measures, layout, asked: None }
}

fn report(levels: &[Judged], examples: &[Judged], pool: &[Difficulty]) -> LevelSetReport {
    let game = Game::from_source(GAME).unwrap();
    let rejections = BTreeMap::from([("length".to_owned(), 8)]);
    let cost = Cost { looks: 30, judged: 12, calls: 9000, rejections };
    let (analysis, cost) = (Analysis::of(&game), Expense::of(&cost, levels.len()));
    LevelSetReport::of(&Sample { analysis: &analysis, method: "search", levels, examples, pool, cost: &cost })
}

fn example() -> LevelSetReport {
    let game = Game::from_source(GAME).unwrap();
    let level = |text, steps, fared| judged(&game, text, steps, fared);
    let mut levels = vec![
        level("wwwwww\nwA  gw\nwwwwww\n", 3, [1, 2, 4]),
        level("wwwwww\nwA gpw\nwwwwww\n", 2, [3, 3, 4]),
        // The first, mirrored.
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

/// The form of the report is a promise: this moves with [`REPORT_FORMAT`] only, or with what a figure means.
#[test]
fn a_report_is_what_it_was() {
    let text = example().to_json().unwrap();
    assert_eq!(text, include_str!("golden.json"), "the report has moved; it reads\n{text}");
    let read: LevelSetReport = serde_json::from_str(&text).unwrap();
    assert_eq!(read, example());
}

#[test]
fn verdicts_are_counted() {
    let report = example();
    let counts = |share: Share| (share.count, share.of);
    assert_eq!(counts(report.solvability.solved), (2, 4));
    assert_eq!(counts(report.solvability.impossible), (2, 4));
    assert_eq!(counts(report.solvability.unknown), (0, 4));
    assert_eq!(counts(report.triviality.random), (4, 80));
    assert_eq!(counts(report.triviality.random_levels), (3, 4));
    assert_eq!(report.validity.obstacles.get("winnable"), Some(&2));
    assert_eq!(report.lengths.shortest.map(|ticks| ticks.median), Some(2.5));
    assert_eq!(report.lengths.pushes, None);
    let fit: Vec<(&str, u64)> =
        report.validity.fit.iter().map(|fit| (fit.measure.as_str(), fit.within.count)).collect();
    assert_eq!(fit, [("columns", 3), ("rows", 3), ("openness", 3)]);
}

#[test]
fn players_and_rules_are_summed_up() {
    let report = example();
    let skill = report.skill.unwrap();
    assert_eq!(skill.players[2].wins.count, 8);
    // The levels without a witness have no measures, and so no gap.
    assert_eq!(skill.wins.levels, 2);
    // On the second level two players fare alike; where all do, there is no order.
    let order = skill.order.unwrap();
    assert_eq!(order.levels, 2);
    assert!((order.mean - (1.0 + 0.866_025_403_784_438_6) / 2.0).abs() < 1e-12, "{order:?}");
    let rules = report.rules;
    assert_eq!((rules.used.count, rules.used.of), (1, 3), "the rule at the edge is a guard");
    assert_eq!(rules.lines.iter().map(|line| line.levels.count).collect::<Vec<_>>(), [0, 0, 2, 0]);
}

#[test]
fn mirror_images_are_one_level_and_copies_are_told() {
    let report = example();
    assert_eq!((report.diversity.unique.count, report.diversity.unique.of), (3, 4));
    let novelty = report.novelty.unwrap();
    assert_eq!((novelty.copies.count, novelty.near_duplicates.count), (1, 1));
    let nearest = novelty.nearest.unwrap();
    assert!(nearest.min == 0.0 && nearest.max > 0.5, "{nearest:?}");
}

#[test]
fn asked_labels_stand_beside_random_picking() {
    // Asked easy, medium, very hard; measured easy, easy, hard.
    let control = example().control.unwrap();
    assert_eq!(control.pool, [0, 2, 1, 0, 1, 0]);
    assert_eq!(control.expressible, [Difficulty::Easy, Difficulty::Medium, Difficulty::VeryHard]);
    assert_eq!((control.all.exact.count, control.all.exact.of), (1, 3));
    assert_eq!(control.all.within_one.count, 3);
    // Of the pool 2, 1 and 1 of 4 have the label; 3, 3 and 1 have it or a neighbouring one.
    let close = |found: Option<f64>, expect: f64| (found.unwrap() - expect).abs() < 1e-12;
    assert!(close(control.all.random_exact, 1.0 / 3.0) && close(control.all.random_within_one, 7.0 / 12.0));
}

#[test]
fn a_level_that_nobody_could_measure_is_a_miss() {
    let game = Game::from_source(GAME).unwrap();
    let asked = |ladder: bool| {
        let level = judged(&game, "wwwwww\nwA  gw\nwwwwww\n", 3, [1, 2, 4]);
        let ladder = level.ladder.clone().filter(|_| ladder);
        Judged { asked: Some(Difficulty::Easy), ladder, ..level }
    };
    let control = report(&[asked(true), asked(false)], &[], &[]).control.unwrap();
    assert_eq!((control.all.exact.count, control.all.exact.of), (1, 2));
    assert_eq!((control.table[1][1], control.unmeasured[1]), (1, 1));
    assert_eq!(control.expressible.len(), 5, "nobody can ask for a level that is unbeaten");
    assert_eq!(report(&[asked(false)], &[], &[]).control, None);
}

#[test]
fn a_set_of_nothing_has_no_figures() {
    let report = report(&[], &[], &[]);
    assert_eq!((report.skill, report.novelty, report.control), (None, None, None));
    assert_eq!((report.diversity.distance, report.lengths.ticks), (None, None));
    assert!(report.ranges.is_empty() && report.validity.fit.is_empty());
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
    let survey = Survey::new(&analysis, &criteria, Seed::from_text("survey")).unwrap();
    let judge = |threads: usize, levels: &[(Level, Option<Difficulty>)]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| report(&survey.judge(levels), &[], &[]))
    };
    let both = judge(1, &levels);
    assert_eq!(both.to_json(), judge(3, &levels).to_json());
    let alone = judge(2, &levels[..1]);
    assert_eq!(LevelRow { nearest: None, ..both.levels[0].clone() }, alone.levels[0]);
    // A level that fails a criterion is asked the others all the same, and the ladder tells its label.
    assert!(both.levels[0].passes && !both.levels[1].passes && both.levels[1].solved == "solved");
    assert!(both.control.is_some() && both.levels[0].measures.contains_key("openness"));
}
