//! The scores of a set of episodes, such as a player's episodes on a level, on a game, or on all games.

use crate::metrics::EpisodeMetrics;
use crate::study::LEVEL;
use base::Digest;
use report::TableCell;
use serde::Serialize;
use statistics::{Interval, RateOverGames, Z95, rate_over_games, wilson};
use std::collections::{BTreeMap, BTreeSet};

/// An estimated number and its 95% confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimated number.
    pub value: f64,
    /// The interval's lower bound.
    pub low: f64,
    /// The interval's upper bound.
    pub high: f64,
}

impl Estimate {
    /// Creates an estimate from a number and its interval.
    pub fn new(value: f64, Interval { low, high }: Interval) -> Estimate {
        Estimate { value, low, high }
    }

    /// Returns the win rate of ended episodes, or `None` if there are no episodes. For several games, the
    /// interval applies to similar games ([`rate_over_games`]). For one game, the interval is Wilson's and
    /// applies to exactly its levels.
    ///
    /// A player's identical episodes on a level are one observation. The rate counts all of them, but the
    /// interval counts them once.
    pub(in crate::study) fn rate(ended: &[&StudyEpisode]) -> Option<Estimate> {
        let mut games: BTreeMap<usize, (u64, u64)> = BTreeMap::new();
        for episode in ended {
            let game = games.entry(episode.game).or_default();
            *game = (game.0 + u64::from(episode.metrics.won()), game.1 + 1);
        }
        let counts: Vec<(u64, u64)> = games.into_values().collect();
        if let Some(RateOverGames { rate, interval, .. }) = rate_over_games(&counts, LEVEL) {
            return Some(Estimate::new(rate, interval));
        }
        let &[(wins, episodes)] = &counts[..] else { return None };
        let (seen, of) = observations(ended.iter().copied());
        // Won and lost episodes may have different numbers of copies, so the rate is computed from all
        // episodes.
        let (rate, interval) = (wins as f64 / episodes as f64, wilson(seen, of, Z95));
        Some(Estimate { value: rate, low: interval.low.min(rate), high: interval.high.max(rate) })
    }

    /// Formats an estimate as a table cell.
    pub fn cell(estimate: Option<Estimate>, digits: usize) -> TableCell {
        let cell = |Estimate { value, low, high }| TableCell::Interval { value, low, high, digits };
        estimate.map_or(TableCell::Missing, cell)
    }
}

/// An episode of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StudyEpisode {
    /// The player's index in the study.
    pub player: usize,
    /// The game's index in the study.
    pub game: usize,
    /// The score relative to the range of all players' scores on this level, `(r − min) / (max − min +
    /// 1e-8)`. `None` if the range is empty, or if the episode was aborted.
    pub normalised_reward: Option<f64>,
    /// The maximum number of steps in any player's episode on this level.
    pub most_steps: u64,
    /// The metrics of the episode.
    #[serde(flatten)]
    pub metrics: EpisodeMetrics,
}

/// The scores of a set of episodes. Each mean covers the episodes with a known value. Aborted episodes count
/// only in `excluded`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scores {
    /// The number of ended episodes.
    pub episodes: u64,
    /// The number of aborted or unfinished episodes.
    pub excluded: u64,
    /// The number of won episodes.
    pub wins: u64,
    /// The number of episodes that reached the step limit.
    pub timeouts: u64,
    /// The number of observations. Identical episodes of a player on a level are one observation.
    pub observations: u64,
    /// The number of wins divided by the number of episodes. The interval applies to similar games, or to
    /// exactly the played levels if they all belong to one game.
    pub win_rate: Option<Estimate>,
    /// The mean meaningful step ratio.
    pub meaningful: Option<f64>,
    /// The mean meaningful step ratio according to the reference code.
    pub meaningful_as_code: Option<f64>,
    /// The mean number of steps.
    pub steps: Option<f64>,
    /// The mean score.
    pub score: Option<f64>,
    /// The mean normalised reward.
    pub normalised_reward: Option<f64>,
    /// The mean fraction of unused steps, `1 − steps / limit`.
    #[serde(rename = "spared")]
    pub unused_steps: Option<f64>,
    /// The paper's overall score: the mean of the meaningful step ratio, the fraction of unused steps, the
    /// normalised reward and the win rate. `None` if one of the four values is missing.
    pub overall: Option<f64>,
    /// The step efficiency, averaged over the levels with wins. A level's efficiency is `1 − mean steps of
    /// wins / most steps of any episode`.
    pub efficiency: Option<f64>,
    /// The mean of `optimal ticks / steps` over the wins on levels whose shortest win was proved to be
    /// optimal.
    pub optimality: Option<f64>,
    /// The mean bump rate.
    pub bump_rate: Option<f64>,
}

