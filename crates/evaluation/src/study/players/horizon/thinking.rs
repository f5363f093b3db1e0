//! Players' thinking horizons. A player's thinking horizon is the budget of output tokens per answer at which the player
//! wins half of its episodes.

use super::{Effect, Horizon, by_player, by_setting};
use crate::study::episodes::scores::Estimate;
use crate::study::{Player, Study, StudyEpisode};
use crate::thought::is_budget_aid;
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;

/// A player's thinking horizon: the number of output tokens per answer at which the player wins half of its episodes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThinkingRow {
    /// The player, without its budget (its maximum number of output tokens per answer).
    pub player: Player,
    /// The tier (difficulty class) of the levels, or `None` for all levels.
    pub tier: Option<u8>,
    /// The win rates, sorted by ascending budget (maximum number of output tokens per answer).
    pub rates: Vec<BudgetRate>,
    /// The thinking horizon, in output tokens per answer. The lowest value that can be reported is a quarter of the
    /// smallest budget, and the highest is four times the largest budget.
    #[serde(flatten)]
    pub horizon: Horizon,
}

/// A player's win rate with one budget (maximum number of output tokens per answer).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BudgetRate {
    /// The maximum number of output tokens per answer.
    pub budget: u32,
    /// The win rate with its interval.
    pub rate: Option<Estimate>,
    /// The number of ended episodes.
    pub episodes: u64,
    /// The number of output tokens in all episodes, divided by the number of wins. If the token count of an answer is
    /// unknown, its words are counted instead. `None` if there are no wins, or if a program did not report its
    /// reasoning in some episode.
    pub tokens_per_win: Option<f64>,
    /// The price of all episodes in US dollars, divided by the number of wins. `None` without a win, or if the price is
    /// unknown.
    pub cost_per_win: Option<f64>,
}

impl ThinkingRow {
    /// Returns the player's label and the tier (difficulty class) of the levels, if the row is for one tier.
    pub fn title(&self) -> String {
        match self.tier {
            Some(tier) => format!("{}, tier {tier}", self.player.label()),
            None => self.player.label(),
        }
    }
}

impl BudgetRate {
    fn of(budget: u32, episodes: &[&StudyEpisode]) -> BudgetRate {
        let wins = episodes.iter().filter(|episode| episode.metrics.won()).count();
        let per_win = |amount: fn(&StudyEpisode) -> Option<f64>| {
            let sum: Option<f64> = episodes.iter().map(|episode| amount(episode)).sum();
            sum.filter(|_| wins > 0).map(|sum| sum / wins as f64)
        };
        BudgetRate {
            budget,
            rate: Estimate::rate(episodes),
            episodes: episodes.len() as u64,
            tokens_per_win: per_win(|episode| episode.metrics.thought.map(|tokens| tokens as f64)),
            cost_per_win: per_win(|episode| episode.metrics.cost),
        }
    }
}

/// Returns the rows of players with results for several budgets: one row per tier of the levels, and one row for all
/// levels if they have several tiers. Rows are sorted by tier, and then by ascending thinking horizon.
pub(in crate::study) fn rows(study: &Study) -> Vec<ThinkingRow> {
    let tier_of = |episode: &StudyEpisode| {
        let marks = &study.games[episode.game].marks;
        marks.iter().find(|mark| mark.level == episode.metrics.level).map(|mark| mark.tier)
    };
    let mut rows = Vec::new();
    for (player, episodes) in by_player(study, |aid, _| is_budget_aid(aid)) {
        let limited = episodes.into_iter().filter(|episode| episode.metrics.max_output_tokens.is_some());
        let limited: Vec<&StudyEpisode> = limited.collect();
        let tiers = by_setting(&limited, tier_of);
        let all = (tiers.len() > 1).then(|| (None, limited.clone()));
        let known =
            tiers.into_iter().filter(|(tier, episodes)| tier.is_some() || episodes.len() == limited.len());
        for (tier, episodes) in known.chain(all) {
            let budgets =
                by_setting(&episodes, |episode| episode.metrics.max_output_tokens.unwrap_or(u32::MAX));
            if budgets.len() < 2 {
                continue;
            }
            let rates = budgets.iter().map(|(budget, episodes)| BudgetRate::of(*budget, episodes)).collect();
            let name = format!("thinking horizon {} {tier:?}", player.label());
            let horizon = Horizon::of(&name, &episodes, Effect::Helps, |episode| {
                f64::from(episode.metrics.max_output_tokens.unwrap_or(u32::MAX))
            });
            rows.push(ThinkingRow { player: player.clone(), tier, rates, horizon });
        }
    }
    rows.sort_by(|a, b| {
        let tier = |row: &ThinkingRow| row.tier.unwrap_or(u8::MAX);
        let needs = |row: &ThinkingRow| row.horizon.horizon.map_or(f64::INFINITY, |horizon| horizon.value);
        tier(a).cmp(&tier(b)).then(needs(a).total_cmp(&needs(b)))
    });
    rows
}

/// Returns the table of thinking horizons, or `None` if no player has results for several budgets.
pub(in crate::study) fn table(study: &Study) -> Option<Table> {
    if study.thinking.is_empty() {
        return None;
    }
    let each = |row: &ThinkingRow, value: &dyn Fn(&BudgetRate) -> Option<String>| {
        let one =
            |found: &BudgetRate| format!("{}: {}", found.budget, value(found).unwrap_or("–".to_owned()));
        TableCell::text(row.rates.iter().map(one).join(", "))
    };
    let table = Table::of(
        "thinking",
        "How much players must think",
        "Horizon: the maximum number of output tokens per answer, including reasoning, at which a player wins half of its \
         episodes on an average level, with a 95% interval over games (logistic in the logarithm of the tokens, with level \
         effects). No value is given below a quarter of the smallest budget or beyond four times the largest budget: ≤ \
         and ≥ mark these bounds. Tokens per win: output tokens of all episodes, divided by wins. Words count if a player \
         reports no tokens. USD per win: the same with list prices of prompts and answers.",
        &study.thinking,
        &[
            ("player", &|row| TableCell::text(row.player.label())),
            ("tier", &|row| row.tier.map_or(TableCell::text("all"), |tier| TableCell::Count(tier.into()))),
            ("horizon", &|row| TableCell::figure(row.horizon.horizon.map(|_| row.horizon.told_value()))),
            ("interval", &|row| TableCell::figure(row.horizon.horizon.map(|_| row.horizon.told_interval()))),
            ("won by budget", &|row| {
                each(row, &|found| found.rate.map(|rate| format!("{:.0}%", 100.0 * rate.value)))
            }),
            ("tokens per win", &|row| each(row, &|found| Some(format!("{:.0}", found.tokens_per_win?)))),
            ("USD per win", &|row| each(row, &|found| Some(format!("{:.4}", found.cost_per_win?)))),
            ("episodes", &|row| TableCell::Count(row.rates.iter().map(|rate| rate.episodes).sum())),
        ],
    );
    Some(table)
}
