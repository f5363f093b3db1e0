//! The advantage of the strongest player over the players that do not look ahead, across all levels of a game.

use crate::reported::in_order;
use engine::{Analysis, Level};
use serde::{Deserialize, Serialize};
use statistics::{Z95, bootstrap, difference};
use validators::{Criteria, Criterion, PlayerResult, Report};

/// The number of resamples per score interval.
const RESAMPLES: usize = 1000;

/// The name of a player that has found a plan. It is used on levels where a plan that has won once always wins.
pub const SEARCH: &str = "search";

/// The advantage of the strongest player over the best player that does not look ahead.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Edge {
    /// The strongest player. It is the player with the most wins among those that look ahead; ties go to the highest
    /// score. In a deterministic game, it is [`SEARCH`] if that player has more wins.
    pub strongest: String,
    /// The strongest player's number of wins, across all levels.
    pub wins: u64,
    /// The number of episodes per player, across all levels.
    pub plays: u64,
    /// The best player that does not look ahead: the player with the most wins, with ties going to the highest score.
    pub floor: String,
    /// The number of wins of the best player that does not look ahead, across all levels.
    pub floor_wins: u64,
    /// The difference between the two players' win rates, from −1 to 1.
    pub points: f64,
    /// Newcombe's 95% interval of the difference.
    pub interval: [f64; 2],
    /// The mean gain in score of the strongest player on the ladder of reference players over the player in `floor`, as
    /// a fraction of the level's score range. The two players' episodes are paired by their random seeds. `None` if no
    /// level has differing scores.
    pub score: Option<f64>,
    /// The 95% bootstrap interval of the gain in score, over episodes; `None` without such a gain.
    pub score_interval: Option<[f64; 2]>,
    /// `true` if the difference in win rate or in score is as large as the criteria require and significantly above 0.
    pub pays: bool,
}

/// A player's results across all levels.
struct Player {
    name: String,
    looks_ahead: bool,
    held_out: bool,
    wins: u64,
    plays: u64,
    /// The scores of all episodes on levels where scores differ, scaled from 0 for the lowest to 1 for the highest.
    scores: Vec<f64>,
}

impl Player {
    fn rate(&self) -> f64 {
        self.wins as f64 / self.plays.max(1) as f64
    }

    fn score(&self) -> f64 {
        self.scores.iter().sum::<f64>() / self.scores.len().max(1) as f64
    }

    /// Returns the key by which players are compared: first their wins, then their scores.
    fn fares(&self) -> (f64, f64) {
        (self.rate(), self.score())
    }
}

/// Returns the players with their results over all levels. The players of the ladder come first, from weakest to
/// strongest, followed by the held-out players. Levels that the ladder did not play are skipped.
fn players(reports: &[Report]) -> Vec<Player> {
    let mut players: Vec<Player> = Vec::new();
    for report in reports {
        let Some(found) = report.finding(Criterion::Skill) else { continue };
        let Some(ladder) = &found.ladder else { continue };
        // The episodes of all players are in one list, player by player.
        let mut left = &found.episodes[..];
        let plays = |fared: &PlayerResult| fared.rate.plays as usize;
        let all = &left[..ladder.rungs.iter().map(plays).sum::<usize>().min(left.len())];
        let scores = || all.iter().map(|episode| episode.score);
        let (least, greatest) =
            (scores().fold(f64::INFINITY, f64::min), scores().fold(f64::NEG_INFINITY, f64::max));
        for (at, fared) in ladder.rungs.iter().chain(&ladder.held_out).enumerate() {
            let (own, rest) = left.split_at(plays(fared).min(left.len()));
            left = rest;
            if players.len() == at {
                let (name, looks_ahead) = (fared.player.clone(), fared.looks_ahead);
                let held_out = at >= ladder.rungs.len();
                players.push(Player { name, looks_ahead, held_out, wins: 0, plays: 0, scores: Vec::new() });
            }
            let player = &mut players[at];
            player.wins += fared.rate.wins;
            player.plays += fared.rate.plays;
            if least < greatest {
                let share = |score: f64| ((score - least) / (greatest - least)).clamp(0.0, 1.0);
                player.scores.extend(own.iter().map(|episode| share(episode.score)));
            }
        }
    }
    players
}

