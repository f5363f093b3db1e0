//! Summaries of the games of a release.

pub mod rungs;

use forge::Tally;
use forge::card::{Card, Origin};
use report::Quantiles;
use rungs::RungRate;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A summary of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReleaseCard {
    /// The release's canary.
    pub canary: String,
    /// The number of games.
    pub games: u64,
    /// The number of levels of all games.
    pub levels: u64,
    /// The number of games from generators.
    pub new_games: u64,
    /// The requested and the achieved figures: difficulties in levels (a deviation of one is allowed) by the plays that
    /// selected them, quotas in games.
    pub planned: Vec<Bin>,
    /// The number of levels of each difficulty by the ladders of the cards, if it was measured.
    pub difficulty: BTreeMap<String, u64>,
    /// The number of levels of each tier, if it was measured.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tiers: BTreeMap<String, u64>,
    /// The number of games with each goal.
    pub goals: BTreeMap<String, u64>,
    /// The number of games with each avatar.
    pub avatars: BTreeMap<String, u64>,
    /// The number of games from each generator, and from the corpus.
    pub generators: BTreeMap<String, u64>,
    /// The results of the players of the ladder over all games; empty if they did not play.
    pub ladder: Vec<Rung>,
    /// The novelty of the games.
    pub novelty: Novelty,
    /// The number of new games that contain each pattern of mechanics.
    pub patterns: BTreeMap<String, u64>,
    /// The number of rules of a game.
    pub rules: Option<Quantiles>,
    /// The ticks of the witnesses.
    pub witness_ticks: Option<Quantiles>,
    /// The candidates that were tried, and the reasons why some failed.
    pub tally: Tally,
}

/// A player of the ladder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rung {
    /// The win rate.
    pub rate: RungRate,
    /// The detectable difference between the win rates of two releases of this size: at the 5 % level, with 80 %
    /// power.
    pub detectable: Option<f64>,
    /// The same for two releases with `MONTH` games like these.
    pub detectable_month: Option<f64>,
}

/// The number of games of a release of full size.
pub(crate) const MONTH: u64 = 120;

/// The novelty of the games of a release.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Novelty {
    /// The previous releases, the oldest first.
    pub ancestors: Vec<String>,
    /// The number of new games that they hold.
    pub known_games: u64,
    /// The number of canonical items of corpus games that they hold.
    pub known_items: u64,
    /// The distances from each new game to the nearest other one of the release: 0 is the same rules, 1 nothing in
    /// common.
    pub nearest: Option<Quantiles>,
    /// The distances from each new game to the nearest one of the corpus.
    pub nearest_corpus: Option<Quantiles>,
    /// The distances from each new game to the nearest one of the previous releases. The selection ensures that none
    /// is below [`NEAR`](validators::novelty::NEAR), and that no item of a corpus game is repeated.
    pub nearest_known: Option<Quantiles>,
}

impl Rung {
    /// The cells of a Markdown table: the player, the win rate and its interval.
    pub(crate) fn row(&self) -> String {
        let RungRate { player, mean, .. } = &self.rate;
        let held_out = if self.rate.held_out { ", held out" } else { "" };
        let [low, high] = self.rate.interval.map(|bound| 100.0 * bound);
        format!("| `{player}`{held_out} | {:.0} % | {low:.0} to {high:.0} % |", 100.0 * mean)
    }
}

/// The number of times that each name occurs.
pub(crate) fn counted(names: impl Iterator<Item = String>) -> BTreeMap<String, u64> {
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    counts
}

/// The generator of a game's rules, or `corpus`.
pub(crate) fn generator(card: &Card) -> String {
    match &card.origin {
        Origin::Corpus { .. } => "corpus".to_owned(),
        Origin::Generated { generator, .. } => generator.clone(),
    }
}

/// A requested range and the number that was achieved.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bin {
    /// The name of a difficulty, a goal or an avatar.
    pub name: String,
    /// The least number requested.
    pub least: i64,
    /// The greatest number requested.
    pub most: i64,
    /// The number achieved.
    pub there: i64,
}

/// The distance of a number from a range.
pub(crate) fn outside(there: i64, (least, most): (i64, i64)) -> i64 {
    (least - there).max(there - most).max(0)
}

impl Bin {
    /// The distance from the range.
    pub(crate) fn missed(&self) -> i64 {
        outside(self.there, (self.least, self.most))
    }
}

/// Tests whether a game comes from a generator.
pub(crate) fn is_new(card: &Card) -> bool {
    matches!(card.origin, Origin::Generated { .. })
}

impl ReleaseCard {
    /// The card as Markdown, for people: planned and achieved figures, and the results of the ladder.
    pub(crate) fn in_words(&self) -> String {
        let mut text = String::new();
        if !self.planned.is_empty() {
            let _ = writeln!(text, "| planned | at least | at most | achieved |\n|---|---|---|---|");
            for Bin { name, least, most, there } in &self.planned {
                let _ = writeln!(text, "| {} | {least} | {most} | {there} |", name.replace('_', " "));
            }
            text.push('\n');
        }
        if !self.ladder.is_empty() {
            let _ = writeln!(
                text,
                "| player | wins | 95 %, games drawn again | two such releases would show a difference of | two of {MONTH} games |\n\
                 |---|---|---|---|---|"
            );
            let points = |share: f64| format!("{:.0} points", 100.0 * share);
            let seen = |difference: &Option<f64>| difference.map_or("-".to_owned(), points);
            for rung in &self.ladder {
                let (alike, month) = (seen(&rung.detectable), seen(&rung.detectable_month));
                let _ = writeln!(text, "{} {alike} | {month} |", rung.row());
            }
            text.push('\n');
        }
        let Novelty { ancestors, known_games, nearest_known, .. } = &self.novelty;
        if let Some(apart) = nearest_known {
            let _ = writeln!(
                text,
                "From a new game here to the most alike of the {known_games} in the releases before ({}): {:.2} at least, {:.2} in \
                 the median (0 is the same rules, 1 nothing in common).\n",
                ancestors.join(", "),
                apart.min,
                apart.median,
            );
        }
        text.truncate(text.trim_end().len());
        if !text.is_empty() {
            text.push('\n');
        }
        text
    }
}
