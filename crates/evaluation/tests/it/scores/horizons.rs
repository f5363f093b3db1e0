//! Tests of horizons (the number of actions per decision at which a player still wins half of its episodes), using
//! players' episodes at several such numbers.

use super::episode;
use engine::Outcome::{Lost, Won};
use evaluation::Commitment;
use evaluation::metrics::EpisodeMetrics;
use evaluation::study::{Foresight, HorizonRow, Player, Study, StudyGame};

/// Returns a study of one player on eight games with two levels each. Each level has ten episodes per
/// commitment. `won` states the number of episodes won for each commitment, each in 40 ticks. Every second
/// game is stochastic.
fn study(label: &str, won: &[(&str, u64)]) -> Study {
    let player = |commit: Commitment| {
        let aids = commit.aid().into_iter().chain(["json".to_owned()]).collect();
        Player { aids, ..Player::reference(label) }
    };
    let results = won.iter().map(|(commit, wins)| {
        let commit: Commitment = commit.parse().unwrap();
        let mut episodes = Vec::new();
        for (game, level, run) in
            (0..8).flat_map(|game| (0..2).flat_map(move |level| (0..10).map(move |run| (game, level, run))))
        {
            let outcome = if run < *wins { Won } else { Lost };
            let metrics = episode(&format!("game{game}"), level, run, outcome, 0.0, 40);
            episodes.push(EpisodeMetrics { commit, ..metrics });
        }
        (player(commit), episodes)
    });
    let game = |number: usize| StudyGame {
        id: format!("game{number}"),
        is_stochastic: Some(number % 2 == 1),
        ..StudyGame::default()
    };
    Study::new(results.collect(), (0..8).map(game).collect())
}

fn row(study: &Study, games: Foresight) -> &HorizonRow {
    study.horizons.iter().find(|row| row.games == games).expect("a row of these games")
}

#[test]
fn the_horizon_is_where_half_is_won() {
    let study = study("p", &[("1", 9), ("5", 5), ("25", 1)]);
    assert_eq!(study.horizons.len(), 3, "without chance, of chance, and all");
    for games in Foresight::ALL {
        let row = row(&study, games);
        assert_eq!(row.player.label(), "p (json)", "commitments are no players of their own");
        assert!(row.horizon.horizon.is_some_and(|horizon| (4.0..6.2).contains(&horizon.value)), "{row:?}");
        let episodes: Vec<(&str, u64)> =
            row.rates.iter().map(|rate| (rate.commit.as_str(), rate.episodes)).collect();
        let each = if games == Foresight::All { 160 } else { 80 };
        assert_eq!(episodes, [("1", each), ("5", each), ("25", each)]);
    }
    let table =
        study.tables().into_iter().find(|table| table.id == "horizons").expect("a table").to_markdown();
    assert!(table.contains("| p (json) | deterministic |") && table.contains("5: 50%"), "{table}");
}

/// The wins take 40 ticks, so a commitment to all actions is effectively a commitment to 40 actions.
#[test]
fn nobody_commits_to_more_than_a_win_takes() {
    let study = study("p", &[("10", 9), ("all", 5)]);
    let row = row(&study, Foresight::All);
    assert_eq!(row.rates.iter().map(|rate| rate.ticks).collect::<Vec<_>>(), [10.0, 40.0]);
    assert!(row.horizon.horizon.is_some_and(|horizon| (30.0..50.0).contains(&horizon.value)), "{row:?}");
}

#[test]
fn bounds_are_told_as_bounds() {
    let never = study("p", &[("1", 0), ("20", 0)]);
    let found = row(&never, Foresight::Exact);
    assert_eq!(
        (found.horizon.told_value(), found.horizon.told_interval()),
        ("≤ 1".to_owned(), "≤ 1".to_owned())
    );
    assert_eq!(found.title(), "p (json), deterministic games");
    let always = study("p", &[("1", 10), ("20", 10)]);
    assert_eq!(row(&always, Foresight::All).horizon.told_value(), "≥ 80");
}

#[test]
fn one_commitment_has_no_horizon() {
    let study = study("p", &[("1", 5)]);
    assert!(study.horizons.is_empty() && study.tables().iter().all(|table| table.id != "horizons"));
}
