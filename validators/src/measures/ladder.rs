//! A ladder of reference players, from weak to strong, on one level: each player's win rate, and the resulting
//! difficulty.

use crate::case::Case;
use agents::{Limits, Play, ReferencePlanner, Stopped, play_until};
use engine::{Episode, Outcome};
use itertools::Itertools;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

fn play_once(
    player: &ReferencePlanner,
    case: Case<'_>,
    run: u64,
    limits: Limits,
    stopped: Stopped<'_>,
) -> Play {
    // In episodes with the same number, all players get the same seed, so that they can be compared episode by episode.
    let chance = case.seed.child("chance", run);
    let seed = case.seed.seed().child(player.name(), run);
    play_until(case.game, case.level, &mut player.player(seed), player.budget(), chance, limits, stopped)
}

/// One player's results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayerResult {
    /// The player's name, such as `mcts:500`.
    pub player: String,
    /// `true` if the player looks ahead.
    pub looks_ahead: bool,
    /// The player's win rate.
    pub rate: Rate,
    /// The mean number of ticks in the won episodes, or `None` if no episode was won.
    pub win_ticks: Option<f64>,
    /// The mean score, scaled from 0 (lowest) to 1 (highest). The range covers the episodes of all players on the
    /// ladder, but not those of the held-out players. `None` if all scores are equal.
    pub reward: Option<f64>,
}

/// The results of a ladder, which is a list of reference players of increasing strength, on one level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ladder {
    /// The results of the reference players on the ladder, from weakest to strongest, in the order of the criteria.
    pub rungs: Vec<PlayerResult>,
    /// The results of the players that are held out until acceptance.
    pub held_out: Vec<PlayerResult>,
    /// The level's ease, from 0 to 1 (`spec/06` §2.6), or `None` if no player looks ahead.
    pub ease: Option<f64>,
    /// The difficulty label for the ease.
    pub difficulty: Difficulty,
}

base::named_enum! {
    /// A level's difficulty (`spec/06` §2.6).
    pub enum Difficulty {
        /// The ease is 0.8 or more.
        VeryEasy = "very_easy",
        /// The ease is at least 0.6 and less than 0.8.
        Easy = "easy",
        /// The ease is at least 0.4 and less than 0.6.
        Medium = "medium",
        /// The ease is at least 0.2 and less than 0.4.
        Hard = "hard",
        /// The ease is less than 0.2.
        VeryHard = "very_hard",
        /// No player has won.
        Unbeaten = "unbeaten",
    }
}

impl Difficulty {
    /// The labels that can be requested, each with its ease range: lower end (inclusive) and upper end (exclusive).
    pub const LABELS: [(Difficulty, [f64; 2]); 5] = [
        (Difficulty::VeryEasy, [0.8, 1.0]),
        (Difficulty::Easy, [0.6, 0.8]),
        (Difficulty::Medium, [0.4, 0.6]),
        (Difficulty::Hard, [0.2, 0.4]),
        (Difficulty::VeryHard, [0.0, 0.2]),
    ];

    /// Returns a label's ease range, or `None` for [`Difficulty::Unbeaten`].
    pub fn eases(self) -> Option<[f64; 2]> {
        Difficulty::LABELS.into_iter().find(|(label, _)| *label == self).map(|(_, eases)| eases)
    }

    fn of(ease: f64) -> Difficulty {
        let found = Difficulty::LABELS.into_iter().find(|(_, [least, _])| ease >= *least);
        found.map_or(Difficulty::VeryHard, |(label, _)| label)
    }
}

/// The error for a label not in [`Difficulty::LABELS`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown difficulty `{0}`: choose very_easy, easy, medium, hard or very_hard")]
pub struct UnknownDifficulty(String);

impl FromStr for Difficulty {
    type Err = UnknownDifficulty;

    /// Parses a requestable label. For example, `very_easy`, `very-easy` and `very easy` are equivalent.
    fn from_str(text: &str) -> Result<Difficulty, UnknownDifficulty> {
        let plain = text.replace(['_', '-'], " ");
        let mut labels = Difficulty::LABELS.into_iter().map(|(label, _)| label);
        labels.find(|label| label.to_string() == plain).ok_or_else(|| UnknownDifficulty(text.to_owned()))
    }
}

impl fmt::Display for Difficulty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name().replace('_', " "))
    }
}

