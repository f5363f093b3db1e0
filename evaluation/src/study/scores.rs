//! The numbers of a set of episodes: of a player on a level, on a game, or on all.

use crate::metrics::EpisodeMetrics;
use crate::study::table::TableCell;
use serde::Serialize;
use statistics::{Interval, Z95, wilson};
use std::collections::{BTreeMap, BTreeSet};

/// A number with a 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Estimate {
    /// A number and its interval.
    pub fn new(value: f64, Interval { low, high }: Interval) -> Estimate {
        Estimate { value, low, high }
    }

    /// A win rate with its Wilson interval; `None` without trials.
    pub fn rate(wins: u64, trials: u64) -> Option<Estimate> {
        (trials > 0).then(|| Estimate::new(wins as f64 / trials as f64, wilson(wins, trials, Z95)))
    }

    /// As a cell of a table.
    pub fn cell(estimate: Option<Estimate>, digits: usize) -> TableCell {
        let cell = |Estimate { value, low, high }| TableCell::Interval { value, low, high, digits };
        estimate.map_or(TableCell::Missing, cell)
    }
}

/// An episode of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StudyEpisode {
    /// Who played: index into the players of the study.
    pub player: usize,
    /// What was played: index into the games of the study.
    pub game: usize,
    /// The score between the lowest and the highest of all players on this level: `(r − min) / (max − min + 1e-8)`. Missing where
    /// these are equal.
    pub normalised_reward: Option<f64>,
    /// The most steps of all episodes on this level, of all players.
    pub most_steps: u64,
    /// What was measured.
    #[serde(flatten)]
    pub metrics: EpisodeMetrics,
}

/// The numbers of a set of episodes. Means are over the episodes for which the number is known; episodes that were broken off
/// count in `excluded` alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scores {
    /// Episodes that ended.
    pub episodes: u64,
    /// Episodes that were broken off or are not finished.
    pub excluded: u64,
    /// Won.
    pub wins: u64,
    /// Ended by the limit of steps.
    pub timeouts: u64,
    /// Wins by episodes, with Wilson's interval.
    pub win_rate: Option<Estimate>,
    /// Mean meaningful step ratio.
    pub meaningful: Option<f64>,
    /// Mean meaningful step ratio by the reference's code.
    pub meaningful_as_code: Option<f64>,
    /// Mean steps.
    pub steps: Option<f64>,
    /// Mean score.
    pub score: Option<f64>,
    /// Mean normalised reward.
    pub normalised_reward: Option<f64>,
    /// Mean of `1 − steps / limit`.
    pub spared: Option<f64>,
    /// The overall score of the paper: the mean of meaningful step ratio, spared steps, normalised reward and win rate. Missing if
    /// one of the four is.
    pub overall: Option<f64>,
    /// Step efficiency: `1 − mean steps of wins / most steps of any episode` on a level, the mean over the levels that were won.
    pub efficiency: Option<f64>,
    /// Mean over the wins of `optimal ticks / steps`, where the optimum is proved.
    pub optimality: Option<f64>,
    /// Mean bump rate.
    pub bump_rate: Option<f64>,
}

impl Scores {
    /// The numbers of these episodes. Cost: O(episodes log episodes).
    pub fn of<'a>(episodes: impl IntoIterator<Item = &'a StudyEpisode>) -> Scores {
        let all: Vec<&StudyEpisode> = episodes.into_iter().collect();
        let ended: Vec<&StudyEpisode> =
            all.iter().copied().filter(|episode| episode.metrics.counts()).collect();
        let mean_of = |of: &dyn Fn(&StudyEpisode) -> Option<f64>| mean(ended.iter().filter_map(|e| of(e)));
        let wins = ended.iter().filter(|episode| episode.metrics.won()).count() as u64;
        let count = ended.len() as u64;
        let win_rate = Estimate::rate(wins, count);
        let meaningful = mean_of(&|e| e.metrics.meaningful);
        let spared = mean_of(&|e| e.metrics.spared());
        let normalised_reward = mean_of(&|e| e.normalised_reward);
        let parts = [meaningful, spared, normalised_reward, win_rate.map(|rate| rate.value)];
        let sum: Option<f64> = parts.into_iter().sum();
        Scores {
            episodes: count,
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
            spared,
            overall: sum.map(|sum| sum / parts.len() as f64),
            efficiency: efficiency(&ended),
            optimality: mean_of(&|e| e.metrics.optimality()),
            bump_rate: mean_of(&|e| e.metrics.movement.bump_rate),
        }
    }
}

/// The step efficiency of each level that was won; their mean.
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

/// The arithmetic mean; `None` of nothing.
pub(crate) fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    statistics::Summary::of(&values.into_iter().collect::<Vec<f64>>()).map(|summary| summary.mean)
}

/// Levels of these episodes, by game and number.
pub(crate) fn levels_of<'a>(
    episodes: impl IntoIterator<Item = &'a StudyEpisode>,
) -> BTreeSet<(usize, usize)> {
    episodes.into_iter().map(|episode| (episode.game, episode.metrics.level)).collect()
}

/// Puts normalised rewards and most steps into the episodes.
pub(crate) fn normalise(episodes: &mut [StudyEpisode]) {
    let mut ranges: BTreeMap<(usize, usize), (f64, f64, u64)> = BTreeMap::new();
    for episode in episodes.iter().filter(|episode| episode.metrics.counts()) {
        let (score, steps) = (episode.metrics.score, episode.metrics.steps);
        let range = ranges.entry((episode.game, episode.metrics.level)).or_insert((score, score, steps));
        *range = (range.0.min(score), range.1.max(score), range.2.max(steps));
    }
    for episode in episodes {
        let Some(&(least, most, steps)) = ranges.get(&(episode.game, episode.metrics.level)) else {
            continue;
        };
        let score = episode.metrics.score;
        // What keeps the paper's quotient from dividing by 0; where it would, nothing is known here.
        let reward = (score - least) / (most - least + 1e-8);
        episode.normalised_reward = (most > least && episode.metrics.counts()).then_some(reward);
        episode.most_steps = steps;
    }
}
