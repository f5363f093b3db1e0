//! Summarises a study in plain words: the best player, the certainty of the result, the kinds of game won,
//! and each player's failures.

use crate::metrics::{EndingKind, GoalDistance};
use crate::study::episodes::endings::nearest;
use crate::study::players::leaderboard::LeaderRow;
use crate::study::{OverallComparison, Study, TaxonomyRow};
use itertools::Itertools;
use std::cmp::Reverse;

/// The maximum number of players whose failures are described.
const TOLD: usize = 6;
/// The maximum number of game kinds listed as won most often, and also as won least often.
const KINDS: usize = 3;

impl Study {
    /// Summarises the results in plain words. Returns an empty list if no episode has ended.
    ///
    /// The first paragraph is about the best model, or the best player if there is no model. It states the
    /// player's win rate, compares the player with the next best, and lists the kinds of game that the player
    /// wins. Each further paragraph describes how one player failed.
    pub fn verdict(&self) -> Vec<String> {
        let tested = |row: &&LeaderRow| !self.players[row.player].is_reference();
        let played = || self.leaderboard.iter().filter(|row| row.scores.episodes > 0);
        let mut rows: Vec<&LeaderRow> = played().filter(tested).collect();
        let has_models = !rows.is_empty();
        let Some(best) = rows.first().copied().or_else(|| played().next()) else { return Vec::new() };
        if !has_models {
            rows = played().collect();
        }
        let next = rows.get(1).copied().or_else(|| played().find(|row| row.player != best.player));
        let mut lead = vec![self.best(best)];
        lead.extend(self.best_baseline(best));
        lead.extend(next.and_then(|next| self.against(best, next)));
        lead.extend(self.kinds_of(best));
        let told = rows.iter().take(TOLD).filter_map(|row| self.failures_of(row));
        std::iter::once(lead.join(" ")).chain(told).collect()
    }

    fn best(&self, row: &LeaderRow) -> String {
        let label = self.players[row.player].label();
        let (wins, episodes) = (row.scores.wins, row.scores.episodes);
        let Some(rate) = row.scores.win_rate else { return format!("{label}: no episode ended.") };
        let [value, low, high] = [rate.value, rate.low, rate.high].map(percent);
        let games = self.on(row.player, None, None).iter().map(|episode| episode.game).unique().count();
        let about = if games > 1 { "in games like these" } else { "on exactly these levels" };
        let others = |models: bool| {
            let is_other = move |other: &&LeaderRow| {
                other.player != row.player && !(models && self.players[other.player].is_reference())
            };
            self.leaderboard.iter().filter(is_other)
        };
        // A higher win rate may come from easier levels, so the other player may be ahead on the levels
        // played by both.
        let is_ahead = |other: &LeaderRow| {
            let found =
                self.comparison(row, other).and_then(|(sign, found)| Some(sign * found.over_games?.value));
            found.is_some_and(|gap| gap < 0.0)
        };
        let is_first = |other: &LeaderRow| {
            other.scores.win_rate.is_none_or(|other| other.value < rate.value) && !is_ahead(other)
        };
        let won = match wins {
            0 => "won no episode",
            _ if others(false).count() > 0 && others(false).all(is_first) => "won the most",
            _ if others(true).count() > 0 && others(true).all(is_first) => {
                "won the most, not counting baselines"
            }
            _ => "won",
        };
        format!("{label} {won}: {value}% ({wins} of {episodes} episodes); {about}, {low} to {high}%.")
    }

    /// Names the baseline that won the most, if its win rate is higher than that of the best model.
    fn best_baseline(&self, best: &LeaderRow) -> Option<String> {
        let rate = |row: &LeaderRow| row.scores.win_rate.map(|rate| rate.value);
        let own = rate(best)?;
        let others = self.leaderboard.iter().filter(|row| row.player != best.player);
        let first =
            others.max_by(|one, other| rate(one).unwrap_or(0.0).total_cmp(&rate(other).unwrap_or(0.0)))?;
        let value = rate(first).filter(|value| *value > own && self.players[first.player].is_reference())?;
        let label = self.players[first.player].label();
        let (wins, episodes) = (first.scores.wins, first.scores.episodes);
        Some(format!(
            "The baseline {label} won the most: {}% ({wins} of {episodes} episodes).",
            percent(value)
        ))
    }

    /// Returns the comparison of two players and a sign. Multiplied by the sign, the differences are the
    /// first player's values minus the second player's.
    fn comparison(&self, one: &LeaderRow, other: &LeaderRow) -> Option<(f64, &OverallComparison)> {
        let all = [&self.pairs, &self.modes, &self.aids].into_iter().flat_map(|contrasts| &contrasts.overall);
        all.filter_map(|found| match found.players {
            players if players == [one.player, other.player] => Some((1.0, found)),
            players if players == [other.player, one.player] => Some((-1.0, found)),
            _ => None,
        })
        .next()
    }

