//! A small set, one game of it in another dress.

use super::*;
use validators::{Difficulty, Panel};

/// Fetch all of something; other words for the same rules are the same game.
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
        ask: names(&["winnable", "skill", "rule-use"]),
        budget: 20_000,
        ladder: names(&["do-nothing", "random", "mcts:20"]),
        held_out: names(&["olets:40"]),
        ladder_plays: 4,
        ..Criteria::full()
    }
}

fn reported(title: &str, source: &str) -> ReportedGame {
    let game = Game::from_source(source).unwrap();
    let levels: Vec<Level> = LEVELS.iter().map(|text| game.level(text).unwrap()).collect();
    let report = Panel::new(&criteria()).judge_game(&game, &levels, Seed::from_text("judged"));
    ReportedGame { title: title.to_owned(), goal: "Take all of it.".to_owned(), game, levels, report }
}

fn report(games: &[ReportedGame], corpus: &[(String, Game)]) -> GameSetReport {
    let rejections = BTreeMap::from([("winnable".to_owned(), 3)]);
    let cost = GamesCost { calls: 9000, tried: 6, accepted: games.len() as u64, rejections };
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

fn example() -> Vec<ReportedGame> {
    vec![
        reported("Acorns", &source("acorn", "owl")),
        reported("Crates", PUSHING),
        reported("Pearls", &source("pearl", "crab")),
    ]
}

#[test]
fn a_set_is_told_by_its_games() {
    let corpus = [("berries".to_owned(), Game::from_source(&source("berry", "bear")).unwrap())];
    let games = example();
    let report = report(&games, &corpus);
    let counts = |share: Share| (share.count, share.of);
    assert_eq!((report.count, report.accepted.map(counts)), (3, Some((3, 6))));
    // Two are the same rules in other words, and a game of the corpus too.
    assert_eq!(counts(report.novelty.unique), (2, 3));
    assert_eq!(counts(report.novelty.near_duplicates), (2, 3));
    assert_eq!(counts(report.novelty.near_corpus), (2, 3));
    let nearest = report.games[0].nearest.as_ref().unwrap();
    assert_eq!((nearest.name.as_str(), nearest.distance), ("Pearls", 0.0));
    assert_eq!(report.novelty.among_corpus, None, "there is but one");
    let kinds: Vec<u64> = report.variety.kinds.iter().map(|kind| kind.games).collect();
    assert_eq!(kinds, [2, 1]);
    assert_eq!(report.variety.npcs.iter().map(|npc| npc.games.count).collect::<Vec<_>>(), [2]);
    let skill = report.skill.as_ref().unwrap();
    assert_eq!(skill.players.len(), 4, "those held out are told too");
    assert!(skill.held_out.is_some());
    let table = &report.difficulty.as_ref().unwrap().table;
    assert_eq!(table.iter().map(|counts| counts.iter().sum::<u64>()).collect::<Vec<_>>(), [3, 3]);
    let label = report.games[1].levels[0].label.unwrap();
    assert!(label < Difficulty::Unbeaten, "{label}");
    // The second interaction of the crates never runs in the open.
    assert_eq!(report.games[1].found.mechanics, Some(2), "{:?}", report.games[1].found);
    let text = report.to_json().unwrap();
    assert_eq!(serde_json::from_str::<GameSetReport>(&text).unwrap(), report);
}

#[test]
fn a_report_does_not_depend_on_threads() {
    let games = example();
    let text = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| report(&games, &[]).to_json().unwrap())
    };
    assert_eq!(text(1), text(3));
}

#[test]
fn a_set_of_nothing_has_no_figures() {
    let report = report(&[], &[]);
    assert_eq!((report.skill, report.difficulty, report.variety.largest), (None, None, None));
    assert_eq!((report.play.drama, report.novelty.nearest, report.rules.count), (None, None, None));
}
