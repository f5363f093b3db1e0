//! Groups the episodes without a win by cause: the sprite and the rule that ended them. Also computes their
//! distance from a win.

use crate::metrics::{EndingKind, GoalDistance};
use crate::study::{Study, StudyEpisode};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// A player's episodes on one game that ended for the same reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EndingRow {
    /// The player's index in the study.
    pub player: usize,
    /// The game's index in the study.
    pub game: usize,
    /// The kind of ending.
    pub kind: EndingKind,
    /// The cause as a phrase, such as `died of touching dragonfly`.
    pub cause: String,
    /// The sprites that caused the ending, if any, as a phrase such as `of touching dragonfly`.
    pub particulars: Option<String>,
    /// The line in the game description that caused the ending, as written.
    pub rule: Option<String>,
    /// The number of episodes with this cause.
    pub episodes: u64,
    /// The numbers of the levels on which these episodes were played.
    pub levels: BTreeSet<usize>,
    /// The smallest distance from a win among the episodes with this cause.
    pub nearest: Option<GoalDistance>,
}

/// A summary of a player's episodes without a win.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EndingSummary {
    /// The player's index in the study.
    pub player: usize,
    /// The number of episodes without a win.
    pub episodes: u64,
    /// The number of episodes for each kind of ending. Kinds that did not occur are omitted.
    pub kinds: BTreeMap<EndingKind, u64>,
    /// The indices of the player's rows in the study, most frequent cause first.
    pub causes: Vec<usize>,
}

/// Returns one row per player, game and cause. Models come before reference players, each group in
/// leaderboard order. Each player's most frequent causes come first.
pub(crate) fn endings(study: &Study) -> Vec<EndingRow> {
    players(study).flat_map(|player| of_player(study, player)).collect()
}

/// Returns the players in table order.
fn players(study: &Study) -> impl Iterator<Item = usize> + '_ {
    let players = study.leaderboard.iter().map(|row| row.player);
    players.sorted_by_key(|&player| study.players[player].is_reference())
}

fn of_player(study: &Study, player: usize) -> Vec<EndingRow> {
    let mut rows: BTreeMap<(usize, EndingKind, String, Option<String>), EndingRow> = BTreeMap::new();
    for StudyEpisode { game, metrics, .. } in study.on(player, None, None) {
        let Some(ending) = metrics.ending.as_ref().filter(|_| metrics.counts()) else { continue };
        let (game, kind, cause, rule) = (*game, ending.kind, ending.words(), ending.rule.clone());
        let row = rows.entry((game, kind, cause.clone(), rule.clone())).or_insert_with(|| EndingRow {
            player,
            game,
            kind,
            cause,
            particulars: ending.particulars(),
            rule,
            episodes: 0,
            levels: BTreeSet::new(),
            nearest: None,
        });
        row.episodes += 1;
        row.levels.insert(metrics.level);
        row.nearest = nearest(row.nearest.iter().chain(&ending.distance)).cloned();
    }
    rows.into_values().sorted_by_key(|row| Reverse(row.episodes)).collect()
}

/// Returns the smallest distance, or the first one among equals; `None` without distances.
pub(crate) fn nearest<'a>(distances: impl Iterator<Item = &'a GoalDistance>) -> Option<&'a GoalDistance> {
    distances.min_by(|one, other| one.fraction().total_cmp(&other.fraction()))
}

/// Returns a summary for each player that did not win all its episodes.
pub(crate) fn summaries(study: &Study) -> Vec<EndingSummary> {
    let summary = |player: usize| {
        let causes = (0..study.endings.len()).filter(|&at| study.endings[at].player == player).collect_vec();
        let mut kinds: BTreeMap<EndingKind, u64> = BTreeMap::new();
        for row in causes.iter().map(|&at| &study.endings[at]) {
            *kinds.entry(row.kind).or_default() += row.episodes;
        }
        EndingSummary { player, episodes: kinds.values().sum(), kinds, causes }
    };
    players(study).map(summary).filter(|summary| summary.episodes > 0).collect()
}

