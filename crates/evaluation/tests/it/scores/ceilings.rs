//! Tests of win rates relative to ceilings, which are the highest known win rates on the levels.

use super::episode;
use engine::Outcome::{Lost, Won};
use evaluation::metrics::EpisodeMetrics;
use evaluation::study::{Player, Study, StudyGame};
use evaluation::{Commitment, LevelCeiling};

/// Returns a study of a player on two games with two levels each. The first level of each game is without randomness. The
/// second level has a ceiling of 0.9 for one action per decision, 0.8 for ten, and 0.05 for a whole plan. The player
/// wins six of ten episodes on each level.
fn study(commit: &str) -> Study {
    let commit: Commitment = commit.parse().unwrap();
    let mut episodes = Vec::new();
    for (game, level, run) in
        (0..2).flat_map(|game| (0..2).flat_map(move |level| (0..10).map(move |run| (game, level, run))))
    {
        let outcome = if run < 6 { Won } else { Lost };
        let metrics = episode(&format!("game{game}"), level, run, outcome, 0.0, 40);
        episodes.push(EpisodeMetrics { commit, ..metrics });
    }
    let ceilings = [("1", 90), ("10", 80), ("all", 5)].into_iter().flat_map(|(commit, wins)| {
        let commit = commit.parse().unwrap();
        let exact = LevelCeiling { level: 0, commit, exact: true, wins: 1, episodes: 1 };
        [exact.clone(), LevelCeiling { level: 1, exact: false, wins, episodes: 100, ..exact }]
    });
    let ceilings: Vec<LevelCeiling> = ceilings.collect();
    let game = |number: usize| StudyGame {
        id: format!("game{number}"),
        ceilings: ceilings.clone(),
        ..StudyGame::default()
    };
    Study::new(vec![(Player::reference("p"), episodes)], (0..2).map(game).collect())
}

/// Checks the number of levels that count, and the player's relative win rate.
#[track_caller]
fn check(commit: &str, levels: u64, relative: f64) {
    let study = study(commit);
    let row = &study.ceilings[0];
    assert_eq!((row.levels, row.left_out, row.episodes), (levels, 4 - levels, 10 * levels));
    assert_eq!(study.leaderboard[0].scores.episodes, 10 * levels);
    let found = row.relative.unwrap();
    assert!(
        (found.value - relative).abs() < 1e-12 && found.low < relative && relative < found.high,
        "{row:?}"
    );
}

#[test]
fn levels_count_only_if_somebody_wins_them() {
    check("1", 4, 0.6 / 0.95);
    check("10", 4, 0.6 / 0.9);
    check("all", 2, 0.6);
    // Only players whose commitment divides ten can play the plans of ten actions.
    check("5", 4, 0.6 / 0.9);
    check("7", 2, 0.6);
}

#[test]
fn levels_that_are_left_out_are_named() {
    let study = study("7");
    let note = "At commitment 7, episodes on 2 levels are excluded from all numbers, because no player is known to \
                win 80% of the episodes there. The levels with their ceilings (measured at all): game0-1 (0.05), \
                game1-1 (0.05).";
    assert!(study.notes.iter().any(|own| own == note), "{:?}", study.notes);
    let table =
        study.tables().into_iter().find(|table| table.id == "ceilings").expect("a table").to_markdown();
    assert!(table.contains("| p | 2 | 2 | 20 |"), "{table}");
}

#[test]
fn without_ceilings_nothing_changes() {
    let episodes = vec![episode("game", 0, 0, Won, 0.0, 40)];
    let study = Study::new(vec![(Player::reference("p"), episodes)], Vec::new());
    assert!(study.ceilings.is_empty() && study.left_out.is_empty());
    assert!(study.tables().iter().all(|table| table.id != "ceilings"));
    assert_eq!(study.leaderboard[0].scores.episodes, 1);
}
