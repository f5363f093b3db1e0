//! The results of a study in plain words: who is best, how sure that is, and how each player fails.

use crate::metrics::EpisodeStatus;
use crate::study::leaderboard::LeaderRow;
use crate::study::{OverallComparison, Study};
use engine::Outcome;
use itertools::Itertools;

/// The number of players whose failures are told.
const TOLD: usize = 6;

impl Study {
    /// Returns the results in sentences: the best model (of all players, if there is no model) with its win rate, its comparison
    /// with the next one, and how the episodes of each were lost. Empty if no episode has ended.
    pub fn verdict(&self) -> Vec<String> {
        let tested = |row: &&LeaderRow| !self.players[row.player].is_reference();
        let played = || self.leaderboard.iter().filter(|row| row.scores.episodes > 0);
        let mut rows: Vec<&LeaderRow> = played().filter(tested).collect();
        if rows.is_empty() {
            rows = played().collect();
        }
        let Some(best) = rows.first() else { return Vec::new() };
        let mut said = vec![self.best(best)];
        let next = rows.get(1).copied().or_else(|| played().find(|row| row.player != best.player));
        said.extend(next.and_then(|next| self.against(best, next)));
        said.extend(rows.iter().take(TOLD).filter_map(|row| self.failures_of(row)));
        said
    }

    fn best(&self, row: &LeaderRow) -> String {
        let label = self.players[row.player].label();
        let (wins, episodes) = (row.scores.wins, row.scores.episodes);
        let Some(rate) = row.scores.win_rate else { return format!("{label}: no episode ended.") };
        let [value, low, high] = [rate.value, rate.low, rate.high].map(percent);
        let games = self.on(row.player, None, None).iter().map(|episode| episode.game).unique().count();
        let about = if games > 1 { "in games like these" } else { "on exactly these levels" };
        let first = if self.leaderboard.len() > 1 { "won most" } else { "won" };
        format!("{label} {first}: {value} % ({wins} of {episodes} episodes); {about}, {low} to {high} %.")
    }

    fn against(&self, best: &LeaderRow, next: &LeaderRow) -> Option<String> {
        let is_it = |found: &&OverallComparison| {
            found.players == [best.player, next.player] || found.players == [next.player, best.player]
        };
        let found = self.pairs.overall.iter().find(is_it)?;
        let [ours, theirs] = [best, next].map(|row| self.players[row.player].label());
        let Some((estimate, p)) = found.over_games.zip(found.p) else {
            return Some(format!(
                "One game says nothing about whether {ours} is better than {theirs} in others."
            ));
        };
        let sign = if found.players[0] == best.player { 1.0 } else { -1.0 };
        let mut ends = [sign * estimate.low, sign * estimate.high];
        ends.sort_unstable_by(f64::total_cmp);
        let points = |share: f64| format!("{:+.0}", 100.0 * share).replace('-', "−");
        let [low, high] = ends.map(points);
        let apart = points(sign * estimate.value);
        let numbers = format!("{apart} points, {low} to {high}, p = {p:.3}, {} games", found.games);
        Some(match (p <= 0.05, found.games) {
            (true, _) if sign * estimate.value > 0.0 => {
                format!("It is better than {theirs} in games like these ({numbers}).")
            }
            (true, _) => format!("On the games that both played, {theirs} is better ({numbers})."),
            (false, games) if games < 6 => {
                format!(
                    "Fewer than six games do not tell whether it is better than {theirs} in others ({numbers})."
                )
            }
            _ => format!("That it is better than {theirs} is not proved ({numbers})."),
        })
    }

    /// Tells how the episodes of a player that were not won have ended.
    fn failures_of(&self, row: &LeaderRow) -> Option<String> {
        let ended = self.on(row.player, None, None).iter().filter(|episode| episode.metrics.counts());
        let ends = ended.filter(|episode| !episode.metrics.won()).counts_by(|episode| {
            match (&episode.metrics.status, episode.metrics.outcome) {
                (EpisodeStatus::StepLimit, _) => "reached the limit of steps",
                (_, Outcome::Lost) => "were lost by the rules of the game",
                _ => "ended without a winner",
            }
        });
        let all: usize = ends.values().sum();
        let (label, choices) = (self.players[row.player].label(), &row.choices);
        let how = ends.into_iter().sorted_by_key(|(how, count)| (usize::MAX - count, *how));
        let how = how.map(|(how, count)| format!("{count} {how}")).join(", ");
        let useless = choices.invalid + choices.refused + choices.truncated;
        let share = useless as f64 / choices.total().max(1) as f64;
        let answers = match share >= 0.05 {
            true => format!(" Of its decisions, {} % had no usable answer.", percent(share)),
            false => String::new(),
        };
        (all > 0).then(|| format!("Of {all} episodes that {label} did not win, {how}.{answers}"))
    }
}

fn percent(share: f64) -> String {
    format!("{:.0}", 100.0 * share)
}