/// The reference players of a ladder, and the limits on their episodes.
#[derive(Clone, Debug, PartialEq)]
pub struct LadderConfig {
    /// The players, from weakest to strongest.
    pub rungs: Vec<ReferencePlanner>,
    /// The held-out players, which never guide a search.
    pub held_out: Vec<ReferencePlanner>,
    /// The maximum number of episodes per player.
    pub plays: u64,
    /// The total number of forward-model calls across all episodes after which no further round begins.
    pub calls: u64,
    /// The maximum number of ticks per episode.
    pub ticks: usize,
    /// If there is a witness, an episode's tick limit is this multiple of the witness's ticks, plus 50.
    pub patience: usize,
}

/// The number of ticks added to the multiple of the witness's ticks to get the tick limit.
const GRACE: usize = 50;

/// The number of episodes per player in a round.
const ROUND: u64 = 2;

/// Each player's episodes, by number. The players on the ladder come first, followed by the held-out players.
pub(crate) struct LadderPlays {
    pub(crate) plays: Vec<Vec<Play>>,
}

impl LadderPlays {
    /// Returns the number of episodes that were stopped because their calls ran out.
    pub(crate) fn broken_off(&self, calls: u64) -> usize {
        let is_cut = |play: &&Play| {
            play.episode.outcome == Outcome::Ongoing
                && (play.calls >= calls || play.episode.actions.len() as u64 >= calls)
        };
        self.plays.iter().flatten().filter(is_cut).count()
    }
}

impl LadderConfig {
    fn players(&self) -> impl Iterator<Item = &ReferencePlanner> {
        self.rungs.iter().chain(&self.held_out)
    }

    /// Measures the players on a level and the resulting difficulty.
    pub fn ladder(&self, case: Case<'_>) -> Ladder {
        self.measure(&self.play_all(case))
    }

    /// Measures the players, and returns all their episodes.
    pub fn play(&self, case: Case<'_>) -> (Ladder, Vec<Episode>) {
        let played = self.play_all(case);
        (self.measure(&played), played.plays.into_iter().flatten().map(|play| play.episode).collect())
    }

    pub(crate) fn round_plays(&self) -> u64 {
        ROUND * self.players().count() as u64
    }

    /// Plays the same number of episodes with every player, in rounds, until the episodes or the calls run
    /// out.
    pub(crate) fn play_all(&self, case: Case<'_>) -> LadderPlays {
        self.play_within(case, u64::MAX, |_| false, &|| false)
    }

    /// Plays like [`LadderConfig::play_all`], with three additional limits. An episode stops at the first decision
    /// after `calls` calls, at its tick limit, or once `stopped` returns `true`. No further round starts once `enough`
    /// returns `true`.
    pub(crate) fn play_within(
        &self,
        case: Case<'_>,
        calls: u64,
        enough: impl Fn(&LadderPlays) -> bool,
        stopped: Stopped<'_>,
    ) -> LadderPlays {
        let patient = |witness: &Episode| self.patience.saturating_mul(witness.actions.len()) + GRACE;
        let ticks = self.ticks.min(case.witness.map_or(usize::MAX, patient));
        let ticks = ticks.min(usize::try_from(calls).unwrap_or(usize::MAX));
        let limits = Limits { ticks, calls };
        let players: Vec<&ReferencePlanner> = self.players().collect();
        let mut all = LadderPlays { plays: vec![Vec::new(); players.len()] };
        let mut spent = 0;
        let mut played = 0;
        while played < self.plays && (played == 0 || spent < self.calls && !enough(&all) && !stopped()) {
            let runs = played..self.plays.min(played + ROUND);
            played = runs.end;
            // The strongest players take longest, so their episodes start first.
            let tasks: Vec<(usize, u64)> = (0..players.len()).rev().cartesian_product(runs.clone()).collect();
            let done: Vec<Play> = tasks
                .par_iter()
                .map(|&(player, run)| play_once(players[player], case, run, limits, stopped))
                .collect();
            spent += done.iter().map(|play| play.calls + play.episode.actions.len() as u64).sum::<u64>();
            for ((player, _), play) in tasks.into_iter().zip(done) {
                all.plays[player].push(play);
            }
        }
        all
    }

