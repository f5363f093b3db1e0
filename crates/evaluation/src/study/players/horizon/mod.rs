//! Horizons: the largest demand at which a player still wins half of its episodes, or the smallest allowance. A demand is
//! a number of actions per decision, and an allowance is a number of tokens per answer.

pub(in crate::study) mod commitment;
pub(in crate::study) mod thinking;

use crate::study::episodes::scores::Estimate;
use crate::study::{Player, Study, StudyEpisode};
use itertools::Itertools;
use serde::Serialize;
use statistics::{DoseTrials, half_point};
use std::collections::BTreeMap;
use std::hash::Hash;

/// The number of bootstrap resamples for an interval.
const RESAMPLES: usize = 1000;

/// The maximum factor between a reported horizon and the nearest dose tried.
const BEYOND: f64 = 4.0;

/// The dose at which a player wins half of its episodes on an average level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Horizon {
    /// The dose, with its interval over games.
    pub horizon: Option<Estimate>,
    /// The lowest and the highest dose that can be reported.
    pub range: [f64; 2],
}

/// The effect of a higher dose on the win rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effect {
    /// The player wins less often.
    Harms,
    /// The player wins more often.
    Helps,
}

impl Horizon {
    /// Estimates the dose at which half of the episodes are won. `name` determines the bootstrap's random draws.
    fn of(
        name: &str,
        episodes: &[&StudyEpisode],
        effect: Effect,
        dose: impl Fn(&StudyEpisode) -> f64,
    ) -> Horizon {
        // The statistical model expects that a higher dose harms. The reciprocal of a helpful dose does.
        let modelled = |dose: f64| if effect == Effect::Harms { dose } else { 1.0 / dose };
        let mut trials: BTreeMap<usize, BTreeMap<usize, Vec<DoseTrials>>> = BTreeMap::new();
        for episode in episodes {
            let level = trials.entry(episode.game).or_default().entry(episode.metrics.level).or_default();
            let won = f64::from(u8::from(episode.metrics.won()));
            level.push(DoseTrials { dose: modelled(dose(episode)), won, of: 1.0 });
        }
        let groups: Vec<Vec<Vec<DoseTrials>>> =
            trials.into_values().map(|levels| levels.into_values().collect()).collect();
        let seed = blake3::hash(name.as_bytes());
        let found = half_point(&groups, RESAMPLES, crate::study::LEVEL, *seed.as_bytes());
        let doses = || episodes.iter().map(|episode| dose(episode));
        // No player can decide more often than once per action, and no answer has less than one token.
        let least = (doses().fold(f64::INFINITY, f64::min) / BEYOND).max(1.0);
        let range = [least, doses().fold(0.0, f64::max) * BEYOND];
        let horizon = found.map(|found| {
            let [value, low, high] =
                [found.dose, found.interval.low, found.interval.high].map(|dose| modelled(dose).max(least));
            Estimate { value, low: low.min(high), high: low.max(high) }
        });
        Horizon { horizon, range }
    }

    /// Formats the horizon, such as `12`, or `≥ 80` if only a bound is known. An unknown horizon is formatted as `–`.
    pub fn told_value(&self) -> String {
        self.horizon.map_or("–".to_owned(), |horizon| self.bounded(horizon.value))
    }

    /// Formats the interval of the horizon, or a single bound if both ends are equal.
    pub fn told_interval(&self) -> String {
        self.horizon.map_or(String::new(), |found| {
            let [low, high] = [found.low, found.high].map(|end| self.bounded(end));
            if low == high { low } else { format!("{low} to {high}") }
        })
    }

    /// Formats a dose, preceded by `≤` or `≥` at an end of the range.
    fn bounded(&self, dose: f64) -> String {
        let [least, most] = self.range;
        // The reciprocal of a reciprocal may differ in the last bits.
        let sign = if dose <= least * (1.0 + 1e-9) {
            "≤ "
        } else if dose >= most * (1.0 - 1e-9) {
            "≥ "
        } else {
            ""
        };
        let digits = usize::from(dose < 10.0 && sign.is_empty());
        format!("{sign}{dose:.digits$}")
    }
}

/// Returns the ended episodes by player. `is_dose` returns `true` for an aid that states an episode's dose. Players that
/// differ only in such aids are one player.
fn by_player(
    study: &Study,
    is_dose: impl Fn(&str, &StudyEpisode) -> bool,
) -> BTreeMap<Player, Vec<&StudyEpisode>> {
    let mut players: BTreeMap<Player, Vec<&StudyEpisode>> = BTreeMap::new();
    for episode in study.episodes.iter().filter(|episode| episode.metrics.counts()) {
        let mut player = study.players[episode.player].clone();
        player.aids.retain(|aid| !is_dose(aid, episode));
        players.entry(player).or_default().push(episode);
    }
    players
}

/// Returns the episodes by a setting, sorted by the setting.
fn by_setting<'a, T: Copy + Ord + Hash>(
    episodes: &[&'a StudyEpisode],
    setting: impl Fn(&StudyEpisode) -> T,
) -> Vec<(T, Vec<&'a StudyEpisode>)> {
    let groups = episodes.iter().copied().into_group_map_by(|episode| setting(episode));
    groups.into_iter().sorted_by_key(|(setting, _)| *setting).collect()
}
