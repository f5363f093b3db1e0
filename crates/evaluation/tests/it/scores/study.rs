//! Tests of studies with a few invented episodes, whose numbers were calculated by hand.

use super::episode;
use engine::Outcome::{Lost, Ongoing, Won};
use evaluation::metrics::{EpisodeMetrics, EpisodeStatus, Movement};
use evaluation::study::{
    CONTEXTUAL, DifficultyLabel, Measure, Player, Scope, Study, StudyGame, StudyLevel, ZERO_SHOT,
};

fn close(found: impl Into<Option<f64>>, expect: f64) {
    let found = found.into();
    assert!(found.is_some_and(|found| (found - expect).abs() < 1e-6), "{found:?}, not {expect}");
}

/// Returns a study of one level with two players. The model wins once in 20 of 100 steps and loses once in 40
/// steps, and `random` reaches the limit.
fn one_level() -> Study {
    let meaningful = |share: f64, metrics: EpisodeMetrics| EpisodeMetrics {
        meaningful: Some(share),
        movement: Movement { bump_rate: Some(1.0 - share), displacement: Some(7), ..Movement::default() },
        ..metrics
    };
    let model = vec![
        EpisodeMetrics { optimal_ticks: Some(10), ..meaningful(0.75, episode("maze", 4, 0, Won, 10.0, 20)) },
        meaningful(0.25, episode("maze", 4, 1, Lost, 0.0, 40)),
        EpisodeMetrics {
            status: EpisodeStatus::Halted("infrastructure".to_owned()),
            ..meaningful(1.0, episode("maze", 4, 2, Ongoing, 99.0, 3))
        },
    ];
    let random = vec![meaningful(0.5, episode("maze", 4, 0, Ongoing, 5.0, 100))];
    let levels = vec![StudyLevel { number: 4, optimal_ticks: Some(10) }];
    let game = StudyGame { levels, taxonomy: vec!["Turn-based.".to_owned()], ..StudyGame::default() };
    Study::new(
        vec![(Player::reference("random"), random), (Player::model("m", ZERO_SHOT), model)],
        vec![StudyGame { id: "maze".to_owned(), ..game }],
    )
}

#[test]
fn scores_worked_by_hand() {
    let study = one_level();
    let row = &study.leaderboard[0];
    let scores = &row.scores;
    assert_eq!(study.players[row.player].label(), "m (zero-shot)");
    assert_eq!((scores.episodes, scores.excluded, scores.wins, scores.timeouts), (2, 1, 1, 0));
    close(scores.win_rate.map(|rate| rate.value), 0.5);
    close(scores.meaningful, 0.5);
    close(scores.steps, 30.0);
    close(scores.unused_steps, 0.7);
    close(scores.normalised_reward, 0.5);
    close(scores.overall, (0.5 + 0.7 + 0.5 + 0.5) / 4.0);
    close(scores.efficiency, 0.8);
    close(scores.optimality, 0.5);
    close(scores.bump_rate, 0.5);
    assert_eq!(row.aborted.get("infrastructure"), Some(&1));
    assert_eq!(row.bounds, Some([1.0 / 3.0, 2.0 / 3.0]), "one of three was broken off");
    let random = &study.leaderboard[1].scores;
    assert_eq!((random.timeouts, random.efficiency, random.optimality), (1, None, None));
    close(random.normalised_reward, 0.5);
    assert_eq!(study.notes.len(), 1);
    // The reward of the aborted episode is ignored.
    assert!(study.episodes.iter().all(|episode| episode.most_steps == 100));
}

#[test]
fn difficulty_worked_by_hand() {
    let study = one_level();
    let [game, level] = &study.difficulties[..] else { panic!("a game and a level") };
    assert_eq!((game.level, level.level), (None, Some(4)));
    for row in [game, level] {
        close(row.win_rate, 0.25);
        close(row.normalised_reward, 0.5);
        close(row.efficiency, 0.8);
        close(row.ease, 0.6 * 0.25 + 0.2 * 0.5 + 0.2 * 0.8);
        assert_eq!(row.label, Some(DifficultyLabel::Medium));
    }
}

