//! Players' horizons. A player's horizon is the commitment (the number of actions per decision) at which the player
//! still wins half of its episodes.

use super::{Effect, Horizon, by_player, by_setting};
use crate::study::episodes::scores::Estimate;
use crate::study::{Player, Study, StudyEpisode};
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use std::collections::BTreeMap;

base::named_enum! {
    /// The kind of games on which a horizon is measured, according to what a player must foresee. A horizon is the
    /// number of actions per decision at which a player still wins half of its episodes.
    pub enum Foresight {
        /// Deterministic games, in which the future follows from the rules.
        Exact = "deterministic",
        /// Stochastic games, in which a plan must work for every outcome.
        Robust = "stochastic",
        /// Games of both kinds, including games whose kind is unknown.
        All = "all",
    }
}

/// A player's horizon: the commitment (the number of actions per decision) at which the player still wins half of its
/// episodes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HorizonRow {
    /// The player, without its commitment (its number of actions per decision).
    pub player: Player,
    /// The kind of games on which the horizon (the longest successful number of actions per decision) is measured.
    pub games: Foresight,
    /// The win rates, sorted by ascending commitment (number of actions per decision).
    pub rates: Vec<CommitmentRate>,
    /// The horizon in ticks: the number of actions per decision at which half of the episodes are won. The lowest value
    /// that can be reported is a quarter of the smallest effective commitment, but at least one tick. The highest is four
    /// times the largest effective commitment.
    #[serde(flatten)]
    pub horizon: Horizon,
}

/// A player's win rate with one commitment (number of actions per decision).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CommitmentRate {
    /// The commitment (number of actions per decision) as written in results: a number, or `all`.
    pub commit: String,
    /// The mean effective commitment, in ticks: the number of actions per decision, capped at the length of the level's
    /// shortest known win.
    pub ticks: f64,
    /// The win rate with its interval.
    pub rate: Option<Estimate>,
    /// The number of ended episodes.
    pub episodes: u64,
}

impl HorizonRow {
    /// Returns the player's label and the kind of games. The kind is omitted for [`Foresight::All`].
    pub fn title(&self) -> String {
        match self.games {
            Foresight::All => self.player.label(),
            games => format!("{}, {} games", self.player.label(), games.name()),
        }
    }
}

/// Returns the rows of players with results for several commitments (numbers of actions per decision), one per kind of
/// game. Rows are sorted by kind, and then by descending horizon.
pub(in crate::study) fn horizons(study: &Study) -> Vec<HorizonRow> {
    let players = by_player(study, |aid, episode| episode.metrics.commit.aid().as_deref() == Some(aid));
    let shortest = shortest_wins(study);
    let is_of = |episode: &StudyEpisode, games: Foresight| match games {
        Foresight::Exact => study.games[episode.game].is_stochastic == Some(false),
        Foresight::Robust => study.games[episode.game].is_stochastic == Some(true),
        Foresight::All => true,
    };
    let mut rows = Vec::new();
    for (player, episodes) in players {
        for games in Foresight::ALL {
            let chosen: Vec<&StudyEpisode> =
                episodes.iter().copied().filter(|episode| is_of(episode, games)).collect();
            let is_all_alike = games == Foresight::All
                && episodes.iter().map(|episode| study.games[episode.game].is_stochastic).all_equal();
            if chosen.iter().map(|episode| episode.metrics.commit).unique().count() > 1 && !is_all_alike {
                rows.push(row(player.clone(), games, &chosen, &shortest));
            }
        }
    }
    rows.sort_by(|a, b| {
        let far = |row: &HorizonRow| row.horizon.horizon.map_or(-1.0, |horizon| horizon.value);
        a.games.cmp(&b.games).then(far(b).total_cmp(&far(a)))
    });
    rows
}

/// Returns the length of the shortest known win in ticks, by game and level. If no win was proved to be the
/// shortest, the shortest win by any player in the study is used.
fn shortest_wins(study: &Study) -> BTreeMap<(usize, usize), u64> {
    let mut shortest = BTreeMap::new();
    let wins = study.episodes.iter().filter(|episode| episode.metrics.won());
    let proved =
        study.episodes.iter().filter_map(|episode| Some((episode, episode.metrics.optimal_ticks? as u64)));
    for (episode, ticks) in wins.map(|episode| (episode, episode.metrics.steps)).chain(proved) {
        let known = shortest.entry((episode.game, episode.metrics.level)).or_insert(ticks);
        *known = ticks.min(*known);
    }
    shortest
}

fn row(
    player: Player,
    games: Foresight,
    episodes: &[&StudyEpisode],
    shortest: &BTreeMap<(usize, usize), u64>,
) -> HorizonRow {
    // If a decision has more actions than the shortest win, only as many actions as that win has can matter.
    let ticks = |episode: &StudyEpisode| {
        let metrics = &episode.metrics;
        let known = shortest.get(&(episode.game, metrics.level)).copied().unwrap_or(u64::MAX);
        metrics.commit.due(metrics.max_steps.min(known)).max(1) as f64
    };
    let rates =
        by_setting(episodes, |episode| episode.metrics.commit).into_iter().map(|(commit, episodes)| {
            CommitmentRate {
                commit: commit.to_string(),
                ticks: episodes.iter().map(|episode| ticks(episode)).sum::<f64>() / episodes.len() as f64,
                rate: Estimate::rate(&episodes),
                episodes: episodes.len() as u64,
            }
        });
    let rates = rates.collect();
    let name = format!("horizon {} {}", player.label(), games.name());
    let horizon = Horizon::of(&name, episodes, Effect::Harms, ticks);
    HorizonRow { player, games, rates, horizon }
}

/// Returns the table of horizons, or `None` if no player has results for several numbers of actions per decision.
pub(in crate::study) fn table(study: &Study) -> Option<Table> {
    if study.horizons.is_empty() {
        return None;
    }
    let table = Table::of(
        "horizons",
        "How far players see ahead",
        "Horizon: the number of ticks that a player can commit to without looking again and still win half of its episodes on an average level, with a 95% interval over games (logistic in the logarithm of the \
         commitment, with level effects). A commitment longer than the shortest known win of a level counts \
         as a commitment of that length. No value is given below one tick or beyond four times the largest \
         commitment: ≤ and ≥ mark these bounds. Deterministic games require exact foresight; stochastic \
         games require plans that work whatever happens.",
        &study.horizons,
        &[
            ("player", &|row| TableCell::text(row.player.label())),
            ("games", &|row| TableCell::text(row.games.name())),
            ("horizon", &|row| TableCell::figure(row.horizon.horizon.map(|_| row.horizon.told_value()))),
            ("interval", &|row| TableCell::figure(row.horizon.horizon.map(|_| row.horizon.told_interval()))),
            ("won by commitment", &|row| {
                let one = |found: &CommitmentRate| {
                    let rate =
                        found.rate.map_or("–".to_owned(), |rate| format!("{:.0}%", 100.0 * rate.value));
                    format!("{}: {rate}", found.commit)
                };
                TableCell::text(row.rates.iter().map(one).join(", "))
            }),
            ("episodes", &|row| TableCell::Count(row.rates.iter().map(|rate| rate.episodes).sum())),
        ],
    );
    Some(table)
}