    fn against(&self, best: &LeaderRow, next: &LeaderRow) -> Option<String> {
        let (sign, found) = self.comparison(best, next)?;
        let [ours, theirs] = [best, next].map(|row| self.players[row.player].label());
        let Some((estimate, p)) = found.over_games.zip(found.p) else {
            return Some(format!(
                "A single game does not show whether {ours} is better than {theirs} in other games."
            ));
        };
        let mut ends = [sign * estimate.low, sign * estimate.high];
        ends.sort_unstable_by(f64::total_cmp);
        let points = |share: f64| match (100.0 * share).round() {
            0.0 => "0".to_owned(),
            points => format!("{points:+}").replace('-', "−"),
        };
        let [low, high] = ends.map(points);
        let apart = points(sign * estimate.value);
        let p_value = if p < 0.0005 { "p < 0.001".to_owned() } else { format!("p = {p:.3}") };
        let numbers = format!("{apart} points, {low} to {high}, {p_value}, {} games", found.games);
        Some(match (p <= 0.05, found.games) {
            (true, _) if sign * estimate.value > 0.0 => {
                format!("This player is better than {theirs} in games like these ({numbers}).")
            }
            (true, _) => format!("On the games that both played, {theirs} is better ({numbers})."),
            (false, games) if games < 6 => {
                format!(
                    "Fewer than six games cannot show whether this player is better than {theirs} in \
                     other games ({numbers})."
                )
            }
            _ if sign * estimate.value < 0.0 => format!(
                "On the levels that both played, {theirs} won more, but is not shown to be better in \
                 games like these ({numbers})."
            ),
            _ => format!("This player is not shown to be better than {theirs} ({numbers})."),
        })
    }

    /// Describes the kinds of game that a player won most often and least often. Returns `None` if its
    /// results cover fewer than two kinds.
    fn kinds_of(&self, row: &LeaderRow) -> Option<String> {
        let of_player =
            self.kinds.iter().filter(|kind| kind.player == row.player && kind.scores.episodes > 0);
        let rate = |kind: &&TaxonomyRow| kind.scores.wins as f64 / kind.scores.episodes as f64;
        let sorted = of_player
            .sorted_by(|one, other| {
                let more = other.scores.episodes.cmp(&one.scores.episodes);
                rate(other).total_cmp(&rate(one)).then(more)
            })
            .collect_vec();
        let (first, last) = (sorted.first()?, sorted.last()?);
        if rate(first) == rate(last) {
            return None;
        }
        let count = (sorted.len() / 2).min(KINDS);
        let told = |kind: &&TaxonomyRow| {
            let (wins, episodes) = (kind.scores.wins, kind.scores.episodes);
            format!("{} ({wins} of {episodes})", kind.kind)
        };
        let most = sorted.iter().take(count).map(told).join(", ");
        let least = sorted.iter().rev().take(count).map(told).join(", ");
        Some(format!("By kind of game, the player won most in {most} and least in {least}."))
    }

    /// Describes how a player's episodes without a win ended.
    fn failures_of(&self, row: &LeaderRow) -> Option<String> {
        let summary = self.ending_summaries.iter().find(|summary| summary.player == row.player)?;
        let causes = || summary.causes.iter().map(|&at| &self.endings[at]);
        let kinds = summary.kinds.iter().sorted_by_key(|(kind, count)| (Reverse(**count), **kind));
        let told = |(kind, count): (&EndingKind, &u64)| {
            let how = match kind {
                EndingKind::Died => "died",
                EndingKind::Lost => "lost a sprite that the game needs",
                EndingKind::Appeared => "ended when a losing sprite appeared",
                EndingKind::OutOfTime => "ran out of time",
                EndingKind::Otherwise => "were lost by the rules of the game",
                EndingKind::StepLimit => "reached the limit of steps",
                EndingKind::NoWinner => "ended without a winner",
                EndingKind::Stopped => "were stopped by the engine, which says nothing about the player",
            };
            let most = causes().filter(|row| row.kind == *kind).find_map(|row| {
                let times =
                    if row.episodes == 1 { "once".to_owned() } else { format!("{} times", row.episodes) };
                let particulars = row.particulars.as_ref()?;
                Some(format!(" (most often {particulars} in {}, {times})", self.title(row.game)))
            });
            format!("{count} {how}{}", most.unwrap_or_default())
        };
        let how = kinds.map(told).join(", ");
        let near =
            nearest(causes().filter_map(|row| row.nearest.as_ref())).filter(|near| near.left < near.of);
        let near = near.map_or(String::new(), |near| {
            let GoalDistance { counted, left, of } = near;
            format!(" Closest to a win: {left} of {of} ({counted}) remaining.")
        });
        let (label, choices) = (self.players[row.player].label(), &row.choices);
        let useless = choices.invalid + choices.refused + choices.truncated;
        let share = useless as f64 / choices.total().max(1) as f64;
        let answers = match share >= 0.05 {
            true => format!(" {}% of the decisions had no usable answer.", percent(share)),
            false => String::new(),
        };
        let (missed, all) = (summary.episodes, row.scores.episodes);
        Some(format!("{label} did not win {missed} of {all} episodes: {how}.{near}{answers}"))
    }
}

fn percent(share: f64) -> String {
    format!("{:.0}", 100.0 * share)
}