#[test]
fn missing_values_stay_missing() {
    let same = |game: &str, outcome| {
        vec![episode(game, 0, 0, outcome, 3.0, 9), episode(game, 0, 1, outcome, 3.0, 9)]
    };
    let episodes = [same("never", Lost), same("always", Won)].concat();
    let study = Study::new(vec![(Player::reference("one"), episodes)], Vec::new());
    let [never, _, always, _] = &study.difficulties[..] else { panic!("two games of one level") };
    assert_eq!((never.normalised_reward, never.efficiency, never.ease), (None, None, None));
    assert_eq!((never.label, always.label, always.ease), (Some(DifficultyLabel::Unbeaten), None, None));
    close(always.efficiency, 0.0);
    let scores = &study.leaderboard[0].scores;
    assert_eq!((scores.meaningful, scores.normalised_reward, scores.overall), (None, None, None));
    assert_eq!(study.correlations.excluded, 4);
    assert!(study.correlations.pairs.iter().all(|pair| pair.pearson.is_none()));
    assert!(study.failures.iter().all(|mode| mode.welch.is_none() && mode.excluded == 4));
    let sweep = &study.sweeps[0];
    assert_eq!((sweep.levels, sweep.zero_win_levels, sweep.games[0].zero_win_levels), (2, 1, 1));
    let text = study.tables().iter().map(|table| table.to_markdown()).collect::<String>();
    assert!(text.contains('–') && !text.contains("NaN") && !text.contains("inf"), "{text}");
}

/// A model's two modes share a row in the combined heat map. Reference players are in all heat maps.
#[test]
fn heat_maps() {
    let play = |wins: u64| -> Vec<EpisodeMetrics> {
        let outcome = |run: u64| if run < wins { Won } else { Lost };
        (0..4).map(|run| episode("maze", (run % 2) as usize, run / 2, outcome(run), 0.0, 9)).collect()
    };
    let study = Study::new(
        vec![
            (Player::reference("random"), play(0)),
            (Player::model("m", ZERO_SHOT), play(1)),
            (Player::model("m", CONTEXTUAL), play(4)),
        ],
        Vec::new(),
    );
    assert_eq!(study.by_game.iter().map(|matrix| matrix.scope).collect::<Vec<_>>(), Scope::ALL);
    for (matrix, expect) in study.by_game.iter().zip([0.25, 1.0, 0.625]) {
        let labels: Vec<&str> = matrix.rows.iter().map(|row| row.label.as_str()).collect();
        assert_eq!(labels, ["m", "random"]);
        assert_eq!(matrix.values(Measure::WinRate), [[Some(expect)], [Some(0.0)]]);
    }
    let by_level = &study.by_level[0];
    let labels: Vec<&str> = by_level.columns.iter().map(|column| column.label.as_str()).collect();
    assert_eq!(labels, ["maze-0", "maze-1"]);
    assert_eq!(by_level.values(Measure::WinRate)[0], [Some(0.5), Some(0.0)]);
    assert_eq!(by_level.values(Measure::Overall)[0], [None, None]);
    let modes = &study.modes.overall[0];
    assert_eq!((modes.wins, modes.episodes, modes.levels), ([1, 4], [4, 4], 2));
    close(modes.difference, -0.75);
    // On level 0, one win in two episodes is compared with two wins. On level 1, no win is compared with two
    // wins. Among the tables with these totals, the observed table has probability (1/2) · (1/6). Its mirror
    // image has the same probability.
    close(modes.within_levels.p, 1.0 / 6.0);
    assert_eq!((modes.p, modes.over_games), (None, None), "one game says nothing about others");
    assert_eq!(study.pairs.overall.len(), 2);
}

#[test]
fn every_table_has_every_format() {
    let study = one_level();
    let tables = study.tables();
    let mut ids: Vec<&str> = tables.iter().map(|table| table.id.as_str()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), tables.len(), "no two tables share a file");
    for table in &tables {
        let lines = table.to_csv().lines().count();
        assert_eq!(lines, table.rows.len() + 1, "{}", table.id);
        assert!(table.to_latex().contains(&format!("tab:{}", table.id)));
    }
    assert_eq!(study.taxonomy.len(), 2);
    serde_json::to_string(&study).expect("a study is plain data");
}
