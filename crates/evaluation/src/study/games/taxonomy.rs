//! Players' results by kind of game. The kind is either stated by the release or derived from the rules by a
//! taxonomy.

use crate::study::episodes::scores::{Estimate, Scores};
use crate::study::{Study, StudyGame};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;

/// A player's results on all games of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TaxonomyRow {
    /// The kind: a word from the release or a sentence from the taxonomy.
    pub kind: String,
    /// The player's index in the study.
    pub player: usize,
    /// The number of games of this kind that the player played.
    pub games: u64,
    /// The scores on games of this kind.
    pub scores: Scores,
}

/// The text shown when a game's kind was not recorded.
const NOT_RECORDED: &str = "not recorded";

/// Returns one row per player for each kind in the taxonomy. Kinds are ordered by their first game. A game
/// can have several kinds.
pub(crate) fn taxonomy(study: &Study) -> Vec<TaxonomyRow> {
    rows(study, |game| game.taxonomy.clone())
}

/// Returns one row per player for each kind stated by the release, with the kinds in alphabetical order. The
/// list is empty if no game has a recorded kind.
pub(crate) fn kinds(study: &Study) -> Vec<TaxonomyRow> {
    if study.games.iter().all(|game| game.kind.is_empty()) {
        return Vec::new();
    }
    let kind = |game: &StudyGame| if game.kind.is_empty() { NOT_RECORDED } else { &game.kind }.to_owned();
    let mut rows = rows(study, |game| vec![kind(game)]);
    rows.sort_by(|one, other| one.kind.cmp(&other.kind));
    rows
}

fn rows(study: &Study, kinds: impl Fn(&StudyGame) -> Vec<String>) -> Vec<TaxonomyRow> {
    let mut rows = Vec::new();
    let of_games: Vec<Vec<String>> = study.games.iter().map(kinds).collect();
    for kind in of_games.iter().flatten().unique() {
        for player in 0..study.players.len() {
            let of_kind = |game: usize| of_games[game].contains(kind);
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

pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let taxonomy = Table::of(
        "taxonomy",
        "Results by the taxonomy of the rules",
        "The taxonomy is derived from the rules; a game can belong to several classes.",
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
    );
    vec![by_kind(study), taxonomy]
}

/// Returns a table of the kinds stated by the release, with one column of win rates per player, in
/// leaderboard order.
fn by_kind(study: &Study) -> Table {
    let players: Vec<usize> = study.leaderboard.iter().map(|row| row.player).collect();
    let labels: Vec<String> = players.iter().map(|&player| study.players[player].label()).collect();
    let columns: Vec<&str> = ["kind", "games"].into_iter().chain(labels.iter().map(String::as_str)).collect();
    let note = "Win rates by the kind of game that the release states, with intervals over the games of \
                the kind (for a single game, for exactly its levels). Results recorded before kinds existed, \
                and games from files, have no kind.";
    let mut table = Table::new("kinds", "Results by kind of game", note, &columns);
    for (kind, rows) in &study.kinds.iter().chunk_by(|row| &row.kind) {
        let rows = rows.collect_vec();
        let games = rows.iter().map(|row| row.games).max().unwrap_or(0);
        let rate = |&player: &usize| {
            let row = rows.iter().find(|row| row.player == player);
            Estimate::cell(row.and_then(|row| row.scores.win_rate), 2)
        };
        let cells = [TableCell::text(kind), TableCell::Count(games)];
        table.push(cells.into_iter().chain(players.iter().map(rate)).collect());
    }
    table
}