impl Edge {
    /// Computes the advantage of the strongest reference player that looks ahead over the best one that does not. Only
    /// players on the ladder count. Returns `None` if there is no ladder, or if all or none of its players look ahead.
    /// The players must have the same names in all reports.
    pub(super) fn of(
        analysis: &Analysis,
        levels: &[Level],
        reports: &[Report],
        criteria: &Criteria,
    ) -> Option<Edge> {
        Edge::among(analysis, levels, reports, criteria, false)
    }

    /// Computes the advantage like [`Edge::of`], but for the strongest of the held-out players, which no search has
    /// used. Returns `None` if no held-out player looks ahead, or if every player on the ladder does.
    pub(crate) fn held_out(
        analysis: &Analysis,
        levels: &[Level],
        reports: &[Report],
        criteria: &Criteria,
    ) -> Option<Edge> {
        Edge::among(analysis, levels, reports, criteria, true)
    }

    fn among(
        analysis: &Analysis,
        levels: &[Level],
        reports: &[Report],
        criteria: &Criteria,
        held_out: bool,
    ) -> Option<Edge> {
        let players = players(reports);
        let best = |kind: &dyn Fn(&&Player) -> bool| {
            let kind = players.iter().filter(kind);
            kind.max_by(|a, b| a.fares().partial_cmp(&b.fares()).expect("scores are numbers"))
        };
        let strong = best(&|player| player.looks_ahead && player.held_out == held_out)?;
        let floor = best(&|player| !player.looks_ahead && !player.held_out)?;
        // On deterministic levels, any win is a plan that always wins.
        let is_plan = |(report, level): &(&Report, &Level)| {
            report.witness.is_some() && analysis.is_deterministic_in(level)
        };
        let plans: u64 = reports.iter().zip(levels).filter(is_plan).map(|(report, _)| plays_of(report)).sum();
        let (strongest, wins) =
            if plans > strong.wins { (SEARCH, plans) } else { (strong.name.as_str(), strong.wins) };
        let plays = strong.plays;
        let interval = difference([wins, floor.wins], [plays, floor.plays], Z95);
        let points = wins as f64 / plays.max(1) as f64 - floor.rate();
        let gains: Vec<f64> = strong.scores.iter().zip(&floor.scores).map(|(a, b)| a - b).collect();
        let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
        let sure = bootstrap(&gains, mean, RESAMPLES, 0.95, [0; 32]);
        let score = sure.map(|_| mean(&gains));
        let wins_pay = points >= criteria.skill_wins && interval.low > 0.0;
        let scores_pay = score.is_some_and(|gain| gain >= criteria.skill_scores)
            && sure.is_some_and(|interval| interval.low > 0.0);
        Some(Edge {
            strongest: strongest.to_owned(),
            wins,
            plays,
            floor: floor.name.clone(),
            floor_wins: floor.wins,
            points,
            interval: [interval.low, interval.high],
            score,
            score_interval: sure.map(|interval| [interval.low, interval.high]),
            pays: wins_pay || scores_pay,
        })
    }
}

/// Returns the number of episodes that each reference player played on a level.
fn plays_of(report: &Report) -> u64 {
    report.ladder().and_then(|ladder| ladder.rungs.first()).map_or(0, |fared| fared.rate.plays)
}

/// Returns the rank correlation between the reference players' positions on the ladder (from weak to strong) and their
/// results over all levels, compared by wins first and then by score. The correlation is 1 if every stronger player
/// does better, and 0 if all players do equally well. Returns `None` if no ladder played.
pub(super) fn ladder_order(reports: &[Report]) -> Option<f64> {
    let mut players = players(reports);
    players.retain(|player| !player.held_out);
    let fares: Vec<(f64, f64)> = players.iter().map(Player::fares).collect();
    (fares.len() > 1).then(|| in_order(&fares).unwrap_or(0.0))
}
