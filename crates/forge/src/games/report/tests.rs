//! Tests with a small set in which one game occurs in two themes.

use super::*;
use engine::Level;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use validators::{Criterion, CriterionSet, Difficulty, Effort, Judging, Panel};

/// Returns a game in which the player collects all objects of one kind. Two such games with different names but the
/// same rules count as the same game.
fn source(thing: &str, danger: &str) -> String {
    format!(
        "BasicGame\n  SpriteSet\n    {thing} > Immovable\n    {danger} > RandomNPC cooldown=2\n    avatar > MovingAvatar\n  LevelMapping\n    g > {thing}\n    r > {danger}\n  InteractionSet\n    avatar wall > stepBack\n    {danger} wall > stepBack\n    avatar {danger} > killSprite\n    {thing} avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype={thing} win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=50 win=False\n"
    )
}

const PUSHING: &str = "BasicGame\n  SpriteSet\n    pit > Immovable\n    crate > Passive\n    avatar > MovingAvatar\n  LevelMapping\n    g > crate\n    r > pit\n  InteractionSet\n    avatar wall > stepBack\n    crate wall pit > undoAll\n    crate avatar > bounceForward\n    crate pit > killSprite\n    avatar pit > stepBack\n  TerminationSet\n    SpriteCounter stype=crate win=True\n    Timeout limit=50 win=False\n";

const LEVELS: [&str; 2] =
    ["wwwwwwww\nwA  g rw\nw      w\nwwwwwwww\n", "wwwwwwww\nwA g  rw\nw  w g w\nwr     w\nwwwwwwww\n"];

fn criteria() -> Criteria {
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    Criteria {
        ask: CriterionSet::of(&[Criterion::Winnable, Criterion::Skill, Criterion::RuleUse]),
        budget: 20_000,
        ladder: names(&["do-nothing", "random", "mcts:20"]),
        held_out: names(&["olets:40"]),
        ladder_plays: 4,
        ..Criteria::full()
    }
}

fn reported(title: &str, source: &str) -> SurveyedGame {
    let game = Game::from_source(source).unwrap();
    let levels: Vec<Level> = LEVELS.iter().map(|text| game.level(text).unwrap()).collect();
    let panel = Panel::new(criteria().check().unwrap(), Effort::Full);
    let report = panel.judge(Judging::game(&game, &levels, Seed::from_text("judged")));
    SurveyedGame { name: title.to_owned(), goal: "Take all of it.".to_owned(), game, levels, report }
}

fn report(games: &[SurveyedGame], corpus: &[(String, Game)]) -> GameSetReport {
    let rejections = BTreeMap::from([("winnable".to_owned(), 3)]);
    let mut cost = Tally { games_tried: 6, rejections, ..Tally::default() };
    cost.judge("winnable", true, 9000);
    let seed = Seed::from_text("report");
    GameSetReport::of(&GamesSample {
        method: "search",
        games,
        corpus,
        criteria: &criteria(),
        cost: Some(&cost),
        seed,
    })
}

fn example() -> Vec<SurveyedGame> {
    vec![
        reported("Acorns", &source("acorn", "owl")),
        reported("Crates", PUSHING),
        reported("Pearls", &source("pearl", "crab")),
    ]
}

/// Parses the report as an external program would.
fn read(report: &GameSetReport) -> Json {
    serde_json::from_str(&report.set.to_json().unwrap()).unwrap()
}

#[test]
fn a_set_is_told_by_its_games() {
    let corpus = [("berries".to_owned(), Game::from_source(&source("berry", "bear")).unwrap())];
    let games = example();
    let report = report(&games, &corpus);
    let json = read(&report);
    let counts = |share: &Json| [&share["count"], &share["of"]].map(|count| count.as_u64().unwrap());
    assert_eq!((&json["count"], counts(&json["accepted"])), (&json!(3), [3, 6]));
    // Two games have the same rules under different names. A corpus game has these rules as well.
    for key in ["unique", "near_duplicates", "near_corpus"] {
        assert_eq!(counts(&json["novelty"][key]), [2, 3], "{key}");
    }
    let nearest = report.games[0].nearest.as_ref().unwrap();
    assert_eq!((nearest.name.as_str(), nearest.distance), ("Pearls", 0.0));
    assert_eq!(json["novelty"]["among_corpus"], Json::Null, "there is but one");
    let variety = &json["variety"];
    let kinds = variety["kinds"].as_array().unwrap();
    assert_eq!(kinds.iter().map(|kind| &kind["games"]).collect::<Vec<_>>(), [&json!(2), &json!(1)]);
    assert_eq!(variety["npcs"].as_array().unwrap().len(), 1);
    assert_eq!(counts(&variety["npcs"][0]["games"])[0], 2);
    let skill = &json["skill"];
    assert_eq!(skill["players"].as_array().unwrap().len(), 4, "those held out are told too");
    assert_ne!(skill["held_out"], Json::Null);
    let table = json["difficulty"]["table"].as_array().unwrap().iter();
    let sums = table.map(|counts| counts.as_array().unwrap().iter().filter_map(Json::as_u64).sum::<u64>());
    assert_eq!(sums.collect::<Vec<_>>(), [3, 3]);
    let label = report.games[1].levels[0].label.unwrap();
    assert!(label < Difficulty::Unbeaten, "{label}");
    // The crates' second interaction never executes on an open board.
    assert_eq!(report.games[1].found.mechanics, Some(2), "{:?}", report.games[1].found);
    let tables: Vec<&str> = report.set.tables.iter().map(|table| table.id.as_str()).collect();
    assert_eq!(tables, ["kinds", "difficulty", "judges", "games"]);
}

#[test]
fn a_report_does_not_depend_on_threads() {
    let games = example();
    let report = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| report(&games, &[]))
    };
    assert_eq!(report(1), report(3));
}

#[test]
fn a_set_of_nothing_has_no_figures() {
    let json = read(&report(&[], &[]));
    let of = |section: &str, key: &str| json[section][key].clone();
    assert_eq!([&json["skill"], &json["difficulty"]], [&Json::Null; 2]);
    for (section, key) in
        [("variety", "largest"), ("play", "drama"), ("novelty", "nearest"), ("rules", "count")]
    {
        assert_eq!(of(section, key), Json::Null, "{section} {key}");
    }
}
