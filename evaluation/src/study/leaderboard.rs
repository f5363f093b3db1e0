//! The win rates of the players, and their cost.

use crate::metrics::{Choices, Spending};
use crate::study::scores::{Estimate, Scores, mean};
use crate::study::{LEVEL, RESAMPLES, Study, seed};
use report::{Table, TableCell};
use serde::Serialize;
use statistics::clustered_mean;
use std::collections::BTreeMap;

/// The results of a player on all levels it played.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeaderRow {
    /// The index into the players of the study.
    pub player: usize,
    /// The scores. The confidence interval of the win rate treats episodes as independent.
    pub scores: Scores,
    /// The win rate with a confidence interval from a bootstrap over whole games, which treats games rather than episodes as
    /// independent. Missing with fewer than two games.
    pub by_game: Option<Estimate>,
    /// The origins of the choices.
    pub choices: Choices,
    /// The cost of the choices.
    pub spending: Spending,
    /// The mean number of input and output tokens per step.
    pub tokens_per_step: Option<f64>,
    /// The number of aborted episodes by reason.
    #[serde(rename = "broken_off")]
    pub aborted: BTreeMap<String, u64>,
}

/// Returns a row for each player: by win rate, then overall score, then in the order of the study.
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
    let mut games: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for episode in episodes.iter().filter(|episode| episode.metrics.counts()) {
        games.entry(episode.game).or_default().push(f64::from(u8::from(episode.metrics.won())));
    }
    let games: Vec<Vec<f64>> = games.into_values().collect();
    let interval = clustered_mean(&games, RESAMPLES, LEVEL, seed("leaderboard", player));
    let by_game = mean(games.iter().flatten().copied())
        .zip(interval)
        .filter(|_| games.len() > 1)
        .map(|(value, interval)| Estimate::new(value, interval));
    LeaderRow { player, scores, by_game, choices, spending, tokens_per_step, aborted }
}

/// Returns the leaderboard and the table of the choices' origins.
pub(crate) fn tables(study: &Study) -> Vec<Table> {
    let mut leaders = Table::new(
        "leaderboard",
        "Leaderboard",
        "Win rate: wins divided by ended episodes, with Wilson's 95 % interval, and with a bootstrap interval over whole games (for \
         games like these; wide with few games). The overall score is the mean of meaningful step ratio, spared steps, normalised \
         reward and win rate; it rewards quick losses too. Optimality: proved fewest ticks divided by steps, over wins. Broken off: \
         episodes aborted by the network, caps or interruptions; they are excluded from all other columns.",
        &[
            "player",
            "episodes",
            "wins",
            "win rate",
            "win rate, games drawn",
            "overall",
            "meaningful",
            "spared steps",
            "normalised reward",
            "steps",
            "efficiency",
            "optimality",
            "time-outs",
            "broken off",
        ],
    );
    let mut answers = Table::new(
        "answers",
        "Answers",
        "Steps by the origin of their action. Tolerant: read from an answer that is not in the required format. Invalid, refused and \
         truncated answers do nothing, and count against the player. Tokens as counted by the provider, including cached answers.",
        &[
            "player",
            "steps",
            "valid",
            "tolerant",
            "invalid",
            "refused",
            "truncated",
            "requests",
            "failed tries",
            "from cache",
            "input tokens",
            "output tokens",
            "reasoning tokens",
            "tokens a step",
        ],
    );
    for LeaderRow { player, scores, by_game, choices, spending, tokens_per_step, .. } in &study.leaderboard {
        let label = TableCell::text(study.players[*player].label());
        leaders.push(vec![
            label.clone(),
            TableCell::Count(scores.episodes),
            TableCell::Count(scores.wins),
            Estimate::cell(scores.win_rate, 2),
            Estimate::cell(*by_game, 2),
            TableCell::number(scores.overall, 3),
            TableCell::number(scores.meaningful, 3),
            TableCell::number(scores.unused_steps, 3),
            TableCell::number(scores.normalised_reward, 3),
            TableCell::number(scores.steps, 1),
            TableCell::number(scores.efficiency, 3),
            TableCell::number(scores.optimality, 3),
            TableCell::Count(scores.timeouts),
            TableCell::Count(scores.excluded),
        ]);
        answers.push(vec![
            label,
            TableCell::Count(choices.total()),
            TableCell::Count(choices.valid),
            TableCell::Count(choices.tolerant),
            TableCell::Count(choices.invalid),
            TableCell::Count(choices.refused),
            TableCell::Count(choices.truncated),
            TableCell::Count(spending.requests),
            TableCell::Count(spending.failures),
            TableCell::Count(spending.cached_replies),
            TableCell::count(spending.input_tokens),
            TableCell::count(spending.output_tokens),
            TableCell::count(spending.reasoning_tokens),
            TableCell::number(*tokens_per_step, 0),
        ]);
    }
    vec![leaders, answers]
}