impl Scores {
    /// Computes the scores of the given episodes. Cost: O(episodes log episodes).
    pub fn of<'a>(episodes: impl IntoIterator<Item = &'a StudyEpisode>) -> Scores {
        let all: Vec<&StudyEpisode> = episodes.into_iter().collect();
        let ended: Vec<&StudyEpisode> =
            all.iter().copied().filter(|episode| episode.metrics.counts()).collect();
        let mean_of = |of: &dyn Fn(&StudyEpisode) -> Option<f64>| mean(ended.iter().filter_map(|e| of(e)));
        let wins = ended.iter().filter(|episode| episode.metrics.won()).count() as u64;
        let count = ended.len() as u64;
        let win_rate = Estimate::rate(&ended);
        let meaningful = mean_of(&|e| e.metrics.meaningful);
        let unused_steps = mean_of(&|e| e.metrics.unused_steps());
        let normalised_reward = mean_of(&|e| e.normalised_reward);
        let parts = [meaningful, unused_steps, normalised_reward, win_rate.map(|rate| rate.value)];
        let sum: Option<f64> = parts.into_iter().sum();
        Scores {
            episodes: count,
            observations: observations(ended.iter().copied()).1,
            excluded: (all.len() - ended.len()) as u64,
            wins,
            timeouts: ended
                .iter()
                .filter(|e| e.metrics.status == crate::metrics::EpisodeStatus::StepLimit)
                .count() as u64,
            win_rate,
            meaningful,
            meaningful_as_code: mean_of(&|e| e.metrics.meaningful_as_code),
            steps: mean_of(&|e| Some(e.metrics.steps as f64)),
            score: mean_of(&|e| Some(e.metrics.score)),
            normalised_reward,
            unused_steps,
            overall: sum.map(|sum| sum / parts.len() as f64),
            efficiency: efficiency(&ended),
            optimality: mean_of(&|e| e.metrics.optimality()),
            bump_rate: mean_of(&|e| e.metrics.movement.bump_rate),
        }
    }
}

/// Returns the number of wins and the number of episodes, not counting duplicates. A player's episodes on a
/// level are duplicates if their actions and boards are the same.
pub(crate) fn observations<'a>(ended: impl Iterator<Item = &'a StudyEpisode>) -> (u64, u64) {
    let mut seen: BTreeSet<(usize, usize, usize, Digest)> = BTreeSet::new();
    let new = ended.filter(|episode| {
        let course = episode.metrics.course;
        course.is_none_or(|course| seen.insert((episode.player, episode.game, episode.metrics.level, course)))
    });
    new.fold((0, 0), |(wins, all), episode| (wins + u64::from(episode.metrics.won()), all + 1))
}

/// Returns the mean step efficiency over all levels with wins.
fn efficiency(ended: &[&StudyEpisode]) -> Option<f64> {
    let mut levels: BTreeMap<(usize, usize), (Vec<f64>, u64)> = BTreeMap::new();
    for episode in ended.iter().filter(|episode| episode.metrics.won()) {
        let level = levels.entry((episode.game, episode.metrics.level)).or_default();
        level.0.push(episode.metrics.steps as f64);
        level.1 = episode.most_steps;
    }
    let levels = levels.into_values().filter(|(_, most)| *most > 0);
    mean(levels.filter_map(|(steps, most)| Some(1.0 - mean(steps)? / most as f64)))
}

/// Returns the arithmetic mean, or `None` if there are no values.
pub(crate) fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    statistics::Summary::of(&values.into_iter().collect::<Vec<f64>>()).map(|summary| summary.mean)
}

/// Returns the episodes' levels, as pairs of game index and level number.
pub(crate) fn levels_of<'a>(
    episodes: impl IntoIterator<Item = &'a StudyEpisode>,
) -> BTreeSet<(usize, usize)> {
    episodes.into_iter().map(|episode| (episode.game, episode.metrics.level)).collect()
}

/// Sets the normalised reward and the maximum number of steps of all episodes.
pub(crate) fn normalise(episodes: &mut [StudyEpisode]) {
    let place = |episode: &StudyEpisode| (episode.metrics.track.clone(), episode.game, episode.metrics.level);
    let mut ranges: BTreeMap<_, (f64, f64, u64)> = BTreeMap::new();
    for episode in episodes.iter().filter(|episode| episode.metrics.counts()) {
        let (score, steps) = (episode.metrics.score, episode.metrics.steps);
        let range = ranges.entry(place(episode)).or_insert((score, score, steps));
        *range = (range.0.min(score), range.1.max(score), range.2.max(steps));
    }
    for episode in episodes {
        let Some(&(least, most, steps)) = ranges.get(&place(episode)) else {
            continue;
        };
        let score = episode.metrics.score;
        // In the paper, the small term prevents a division by zero. Here, the value is missing if the range
        // is empty.
        let reward = (score - least) / (most - least + 1e-8);
        episode.normalised_reward = (most > least && episode.metrics.counts()).then_some(reward);
        episode.most_steps = steps;
    }
}
