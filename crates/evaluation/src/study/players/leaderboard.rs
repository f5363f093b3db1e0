//! A study's leaderboard, with the players' win rates and costs.

use crate::metrics::{Choices, Spending};
use crate::study::Study;
use crate::study::episodes::scores::{Estimate, Scores};
use report::{Table, TableCell};
use serde::Serialize;
use std::collections::BTreeMap;

/// A player's results on all its levels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeaderRow {
    /// The player's index in the study.
    pub player: usize,
    /// The scores over all the player's episodes.
    pub scores: Scores,
    /// The bounds of the win rate, computed as if all aborted episodes had been lost, or all had been won.
    /// `None` if no episode was aborted.
    pub bounds: Option<[f64; 2]>,
    /// The origins of the player's choices.
    pub choices: Choices,
    /// The cost of the player's choices.
    pub spending: Spending,
    /// The mean number of tokens per step, including input and output.
    pub tokens_per_step: Option<f64>,
    /// The number of aborted episodes, by reason.
    #[serde(rename = "broken_off")]
    pub aborted: BTreeMap<String, u64>,
}

/// Returns one row per player, sorted by win rate. Ties are broken by overall score, then by the order of the
/// study.
pub(crate) fn leaderboard(study: &Study) -> Vec<LeaderRow> {
    let mut rows: Vec<LeaderRow> = (0..study.players.len()).map(|player| row(study, player)).collect();
    rows.sort_by(|a, b| {
        let key = |row: &LeaderRow| (row.scores.win_rate.map_or(-1.0, |rate| rate.value), row.scores.overall);
        let (a, b) = (key(a), key(b));
        b.0.total_cmp(&a.0).then(b.1.unwrap_or(-1.0).total_cmp(&a.1.unwrap_or(-1.0)))
    });
    rows
}

fn row(study: &Study, player: usize) -> LeaderRow {
    let episodes = study.on(player, None, None);
    let scores = Scores::of(episodes);
    let (mut choices, mut spending, mut aborted) = Default::default();
    for episode in episodes {
        Choices::add(&mut choices, &episode.metrics.choices);
        Spending::add(&mut spending, &episode.metrics.spending);
        if let Some(reason) = episode.metrics.status.aborted() {
            *BTreeMap::entry(&mut aborted, reason.to_owned()).or_insert(0) += 1;
        }
    }
    let tokens = spending.input_tokens.zip(spending.output_tokens).map(|(input, output)| input + output);
    let tokens_per_step =
        tokens.filter(|_| choices.total() > 0).map(|sum| sum as f64 / choices.total() as f64);
    let started = scores.episodes + scores.excluded;
    let bounds = [scores.wins, scores.wins + scores.excluded].map(|wins| wins as f64 / started as f64);
    let bounds = (scores.excluded > 0).then_some(bounds);
    LeaderRow { player, scores, bounds, choices, spending, tokens_per_step, aborted }
}

/// Returns two tables: the leaderboard, and the origins of the players' choices.
pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let player = |row: &LeaderRow| TableCell::text(study.players[row.player].label());
    let leaders = Table::of(
        "leaderboard",
        "Leaderboard",
        "Win rate: wins divided by ended episodes, with a 95% interval for games like these (for a single game, for exactly these levels). Bounds: the win rate if all aborted episodes had been lost, and if all \
         had been won. Different: the number of episodes, with identical episodes of a level counted once. The overall score \
         is the mean of meaningful step ratio, spared steps, normalised reward and win rate; it also rewards \
         quick losses. Normalised reward, and with it the overall score, is relative to the players of \
         this report: it changes when players are added or removed. Optimality: proven minimum number of ticks \
         divided by steps, averaged over wins. Aborted: episodes stopped by the network, caps or interruptions, which are \
         excluded from all columns except the bounds.",
        &study.leaderboard,
        &[
            ("player", &player),
            ("episodes", &|row| TableCell::Count(row.scores.episodes)),
            ("different", &|row| TableCell::Count(row.scores.observations)),
            ("wins", &|row| TableCell::Count(row.scores.wins)),
            ("win rate", &|row| Estimate::cell(row.scores.win_rate, 2)),
            ("bounds", &|row| {
                TableCell::figure(row.bounds.map(|[low, high]| format!("{low:.2} to {high:.2}")))
            }),
            ("overall", &|row| TableCell::number(row.scores.overall, 3)),
            ("meaningful", &|row| TableCell::number(row.scores.meaningful, 3)),
            ("spared steps", &|row| TableCell::number(row.scores.unused_steps, 3)),
            ("normalised reward", &|row| TableCell::number(row.scores.normalised_reward, 3)),
            ("steps", &|row| TableCell::number(row.scores.steps, 1)),
            ("efficiency", &|row| TableCell::number(row.scores.efficiency, 3)),
            ("optimality", &|row| TableCell::number(row.scores.optimality, 3)),
            ("time-outs", &|row| TableCell::Count(row.scores.timeouts)),
            ("aborted", &|row| TableCell::Count(row.scores.excluded)),
        ],
    );
    let answers = Table::of(
        "answers",
        "Answers",
        "Steps by the kind of the player's answer. Tolerant: read from an answer that is not in the required \
         format. Invalid, refused and truncated answers have no effect in the game, and count against the \
         player. Tokens as counted by the provider, including cached answers.",
        &study.leaderboard,
        &[
            ("player", &player),
            ("steps", &|row| TableCell::Count(row.choices.total())),
            ("valid", &|row| TableCell::Count(row.choices.valid)),
            ("tolerant", &|row| TableCell::Count(row.choices.tolerant)),
            ("invalid", &|row| TableCell::Count(row.choices.invalid)),
            ("refused", &|row| TableCell::Count(row.choices.refused)),
            ("truncated", &|row| TableCell::Count(row.choices.truncated)),
            ("requests", &|row| TableCell::Count(row.spending.requests)),
            ("failed tries", &|row| TableCell::Count(row.spending.failures)),
            ("from cache", &|row| TableCell::Count(row.spending.cached_replies)),
            ("input tokens", &|row| TableCell::count(row.spending.input_tokens)),
            ("output tokens", &|row| TableCell::count(row.spending.output_tokens)),
            ("reasoning tokens", &|row| TableCell::count(row.spending.reasoning_tokens)),
            ("tokens per step", &|row| TableCell::number(row.tokens_per_step, 0)),
        ],
    );
    vec![leaders, answers]
}
