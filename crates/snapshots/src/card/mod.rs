//! Summaries of the games in a release.

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
    /// The release's canary: an identifier that shows whether a text corpus contains the release.
    pub canary: String,
    /// The number of games.
    pub games: u64,
    /// The number of levels in all games.
    pub levels: u64,
    /// The number of games from generators.
    pub new_games: u64,
    /// The requested and achieved counts. For difficulties, the counts are levels as measured during selection, and
    /// may be off by one. For quotas, the counts are games.
    pub planned: Vec<Bin>,
    /// The number of levels of each difficulty, as measured by the reference players on the games' cards; empty if
    /// difficulty was not measured.
    pub difficulty: BTreeMap<String, u64>,
    /// The number of levels of each tier, if tiers were measured.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tiers: BTreeMap<String, u64>,
    /// The number of games with each goal.
    pub goals: BTreeMap<String, u64>,
    /// The number of games with each avatar.
    pub avatars: BTreeMap<String, u64>,
    /// The number of games per origin, which is the name of a generator or `corpus`.
    pub generators: BTreeMap<String, u64>,
    /// The results of the ladder, which is a list of reference players of increasing strength, across all games. Empty
    /// if no ladder was played.
    pub ladder: Vec<Rung>,
    /// The novelty of the games.
    pub novelty: Novelty,
    /// The number of new games with each mechanics pattern.
    pub patterns: BTreeMap<String, u64>,
    /// The number of rules per game.
    pub rules: Option<Quantiles>,
    /// The number of ticks per witness.
    pub witness_ticks: Option<Quantiles>,
    /// The number of candidates tried, and the rejections by reason.
    pub tally: Tally,
}

/// The results of one reference player on the ladder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rung {
    /// The player's win rate.
    pub rate: RungRate,
    /// The smallest difference in win rate that can be detected between two releases of this size, at the 5% level
    /// with 80% power.
    pub detectable: Option<f64>,
    /// The smallest difference in win rate that can be detected between two releases with a month's usual number of
    /// games each (`MONTH`).
    pub detectable_month: Option<f64>,
}

/// The number of games in a full-size release.
pub(crate) const MONTH: u64 = 120;

/// The novelty of a release's games.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Novelty {
    /// The names of the previous releases, oldest first.
    pub ancestors: Vec<String>,
    /// The number of new games in all previous releases.
    pub known_games: u64,
    /// The number of canonical items (rules and level) in the corpus games of the previous releases.
    pub known_items: u64,
    /// The distance from each new game to its nearest neighbour in the release, from 0 (the same rules) to 1
    /// (nothing in common).
    pub nearest: Option<Quantiles>,
    /// The distance from each new game to the nearest corpus game.
    pub nearest_corpus: Option<Quantiles>,
    /// The distance from each new game to the nearest game in the previous releases. Selection ensures that
    /// no such distance is below [`NEAR`](validators::novelty::NEAR), and that no corpus item is repeated.
    pub nearest_known: Option<Quantiles>,
}

impl Rung {
    /// Formats the player, the win rate and its interval as a Markdown table row.
    pub(crate) fn row(&self) -> String {
        let RungRate { player, mean, .. } = &self.rate;
        let held_out = if self.rate.held_out { ", held out" } else { "" };
        let [low, high] = self.rate.interval.map(|bound| 100.0 * bound);
        format!("| `{player}`{held_out} | {:.0} % | {low:.0} to {high:.0} % |", 100.0 * mean)
    }
}

/// Counts the occurrences of each name.
pub(crate) fn counted(names: impl Iterator<Item = String>) -> BTreeMap<String, u64> {
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    counts
}

/// Returns the name of the generator that made a game's rules, or `corpus` for a corpus game.
pub(crate) fn generator(card: &Card) -> String {
    match &card.origin {
        Origin::Corpus { .. } => "corpus".to_owned(),
        Origin::Generated { generator, .. } => generator.clone(),
    }
}

/// A requested range of counts, and the achieved count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bin {
    /// The name of a difficulty, a goal or an avatar.
    pub name: String,
    /// The smallest count requested.
    pub least: i64,
    /// The largest count requested.
    pub most: i64,
    /// The achieved count.
    pub there: i64,
}

/// Returns how far a number lies outside a range.
pub(crate) fn outside(there: i64, (least, most): (i64, i64)) -> i64 {
    (least - there).max(there - most).max(0)
}

impl Bin {
    /// Returns how far the achieved number lies outside the requested range.
    pub(crate) fn missed(&self) -> i64 {
        outside(self.there, (self.least, self.most))
    }
}

/// Returns `true` if a game was made by a generator.
pub(crate) fn is_new(card: &Card) -> bool {
    matches!(card.origin, Origin::Generated { .. })
}

impl ReleaseCard {
    /// Formats the card as Markdown for human readers, with planned and achieved numbers and the results of the
    /// reference players.
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
