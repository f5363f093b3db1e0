//! The results of a player by game, and their totals: the sweep of the paper (`spec/06` §4 and §5.2).

use crate::study::Study;
use crate::study::scores::{Estimate, Scores, levels_of};
use report::{Table, TableCell};
use serde::Serialize;

/// The results of a player by game.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sweep {
    /// The index into the players of the study.
    pub player: usize,
    /// A row for each game played, in the order of the study.
    pub games: Vec<SweepRow>,
    /// The scores over all games.
    pub total: Scores,
    /// The number of levels played.
    pub levels: u64,
    /// The number of levels among them that were never won.
    pub zero_win_levels: u64,
}

/// The results of a player on a game.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepRow {
    /// The index into the games of the study.
    pub game: usize,
    /// The scores over all levels.
    pub scores: Scores,
    /// The number of levels played.
    pub levels: u64,
    /// The number of levels among them that were never won.
    pub zero_win_levels: u64,
}

impl Sweep {
    pub(crate) fn of(study: &Study, player: usize) -> Sweep {
        let levels = |game: Option<usize>| {
            let ended = || study.on(player, game, None).iter().filter(|episode| episode.metrics.counts());
            let (played, won) =
                (levels_of(ended()), levels_of(ended().filter(|episode| episode.metrics.won())));
            (played.len() as u64, (played.len() - won.len()) as u64)
        };
        let row = |game: usize| {
            let all = study.on(player, Some(game), None);
            let (levels, zero_win_levels) = levels(Some(game));
            (!all.is_empty()).then(|| SweepRow { game, scores: Scores::of(all), levels, zero_win_levels })
        };
        let (played, zero_win_levels) = levels(None);
        Sweep {
            player,
            games: (0..study.games.len()).filter_map(row).collect(),
            total: Scores::of(study.on(player, None, None)),
            levels: played,
            zero_win_levels,
        }
    }
}

const COLUMNS: [&str; 10] = [
    "player",
    "game",
    "episodes",
    "win rate",
    "meaningful",
    "efficiency",
    "normalised reward",
    "overall",
    "levels",
    "never won",
];

fn row(player: &str, game: &str, scores: &Scores, levels: u64, zero_win_levels: u64) -> Vec<TableCell> {
    vec![
        TableCell::text(player),
        TableCell::text(game),
        TableCell::Count(scores.episodes),
        Estimate::cell(scores.win_rate, 2),
        TableCell::number(scores.meaningful, 3),
        TableCell::number(scores.efficiency, 3),
        TableCell::number(scores.normalised_reward, 3),
        TableCell::number(scores.overall, 3),
        TableCell::Count(levels),
        TableCell::Count(zero_win_levels),
    ]
}

/// Returns the table of all games and its summary.
pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let note = "Never won: levels without a single win. Efficiency: 1 − mean steps of wins / most steps of any episode on the \
                level, over the levels that were won.";
    let mut games = Table::new("games", "Game by game", note, &COLUMNS);
    let mut summary = Table::new("summary", "Results over all games", note, &COLUMNS);
    for sweep in &study.sweeps {
        let player = study.players[sweep.player].label();
        for found in &sweep.games {
            let game = &study.games[found.game].id;
            games.push(row(&player, game, &found.scores, found.levels, found.zero_win_levels));
        }
        let count = match sweep.games.len() {
            1 => "1 game".to_owned(),
            count => format!("{count} games"),
        };
        summary.push(row(&player, &count, &sweep.total, sweep.levels, sweep.zero_win_levels));
    }
    vec![games, summary]
}
