//! Players from weak to strong on one level: the win rate of each, and the difficulty that follows.

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
    // All players get the same seed in plays of the same number, so that they can be compared play by play.
    let chance = case.seed.child("chance", run);
    let seed = case.seed.seed().child(player.name(), run);
    play_until(case.game, case.level, &mut player.player(seed), player.budget(), chance, limits, stopped)
}

/// The results of one player.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayerResult {
    /// Its name: `mcts:500`.
    pub player: String,
    /// `true` if it looks ahead.
    pub looks_ahead: bool,
    /// Its win rate.
    pub rate: Rate,
    /// Mean ticks of the plays that were won, if any.
    pub win_ticks: Option<f64>,
    /// Mean score, scaled from 0 for the least to 1 for the greatest score of all plays of the rungs, without the
    /// held-out players; none if all scores are equal.
    pub reward: Option<f64>,
}

/// The results of a ladder of players.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ladder {
    /// From the weakest to the strongest, as the criteria name them.
    pub rungs: Vec<PlayerResult>,
    /// Players that are held out until acceptance.
    pub held_out: Vec<PlayerResult>,
    /// The ease, from 0 to 1 (`spec/06` §2.6); none without a player that looks ahead.
    pub ease: Option<f64>,
    /// The label of that ease.
    pub difficulty: Difficulty,
}

base::named_enum! {
    /// The difficulty of a level (`spec/06` §2.6).
    pub enum Difficulty {
        /// Ease of 0.8 or more.
        VeryEasy = "very_easy",
        /// 0.6 or more.
        Easy = "easy",
        /// 0.4 or more.
        Medium = "medium",
        /// 0.2 or more.
        Hard = "hard",
        /// Less.
        VeryHard = "very_hard",
        /// No player has won.
        Unbeaten = "unbeaten",
    }
}

impl Difficulty {
    /// The labels that can be requested, with the range of eases of each: from (inclusive) and below (exclusive).
    pub const LABELS: [(Difficulty, [f64; 2]); 5] = [
        (Difficulty::VeryEasy, [0.8, 1.0]),
        (Difficulty::Easy, [0.6, 0.8]),
        (Difficulty::Medium, [0.4, 0.6]),
        (Difficulty::Hard, [0.2, 0.4]),
        (Difficulty::VeryHard, [0.0, 0.2]),
    ];

    /// Returns the range of eases of this label; none if no player wins.
    pub fn eases(self) -> Option<[f64; 2]> {
        Difficulty::LABELS.into_iter().find(|(label, _)| *label == self).map(|(_, eases)| eases)
    }

    fn of(ease: f64) -> Difficulty {
        let found = Difficulty::LABELS.into_iter().find(|(_, [least, _])| ease >= *least);
        found.map_or(Difficulty::VeryHard, |(label, _)| label)
    }
}

/// The label is none of [`Difficulty::LABELS`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown difficulty `{0}`: choose very_easy, easy, medium, hard or very_hard")]
pub struct UnknownDifficulty(String);

impl FromStr for Difficulty {
    type Err = UnknownDifficulty;

    /// Reads a label that can be requested: `very_easy`, `very-easy` and `very easy` are equal.
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

/// The players of a ladder and the limits of their plays.
#[derive(Clone, Debug, PartialEq)]
pub struct LadderConfig {
    /// From the weakest to the strongest.
    pub rungs: Vec<ReferencePlanner>,
    /// Held-out players: they never guide a search.
    pub held_out: Vec<ReferencePlanner>,
    /// The greatest number of plays of each player.
    pub plays: u64,
    /// Forward-model calls of all plays together, after which no further round begins.
    pub calls: u64,
    /// Ticks of a play.
    pub ticks: usize,
    /// A play is broken off after this multiple of the ticks of the witness, and 50 more, if there is a witness.
    pub patience: usize,
}

/// Ticks added to the multiple of the witness's ticks.
const GRACE: usize = 50;

/// Plays of each player in a round.
const ROUND: u64 = 2;

/// The plays of each player, by number: the rungs, then the held-out players.
pub(crate) struct LadderPlays {
    pub(crate) plays: Vec<Vec<Play>>,
}

impl LadderPlays {
    /// Returns the number of plays that were broken off because their calls were spent.
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

    /// Measures the players on a level and the difficulty that follows.
    pub fn ladder(&self, case: Case<'_>) -> Ladder {
        self.measure(&self.play_all(case))
    }

    /// Measures the players, and returns all their plays.
    pub fn play(&self, case: Case<'_>) -> (Ladder, Vec<Episode>) {
        self.play_until(case, |_| false)
    }

    /// Like [`LadderConfig::play`], but no round of plays begins once there is `enough`: it gets the plays of each player, those
    /// held out last.
    pub fn play_until(
        &self,
        case: Case<'_>,
        enough: impl Fn(&[Vec<Play>]) -> bool,
    ) -> (Ladder, Vec<Episode>) {
        let played = self.play_within(case, u64::MAX, |played| enough(&played.plays), &|| false);
        (self.measure(&played), played.plays.into_iter().flatten().map(|play| play.episode).collect())
    }

    pub(crate) fn round_plays(&self) -> u64 {
        ROUND * self.players().count() as u64
    }

    /// Lets every player play equally often. Rounds go on until the plays, or the calls, are spent.
    pub(crate) fn play_all(&self, case: Case<'_>) -> LadderPlays {
        self.play_within(case, u64::MAX, |_| false, &|| false)
    }

    /// Like [`LadderConfig::play_all`], but a play is broken off at the first decision after `calls` calls, or at its tick
    /// limit, or once `stopped` returns `true`, and no round begins once there is `enough`.
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
            // The strongest players take longest, so they start first.
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

    /// Computes the results of the plays. The rewards of held-out players are scaled by the scores of the others, so
    /// that difficulty does not depend on held-out players.
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

/// The weighted mean of the win rate (0.6), the reward (0.2) and the step efficiency (0.2), which is
/// `1 − mean ticks of wins / ticks of the longest play`; a missing value (equal scores; no win) leaves its weight to the others.
fn ease(result: &PlayerResult, longest: f64) -> f64 {
    let Rate { wins, plays, .. } = result.rate;
    let won = wins as f64 / plays.max(1) as f64;
    let efficiency = result.win_ticks.filter(|_| longest > 0.0).map(|ticks| 1.0 - ticks / longest);
    let terms = [(0.6, Some(won)), (0.2, result.reward), (0.2, efficiency)];
    let weight: f64 = terms.iter().filter(|(_, term)| term.is_some()).map(|(weight, _)| weight).sum();
    terms.iter().map(|(weight, term)| weight * term.unwrap_or_default()).sum::<f64>() / weight
}

/// The win rate of some plays, with their scores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// Episodes won.
    pub wins: u64,
    /// Episodes played.
    pub plays: u64,
    /// Wilson score interval of the win rate, 95 %.
    pub interval: [f64; 2],
    /// Forward-model calls of all plays together.
    pub calls: u64,
    /// Mean score at the end.
    pub mean_score: f64,
}

impl Rate {
    /// Computes the rate of some plays.
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
