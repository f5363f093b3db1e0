//! Compares a study's players with the ceilings of the levels: the highest known win rates, as stored in a release.

use crate::commitment::Commitment;
use crate::metrics::EpisodeMetrics;
use crate::study::episodes::scores::{Estimate, levels_of};
use crate::study::{Study, StudyEpisode, StudyGame};
use crate::subject::LevelCeiling;
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{Bounded, Interval, Z95, ratio, weighted_mean, wilson};
use std::collections::BTreeMap;

/// The lowest ceiling with which a level counts, in percent.
const ENOUGH: u64 = 80;

/// A level whose episodes with one commitment do not count, because its ceiling is too low.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// The player's index in the study.
    pub player: usize,
    /// The game's folder name.
    pub game: String,
    /// The level number.
    pub level: usize,
    /// The number of actions that the player commits to at each decision.
    pub commit: Commitment,
    /// The commitment at which the ceiling was measured: `commit`, or the shortest measured one that it divides.
    pub measured: Commitment,
    /// The ceiling: the highest known win rate.
    pub ceiling: f64,
    /// The number of excluded episodes.
    pub episodes: u64,
}

/// A player's win rate relative to the ceilings (highest known win rates) of its levels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CeilingRow {
    /// The player's index in the study.
    pub player: usize,
    /// The number of levels that count.
    pub levels: u64,
    /// The number of levels that do not count, because their ceilings are too low.
    pub left_out: u64,
    /// The number of ended episodes on the levels that count.
    pub episodes: u64,
    /// The win rate on the levels that count.
    pub rate: Option<Estimate>,
    /// The mean ceiling of these episodes' levels.
    pub ceiling: Option<Estimate>,
    /// The win rate divided by the mean ceiling.
    pub relative: Option<Estimate>,
}

impl LevelCeiling {
    fn rate(&self) -> Bounded {
        match self.exact {
            true => (1.0, Interval { low: 1.0, high: 1.0 }),
            false => (self.wins as f64 / self.episodes as f64, wilson(self.wins, self.episodes, Z95)),
        }
    }
}

/// Returns the ceiling of a level at a commitment. If that commitment was not measured, returns the ceiling at the
/// shortest measured commitment that it divides, which is a lower bound. Returns `None` if the release contains no
/// ceiling of the level.
fn ceiling(game: &StudyGame, level: usize, commit: Commitment) -> Option<&LevelCeiling> {
    let known = game.ceilings.iter().filter(|known| known.level == level && known.episodes > 0);
    known.filter(|known| commit.divides(known.commit)).min_by_key(|known| known.commit)
}

/// Returns `true` if a level counts at a commitment. Levels without ceilings count.
pub(super) fn counts(game: &StudyGame, level: usize, commit: Commitment) -> bool {
    let known = ceiling(game, level, commit);
    known.is_none_or(|known| 100 * known.wins >= ENOUGH * known.episodes)
}

/// Separates a player's episodes on levels that count from all others.
pub(in crate::study) fn sorted(
    games: &[StudyGame],
    player: usize,
    episodes: Vec<EpisodeMetrics>,
) -> (Vec<EpisodeMetrics>, Vec<LeftOut>) {
    let game_of = |episode: &EpisodeMetrics| games.iter().find(|game| game.id == episode.game);
    let (counted, others): (Vec<_>, Vec<_>) = episodes
        .into_iter()
        .partition(|episode| game_of(episode).is_none_or(|game| counts(game, episode.level, episode.commit)));
    let mut left_out: BTreeMap<(String, usize, Commitment), LeftOut> = BTreeMap::new();
    for episode in others {
        let Some(known) = game_of(&episode).and_then(|game| ceiling(game, episode.level, episode.commit))
        else {
            continue;
        };
        let (measured, ceiling) = (known.commit, known.rate().0);
        let EpisodeMetrics { game, level, commit, .. } = episode;
        let own = left_out.entry((game.clone(), level, commit));
        own.or_insert(LeftOut { player, game, level, commit, measured, ceiling, episodes: 0 }).episodes += 1;
    }
    (counted, left_out.into_values().collect())
}

/// Ceilings by game and level.
type Named<'a> = BTreeMap<(&'a str, usize), f64>;

