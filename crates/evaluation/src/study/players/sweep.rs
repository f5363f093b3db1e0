//! Each player's results by game, with totals. The paper calls such a table a sweep (`spec/06` §4 and §5.2).

use crate::study::Study;
use crate::study::episodes::scores::{Estimate, Scores, levels_of};
use report::{Table, TableCell};
use serde::Serialize;

/// A player's results by game.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sweep {
    /// The player's index in the study.
    pub player: usize,
    /// The results for each of the player's games, in the order of the study.
    pub games: Vec<SweepRow>,
    /// The scores over all games played.
    pub total: Scores,
    /// The number of levels played in all games.
    pub levels: u64,
    /// The number of played levels without a win.
    pub zero_win_levels: u64,
}

/// A player's results on a game.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepRow {
    /// The game's index in the study.
    pub game: usize,
    /// The scores over all of the game's levels that the player played.
    pub scores: Scores,
    /// The number of the game's levels that the player played.
    pub levels: u64,
    /// The number of played levels without a win.
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

/// A table row: the player, the game or games, the scores, the number of levels played, and the number of
/// levels without a win.
type Row<'a> = (String, String, &'a Scores, u64, u64);

/// Returns the table of results by game, and its summary.
pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let note = "Never won: levels without a single win. Efficiency: 1 − mean steps of wins / maximum \
                steps of any episode on the level, over the levels that were won.";
    let table = |id: &str, title: &str, rows: &[Row<'_>]| {
        Table::of(
            id,
            title,
            note,
            rows,
            &[
                ("player", &|(player, ..)| TableCell::text(player)),
                ("game", &|(_, game, ..)| TableCell::text(game)),
                ("episodes", &|(_, _, scores, ..)| TableCell::Count(scores.episodes)),
                ("win rate", &|(_, _, scores, ..)| Estimate::cell(scores.win_rate, 2)),
                ("meaningful", &|(_, _, scores, ..)| TableCell::number(scores.meaningful, 3)),
                ("efficiency", &|(_, _, scores, ..)| TableCell::number(scores.efficiency, 3)),
                ("normalised reward", &|(_, _, scores, ..)| TableCell::number(scores.normalised_reward, 3)),
                ("overall", &|(_, _, scores, ..)| TableCell::number(scores.overall, 3)),
                ("levels", &|(.., levels, _)| TableCell::Count(*levels)),
                ("never won", &|(.., zero_win_levels)| TableCell::Count(*zero_win_levels)),
            ],
        )
    };
    let (mut games, mut summary): (Vec<Row<'_>>, Vec<Row<'_>>) = (Vec::new(), Vec::new());
    for Sweep { player, games: found, total, levels, zero_win_levels } in &study.sweeps {
        let player = study.players[*player].label();
        games.extend(found.iter().map(|row| {
            let game = study.games[row.game].id.clone();
            (player.clone(), game, &row.scores, row.levels, row.zero_win_levels)
        }));
        let count = match found.len() {
            1 => "1 game".to_owned(),
            count => format!("{count} games"),
        };
        summary.push((player, count, total, *levels, *zero_win_levels));
    }
    vec![table("games", "Game by game", &games), table("summary", "Results over all games", &summary)]
}
