//! Tests with games that are won in a few steps and have figures that are easy to count.

use super::row::NO_WIN;
use super::*;
use base::{Digest, Seed};
use engine::{Game, Level};
use validators::Criteria;

/// Returns a game in which the player collects a gem. `extra` can add `idle` sprites and superfluous rules.
fn game(extra: [&str; 2]) -> Game {
    let [sprites, rules] = extra;
    let source = format!(
        "BasicGame\n  SpriteSet\n    gem > Immovable\n    pit > Immovable\n{sprites}    avatar > MovingAvatar\n  LevelMapping\n    g > gem\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar EOS > stepBack\n    avatar pit > killSprite\n    gem avatar > killSprite scoreChange=1\n{rules}  TerminationSet\n    SpriteCounter stype=gem win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n"
    );
    Game::from_source(&source).unwrap()
}

fn row_of(survey: &GameSurvey, name: &str, game: &Game) -> GameRow {
    let levels = ["wwwwwwww\nwA     w\nw pp p w\nw    pgw\nwwwwwwww\n", "wwwwww\nwA  gw\nwwwwww\n"];
    let levels: Vec<Level> = levels.iter().map(|text| game.level(text).unwrap()).collect();
    survey.row(name, game, &levels)
}

fn survey() -> GameSurvey {
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    let criteria = Criteria {
        budget: 20_000,
        ladder: names(&["do-nothing", "random", "mcts:20", "mcts:200"]),
        ladder_plays: 4,
        ..GameSurvey::criteria()
    };
    GameSurvey::new(&criteria, Seed::from_text("survey")).unwrap()
}

#[test]
fn a_row_tells_what_play_shows() {
    let row = row_of(&survey(), "fetch", &game(["", ""]));
    assert_eq!((row.levels, row.won), (2, 2));
    // Rules for stepping back from walls, or for the edge of the board, do not count.
    assert_eq!((row.rules, row.executed), (2, 2), "{row:?}");
    assert_eq!((row.types, row.there), (3, 3), "{row:?}");
    assert_eq!(row.mechanics, Some(1));
    let edge = row.edge.unwrap();
    // The game is deterministic, so a player that knows the way wins all episodes.
    assert_eq!((edge.wins, edge.plays), (8, 8), "{edge:?}");
    assert!(edge.pays && edge.points >= 0.25 && edge.interval[0] > 0.0, "{edge:?}");
    assert!(row.order.unwrap() > 0.5, "{:?}", row.order);
}

#[test]
fn what_is_never_there_is_dead() {
    let rules = ["    key > Resource\n", "    key avatar > collectResource\n"];
    let row = row_of(&survey(), "dead", &game(rules));
    assert_eq!((row.rules, row.executed), (3, 2), "{row:?}");
    assert_eq!((row.types, row.there), (4, 3), "{row:?}");
}

#[test]
fn a_row_does_not_depend_on_threads_or_neighbours() {
    let games = [("a", game(["", ""])), ("b", game(["    key > Resource\n", ""]))];
    let rows = |threads: usize, games: &[(&str, Game)]| -> Vec<GameRow> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let survey = survey();
        pool.install(|| games.iter().map(|(name, game)| row_of(&survey, name, game)).collect())
    };
    let both = rows(1, &games);
    assert_eq!(both, rows(3, &games));
    assert_eq!(both[1..], rows(2, &games[1..]));
    assert_ne!(both[0].digest, both[1].digest);
}

fn row(pays: bool, rules: u64, drama: Option<f64>) -> GameRow {
    let edge = Edge {
        strongest: "mcts:100".to_owned(),
        wins: 5,
        plays: 10,
        floor: "random".to_owned(),
        floor_wins: 0,
        points: 0.5,
        interval: [0.1, 0.8],
        score: None,
        score_interval: None,
        pays,
    };
    GameRow {
        name: String::new(),
        digest: Digest::of(b""),
        levels: 3,
        won: u64::from(drama.is_some()),
        rules,
        executed: rules,
        types: 4,
        there: 3,
        edge: Some(edge),
        order: Some(1.0),
        mechanics: drama.map(|_| 4),
        drama,
        calls: 0,
    }
}

#[test]
fn groups_are_compared_line_by_line() {
    let ours = vec![row(true, 12, Some(0.5)); 8];
    let mut theirs = vec![row(false, 6, Some(0.9)); 6];
    theirs.push(row(true, 6, None));
    theirs.push(row(true, 6, None));
    let comparison = Comparison::of(&ours, &theirs, Seed::from_text("compare"));
    let line = |name: &str| comparison.lines.iter().find(|line| line.name == name).unwrap();
    let pays = line("skill pays");
    assert_eq!((pays.ours.mean, pays.theirs.mean, pays.level), (Some(1.0), Some(0.25), Some(true)));
    assert!(pays.interval.unwrap()[0] > 0.3, "{pays:?}");
    // Twice as many rules correspond to 100 points more.
    assert_eq!((line("rules").difference, line("rules").points), (Some(6.0), Some(100.0)));
    let drama = line("drama");
    assert_eq!((drama.theirs.games, &drama.theirs.left_out), (6, &vec![(NO_WIN.to_owned(), 2)]));
    assert_eq!((drama.level, drama.points.map(f64::round)), (Some(false), Some(-40.0)));
    assert_eq!(line("no dead sprites").interval, Some([0.0, 0.0]));
    assert!(comparison.table().to_markdown().contains(
        "Ours are at least equal to theirs on 6 of 7 lines. mechanics in winning play, theirs: 2 left out, no win found."
    ));
    let nobody = Comparison::of(&ours, &[], Seed::from_text("compare"));
    assert!(nobody.lines.iter().all(|line| line.difference.is_none() && line.level.is_none()));
}
