//! Tests of reports on the published win rates in `docs/reference/spec/paper-winrates.csv` (`spec/06` §3,
//! §3.1 and §5.1).

use super::episode;
use engine::Outcome;
use evaluation::metrics::EpisodeMetrics;
use evaluation::study::{CONTEXTUAL, Player, Scope, Study, ZERO_SHOT};
use report::TableCell;
use std::path::Path;

/// The number of levels per game in the paper's main experiment.
const LEVELS: u64 = 5;
/// The number of runs per level in the paper's main experiment.
const RUNS: u64 = 5;

/// A row of the published table: a player, and its number of wins in 25 episodes on each game.
type Row = (Player, Vec<(String, u64)>);

fn published() -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/spec/paper-winrates.csv");
    let mut reader = csv::Reader::from_path(path).unwrap();
    let games: Vec<String> = reader.headers().unwrap().iter().skip(2).map(str::to_owned).collect();
    let row = |record: csv::StringRecord| {
        let player = match &record[1] {
            "llm-zero-shot" => Player::model(&record[0], ZERO_SHOT),
            "llm-contextual" => Player::model(&record[0], CONTEXTUAL),
            _ => Player::reference(&record[0]),
        };
        let wins =
            record.iter().skip(2).map(|rate| (rate.parse::<f64>().unwrap() * 25.0 / 100.0).round() as u64);
        (player, games.iter().cloned().zip(wins).collect())
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// Returns episodes with the given numbers of wins, distributed over the levels in turn.
fn episodes(wins: &[(String, u64)]) -> Vec<EpisodeMetrics> {
    let mut episodes = Vec::new();
    for (game, wins) in wins {
        for number in 0..LEVELS * RUNS {
            let outcome = if number < *wins { Outcome::Won } else { Outcome::Lost };
            episodes.push(episode(game, (number % LEVELS) as usize, number / LEVELS, outcome, 0.0, 10));
        }
    }
    episodes
}

fn study(rows: &[Row], keep: impl Fn(&Player) -> bool) -> Study {
    let kept = rows.iter().filter(|(player, _)| keep(player));
    Study::new(kept.map(|(player, wins)| (player.clone(), episodes(wins))).collect(), Vec::new())
}

/// Wilson's intervals for each number of wins in 25 episodes, to the two digits that `spec/06` §3.1 prints.
const PRINTED: [(u64, &str); 21] = [
    (0, "0.00 [0.00, 0.13]"),
    (1, "0.04 [0.01, 0.20]"),
    (2, "0.08 [0.02, 0.25]"),
    (3, "0.12 [0.04, 0.30]"),
    (4, "0.16 [0.06, 0.35]"),
    (6, "0.24 [0.11, 0.43]"),
    (7, "0.28 [0.14, 0.48]"),
    (8, "0.32 [0.17, 0.52]"),
    (9, "0.36 [0.20, 0.55]"),
    (10, "0.40 [0.23, 0.59]"),
    (11, "0.44 [0.27, 0.63]"),
    (13, "0.52 [0.33, 0.70]"),
    (14, "0.56 [0.37, 0.73]"),
    (15, "0.60 [0.41, 0.77]"),
    (16, "0.64 [0.45, 0.80]"),
    (17, "0.68 [0.48, 0.83]"),
    (18, "0.72 [0.52, 0.86]"),
    (19, "0.76 [0.57, 0.89]"),
    (20, "0.80 [0.61, 0.91]"),
    (24, "0.96 [0.80, 0.99]"),
    (25, "1.00 [0.87, 1.00]"),
];

#[test]
fn wilson_table() {
    let rows = published();
    let study = study(&rows, |_| true);
    let mut compared = 0;
    for scope in [Scope::ZeroShot, Scope::Contextual] {
        let id = format!("win-rate-by-game-{}", scope.name());
        let table =
            study.tables().into_iter().find(|table| table.id == id).expect("every scope has its table");
        let markdown = table.to_markdown();
        let lines: Vec<Vec<&str>> = markdown
            .lines()
            .filter(|line| line.starts_with("| "))
            .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
            .collect();
        let shown = rows
            .iter()
            .filter(|(player, _)| player.is_reference() || player.mode.as_deref() == Some(scope.name()));
        for (player, wins) in shown {
            let column =
                lines[0].iter().position(|name| *name == player.name).expect("every player has a column");
            for (game, wins) in wins {
                let line = lines.iter().find(|line| line[0] == game).expect("every game has a row");
                let expect =
                    PRINTED.iter().find(|(count, _)| count == wins).expect("all counts are listed").1;
                assert_eq!(line[column], expect, "{} on {game}", player.label());
                compared += 1;
            }
        }
    }
    assert_eq!(compared, (14 + 11) * 6);
}

#[test]
fn sums() {
    let rows = published();
    let study = study(&rows, |player| !player.is_reference());
    let of = |mode: &str| {
        let rows =
            study.leaderboard.iter().filter(|row| study.players[row.player].mode.as_deref() == Some(mode));
        rows.fold((0, 0), |sum, row| (sum.0 + row.scores.wins, sum.1 + row.scores.episodes))
    };
    assert_eq!((of(ZERO_SHOT), of(CONTEXTUAL)), ((248, 1350), (99, 900)));
    let wins = |name: &str, mode: &str| {
        let player = Player::model(name, mode);
        let row = study.leaderboard.iter().find(|row| study.players[row.player] == player).unwrap();
        (row.scores.wins, row.scores.episodes)
    };
    for (name, zero_shot, contextual) in [
        ("GPT-4o-mini", 3, 4),
        ("o3-mini", 62, 36),
        ("Gemini-2.0-flash", 4, 6),
        ("Gemini-2.5-pro", 23, 31),
        ("Llama-3.1-405b", 2, 9),
        ("Llama-3.2-90b", 0, 13),
    ] {
        assert_eq!(
            (wins(name, ZERO_SHOT), wins(name, CONTEXTUAL)),
            ((zero_shot, 150), (contextual, 150)),
            "{name}"
        );
    }
    for (name, zero_shot) in [("Gemini-3-flash", 81), ("DeepSeek-Chat", 15), ("DeepSeek-r3.2", 58)] {
        assert_eq!(wins(name, ZERO_SHOT), (zero_shot, 150), "{name}");
    }
    assert_eq!(study.leaderboard[0].scores.wins, 81);
    let failures = &study.failures[0];
    assert_eq!(failures.excluded, 2250, "no step flags are published");
}

/// With 25 episodes per side, the prompt mode has significant effects, which five episodes per side cannot
/// show.
#[test]
fn prompt_modes_differ_significantly() {
    let rows = published();
    let study = study(&rows, |_| true);
    assert_eq!((study.modes.by_game.len(), study.modes.by_level.len()), (36, 180));
    let found = |name: &str| {
        let is_it = |players: [usize; 2]| players.iter().all(|&player| study.players[player].name == name);
        study.modes.by_game.iter().find(|c| is_it(c.players) && study.games[c.game].id == "aliens").unwrap()
    };
    let (llama, gemini) = (found("Llama-3.2-90b"), found("Gemini-2.5-pro"));
    assert_eq!((llama.wins, gemini.wins), ([0, 13], [4, 16]));
    assert!((llama.p - 2.930898044e-5).abs() < 1e-13 && (gemini.p - 0.001208589982).abs() < 1e-11);
    assert_eq!(
        (format!("{:.4}", llama.q), format!("{:.3}", gemini.q)),
        ("0.0011".to_owned(), "0.022".to_owned())
    );
    assert!((gemini.h + 1.031557).abs() < 1e-6);
    let believed = study.modes.by_game.iter().filter(|comparison| comparison.q <= 0.05).count();
    assert_eq!(believed, 2);
}

#[test]
fn pairs_of_models() {
    let rows = published();
    let study = study(&rows, |player| player.mode.as_deref() == Some(ZERO_SHOT));
    assert_eq!(
        (study.pairs.by_game.len(), study.pairs.by_level.len(), study.pairs.overall.len()),
        (216, 1080, 36)
    );
    assert_eq!(study.pairs.by_game.iter().filter(|comparison| comparison.q <= 0.05).count(), 75);
}

/// Compares a model with and without an aid. On aliens, it has no win without the aid and two with it. On
/// escape, it has no win without the aid and one with it.
#[test]
fn aids_are_compared() {
    let games =
        |wins: [u64; 2]| ["aliens", "escape"].map(str::to_owned).into_iter().zip(wins).collect::<Vec<_>>();
    let with = Player { aids: vec!["coordinates".to_owned()], ..Player::model("GPT-4o-mini", ZERO_SHOT) };
    let without = Player::model("GPT-4o-mini", ZERO_SHOT);
    let results = vec![(with, episodes(&games([2, 1]))), (without, episodes(&games([0, 0])))];
    let study = Study::new(results, Vec::new());
    let found: Vec<([u64; 2], f64)> = study.aids.by_game.iter().map(|found| (found.wins, found.p)).collect();
    assert_eq!((found[0].0, found[1].0), ([0, 2], [0, 1]));
    assert!((found[0].1 - 0.4897959184).abs() < 1e-10 && (found[1].1 - 1.0).abs() < 1e-12);
    assert!((study.aids.by_game[0].h + 0.573513).abs() < 1e-6);
    assert!(study.pairs.is_empty() && study.modes.is_empty());
    let table = study.tables().into_iter().find(|table| table.id == "aids-by-game").unwrap();
    assert_eq!(table.rows.len(), 2);
    assert!(table.rows[0].contains(&TableCell::text("0/25")));
}
