//! Results by kind of game.

use crate::study::Study;
use crate::study::scores::{Estimate, Scores};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;

/// The results of a player on all games of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TaxonomyRow {
    /// The kind: a sentence of the taxonomy.
    pub kind: String,
    /// The index into the players of the study.
    pub player: usize,
    /// The number of games of the kind that it played.
    pub games: u64,
    /// The scores on them.
    pub scores: Scores,
}

/// Returns a row for each kind and player, with kinds in the order of their first game. A game has several kinds.
pub(crate) fn taxonomy(study: &Study) -> Vec<TaxonomyRow> {
    let mut rows = Vec::new();
    for kind in study.games.iter().flat_map(|game| &game.taxonomy).unique() {
        for player in 0..study.players.len() {
            let of_kind = |game: usize| study.games[game].taxonomy.contains(kind);
            let episodes = || study.on(player, None, None).iter().filter(|episode| of_kind(episode.game));
            let games = episodes().map(|episode| episode.game).sorted_unstable().dedup().collect_vec();
            if !games.is_empty() {
                let (kind, scores) = (kind.clone(), Scores::of(episodes()));
                rows.push(TaxonomyRow { kind, player, games: games.len() as u64, scores });
            }
        }
    }
    rows
}

pub(crate) fn table(study: &Study) -> Table {
    Table::of(
        "taxonomy",
        "Results by kind of game",
        "Kinds are derived from the rules; a game can have several.",
        &study.taxonomy,
        &[
            ("kind", &|row| TableCell::text(&row.kind)),
            ("player", &|row| TableCell::text(study.players[row.player].label())),
            ("games", &|row| TableCell::Count(row.games)),
            ("episodes", &|row| TableCell::Count(row.scores.episodes)),
            ("win rate", &|row| Estimate::cell(row.scores.win_rate, 2)),
            ("meaningful", &|row| TableCell::number(row.scores.meaningful, 3)),
            ("normalised reward", &|row| TableCell::number(row.scores.normalised_reward, 3)),
            ("overall", &|row| TableCell::number(row.scores.overall, 3)),
        ],
    )
}