/// Returns a note for each commitment at which levels do not count, with the names and the ceilings of the levels.
pub(in crate::study) fn notes(study: &Study) -> Vec<String> {
    let mut levels: BTreeMap<(Commitment, Commitment), Named<'_>> = BTreeMap::new();
    for LeftOut { game, level, commit, measured, ceiling, .. } in &study.left_out {
        levels.entry((*commit, *measured)).or_default().insert((game, *level), *ceiling);
    }
    let note = |((commit, measured), levels): (_, Named<'_>)| {
        let mut named =
            levels.iter().map(|((game, level), ceiling)| format!("{game}-{level} ({ceiling:.2})"));
        let named = named.join(", ");
        let of = if commit == measured { String::new() } else { format!(" (measured at {measured})") };
        let count = match levels.len() {
            1 => "1 level".to_owned(),
            count => format!("{count} levels"),
        };
        format!(
            "At commitment {commit}, episodes on {count} are excluded from all numbers, because no player is known \
             to win {ENOUGH}% of the episodes there. The levels with their ceilings{of}: {named}."
        )
    };
    levels.into_iter().map(note).collect()
}

/// Returns a row for each player with episodes on levels with ceilings.
pub(in crate::study) fn rows(study: &Study) -> Vec<CeilingRow> {
    (0..study.players.len()).filter_map(|player| row(study, player)).collect()
}

fn row(study: &Study, player: usize) -> Option<CeilingRow> {
    let known = |episode: &StudyEpisode| {
        ceiling(&study.games[episode.game], episode.metrics.level, episode.metrics.commit)
    };
    let episodes = study.on(player, None, None).iter().filter(|episode| episode.metrics.counts());
    let episodes: Vec<&StudyEpisode> = episodes.filter(|episode| known(episode).is_some()).collect();
    let left_out = study.left_out.iter().filter(|left_out| left_out.player == player);
    let left_out = left_out.map(|left_out| (&left_out.game, left_out.level)).unique().count() as u64;
    if episodes.is_empty() && left_out == 0 {
        return None;
    }
    // A level's episodes share its ceiling, and with it the error of the ceiling.
    let mut ceilings: BTreeMap<(usize, usize, Commitment), (Bounded, f64)> = BTreeMap::new();
    for episode in &episodes {
        let Some(known) = known(episode) else { continue };
        let place = (episode.game, episode.metrics.level, episode.metrics.commit);
        ceilings.entry(place).or_insert((known.rate(), 0.0)).1 += 1.0;
    }
    let ceiling = weighted_mean(&ceilings.into_values().collect::<Vec<_>>());
    let rate = Estimate::rate(&episodes);
    let bounded = |Estimate { value, low, high }: Estimate| (value, Interval { low, high });
    let relative = rate.zip(ceiling).and_then(|(rate, ceiling)| ratio(bounded(rate), ceiling));
    let estimate = |(value, interval): Bounded| Estimate::new(value, interval);
    Some(CeilingRow {
        player,
        levels: levels_of(episodes.iter().copied()).len() as u64,
        left_out,
        episodes: episodes.len() as u64,
        rate,
        ceiling: ceiling.map(estimate),
        relative: relative.map(estimate),
    })
}

/// Returns the table of win rates relative to ceilings, or `None` if the releases contain no ceilings.
pub(in crate::study) fn table(study: &Study) -> Option<Table> {
    if study.ceilings.is_empty() {
        return None;
    }
    let table = Table::of(
        "ceilings",
        "Compared with the ceilings of the levels",
        "Ceiling: the highest known win rate on a level at the player's commitment, averaged over the episodes. A level \
         counts only if its ceiling is at least 0.8; the notes name the levels that do not count. Relative: win rate \
         divided by the mean ceiling. Its 95% interval covers the errors of both. A value above 1 means that the \
         player wins more often than the best known player.",
        &study.ceilings,
        &[
            ("player", &|row| TableCell::text(study.players[row.player].label())),
            ("levels", &|row| TableCell::Count(row.levels)),
            ("left out", &|row| TableCell::Count(row.left_out)),
            ("episodes", &|row| TableCell::Count(row.episodes)),
            ("win rate", &|row| Estimate::cell(row.rate, 2)),
            ("ceiling", &|row| Estimate::cell(row.ceiling, 2)),
            ("relative", &|row| Estimate::cell(row.relative, 2)),
        ],
    );
    Some(table)
}