    /// Computes the results from the episodes. The rewards of held-out players are scaled by the other players' scores,
    /// so that difficulty does not depend on held-out players.
    pub(crate) fn measure(&self, played: &LadderPlays) -> Ladder {
        let all = || played.plays[..self.rungs.len()].iter().flatten().map(|play| &play.episode);
        let scores = || all().map(|episode| episode.score);
        let (least, greatest) =
            (scores().fold(f64::INFINITY, f64::min), scores().fold(f64::NEG_INFINITY, f64::max));
        let longest = all().map(|episode| episode.actions.len()).max().unwrap_or_default() as f64;
        let result = |(rung, plays): (&ReferencePlanner, &Vec<Play>)| {
            let rate = Rate::of(plays);
            let won: Vec<f64> = plays.iter().filter_map(|play| won_in(&play.episode)).collect();
            let reward =
                (least < greatest).then(|| ((rate.mean_score - least) / (greatest - least)).clamp(0.0, 1.0));
            PlayerResult {
                player: rung.name().to_owned(),
                looks_ahead: rung.looks_ahead(),
                win_ticks: statistics::Summary::of(&won).map(|summary| summary.mean),
                reward,
                rate,
            }
        };
        let mut rungs: Vec<PlayerResult> = self.players().zip(&played.plays).map(result).collect();
        let held_out = rungs.split_off(self.rungs.len());
        let eases: Vec<f64> =
            rungs.iter().filter(|result| result.looks_ahead).map(|result| ease(result, longest)).collect();
        let ease = statistics::Summary::of(&eases).map(|summary| summary.mean);
        let beaten = rungs.iter().any(|result| result.rate.wins > 0);
        let difficulty = if beaten { Difficulty::of(ease.unwrap_or_default()) } else { Difficulty::Unbeaten };
        Ladder { rungs, held_out, ease, difficulty }
    }
}

fn won_in(episode: &Episode) -> Option<f64> {
    (episode.outcome == Outcome::Won).then_some(episode.actions.len() as f64)
}

/// Returns the weighted mean of the win rate (0.6), the reward (0.2) and the step efficiency (0.2). The step efficiency
/// is `1 − mean ticks of wins / ticks of the longest episode`. The reward is missing if all scores are equal, and the
/// efficiency is missing if there is no win. The weight of a missing value is distributed over the others.
fn ease(result: &PlayerResult, longest: f64) -> f64 {
    let Rate { wins, plays, .. } = result.rate;
    let won = wins as f64 / plays.max(1) as f64;
    let efficiency = result.win_ticks.filter(|_| longest > 0.0).map(|ticks| 1.0 - ticks / longest);
    let terms = [(0.6, Some(won)), (0.2, result.reward), (0.2, efficiency)];
    let weight: f64 = terms.iter().filter(|(_, term)| term.is_some()).map(|(weight, _)| weight).sum();
    terms.iter().map(|(weight, term)| weight * term.unwrap_or_default()).sum::<f64>() / weight
}

/// The win rate in some episodes, with their scores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// The number of episodes won.
    pub wins: u64,
    /// The number of episodes played.
    pub plays: u64,
    /// The 95% Wilson score interval of the win rate.
    pub interval: [f64; 2],
    /// The total number of forward-model calls over all episodes.
    pub calls: u64,
    /// The mean final score.
    pub mean_score: f64,
}

impl Rate {
    /// Computes the win rate and the mean score over some episodes.
    pub fn of<'a>(plays: impl IntoIterator<Item = &'a Play>) -> Rate {
        let plays: Vec<&Play> = plays.into_iter().collect();
        let wins = plays.iter().filter(|play| play.episode.outcome == Outcome::Won).count() as u64;
        let interval = statistics::wilson(wins, plays.len() as u64, statistics::Z95);
        let scores: Vec<f64> = plays.iter().map(|play| play.episode.score).collect();
        Rate {
            wins,
            plays: plays.len() as u64,
            interval: [interval.low, interval.high],
            calls: plays.iter().map(|play| play.calls).sum(),
            mean_score: statistics::Summary::of(&scores).map_or(0.0, |summary| summary.mean),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(wins: u64, reward: Option<f64>, win_ticks: Option<f64>, expect: f64, label: Difficulty) {
        let rate = Rate { wins, plays: 10, interval: [0.0, 1.0], calls: 0, mean_score: 0.0 };
        let result = PlayerResult { player: String::new(), looks_ahead: true, rate, win_ticks, reward };
        let found = ease(&result, 100.0);
        assert!((found - expect).abs() < 1e-12, "{found}");
        assert_eq!(Difficulty::of(found), label);
    }

    #[test]
    fn ease_is_a_weighted_mean_of_known_terms() {
        check(10, Some(1.0), Some(10.0), 0.98, Difficulty::VeryEasy);
        check(10, None, Some(100.0), 0.75, Difficulty::Easy);
        check(5, Some(0.5), Some(50.0), 0.5, Difficulty::Medium);
        check(0, Some(1.0), None, 0.25, Difficulty::Hard);
        check(0, None, None, 0.0, Difficulty::VeryHard);
    }
}