impl Study {
    /// Returns up to `count` of a player's most informative episodes. Losses come before wins. Each cause is
    /// represented once, by its episode nearest to a win, before any cause is repeated. Each kind's most
    /// frequent cause comes before its other causes. Aborted episodes come last.
    pub fn telling(&self, player: usize, count: usize) -> Vec<&StudyEpisode> {
        let causes: Vec<&EndingRow> = self.endings.iter().filter(|row| row.player == player).collect();
        // `numbers` contains each cause's index among the causes of its kind, and `seen` counts its episodes
        // so far.
        let of_kind = |at: usize| causes[..at].iter().filter(|row| row.kind == causes[at].kind).count();
        let numbers: Vec<usize> = (0..causes.len()).map(of_kind).collect();
        let mut seen = vec![0_usize; causes.len()];
        let distance = |episode: &&StudyEpisode| {
            let left = episode.metrics.ending.as_ref().and_then(|ending| ending.distance.as_ref());
            left.map_or(f64::INFINITY, GoalDistance::fraction)
        };
        let mut rank = |episode: &StudyEpisode| match &episode.metrics.ending {
            _ if !episode.metrics.counts() => (2, 0, 0, 0),
            None => (1, 0, 0, 0),
            Some(ending) => {
                let words = ending.words();
                let is_it = |row: &&EndingRow| {
                    row.game == episode.game && row.cause == words && row.rule == ending.rule
                };
                let at = causes.iter().position(is_it).expect("each ending has a row");
                seen[at] += 1;
                (0, seen[at], numbers[at], at)
            }
        };
        let nearest_first = self.on(player, None, None).iter();
        let nearest_first = nearest_first.sorted_by(|one, other| distance(one).total_cmp(&distance(other)));
        let ranked = nearest_first.map(|episode| (rank(episode), episode)).sorted_by_key(|(rank, _)| *rank);
        ranked.map(|(_, episode)| episode).take(count).collect()
    }
}

pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let kind = |row: &EndingSummary, kind| TableCell::Count(row.kinds.get(&kind).copied().unwrap_or(0));
    let label = |player: usize| TableCell::text(study.players[player].label());
    let summary = Table::of(
        "endings",
        "Episodes that were not won, by ending",
        "Died: the avatar was removed. Lost a sprite, sprite appeared: the game was lost by its rules. \
         Out of time: the game's own time limit was reached. Limit of steps: the evaluation's step limit was \
         reached. Stopped: the engine stopped the episode, which says nothing about the player.",
        &study.ending_summaries,
        &[
            ("player", &|row| label(row.player)),
            ("not won", &|row| TableCell::Count(row.episodes)),
            ("died", &|row| kind(row, EndingKind::Died)),
            ("lost a sprite", &|row| kind(row, EndingKind::Lost)),
            ("sprite appeared", &|row| kind(row, EndingKind::Appeared)),
            ("out of time", &|row| kind(row, EndingKind::OutOfTime)),
            ("lost otherwise", &|row| kind(row, EndingKind::Otherwise)),
            ("limit of steps", &|row| kind(row, EndingKind::StepLimit)),
            ("no winner", &|row| kind(row, EndingKind::NoWinner)),
            ("stopped", &|row| kind(row, EndingKind::Stopped)),
        ],
    );
    let causes = Table::of(
        "causes",
        "Causes",
        "Cause: the last interaction that removed a necessary sprite, with its rule; for other endings, \
         the termination. Nearest to a win: the smallest distance from a winning termination at the end \
         of an episode.",
        &study.endings,
        &[
            ("player", &|row| label(row.player)),
            ("game", &|row| TableCell::text(study.title(row.game))),
            ("episodes", &|row| TableCell::Count(row.episodes)),
            ("ending", &|row| TableCell::text(&row.cause)),
            ("nearest to a win", &|row| {
                row.nearest.as_ref().map_or(TableCell::Missing, |near| TableCell::text(near.words()))
            }),
            ("rule", &|row| row.rule.as_ref().map_or(TableCell::Missing, TableCell::text)),
            ("levels", &|row| TableCell::text(row.levels.iter().join(", "))),
        ],
    );
    vec![summary, causes]
}
