//! Reference results as Markdown, for the README of an open release.

use super::{Fall, MarkRate, Marks};
use itertools::Itertools;
use std::fmt::{Display, Write};

impl Marks {
    /// Formats the win rates by tier (difficulty class) and commitment (number of actions per decision), and their
    /// decreases.
    pub(crate) fn in_words(&self) -> String {
        let mut text = format!(
            "## Marks\n\nPlayers that never change, with {} plays of each commitment on each level, of at most {} actions; planners in \
             open loop. Win rates in percent, with 95 % intervals for games like these.\n\n",
            self.asked.plays, self.asked.max_steps
        );
        let tiers: Vec<_> = self.rates.iter().map(|rate| rate.tier).dedup().collect();
        let _ = write!(text, "| player | actions a look |");
        for tier in &tiers {
            let levels = self.rates.iter().find(|rate| rate.tier == *tier).map_or(0, |rate| rate.levels);
            let name = tier.map_or("all".to_owned(), |tier| format!("tier {tier}"));
            let _ = write!(text, " {name}, {levels} levels |");
        }
        let _ = writeln!(text, "\n|---|---|{}", "---|".repeat(tiers.len()));
        for player in &self.asked.players {
            for &commit in &self.asked.commits {
                let _ = write!(text, "| `{player}` | {} |", commit.name());
                let of = |rate: &&MarkRate| rate.player == *player && rate.commit == commit;
                for MarkRate { rate, .. } in self.rates.iter().filter(of) {
                    let [low, high] = rate.interval.map(percent);
                    let _ = write!(text, " {} ({low} to {high}) |", percent(rate.mean));
                }
                text.push('\n');
            }
        }
        falls(&mut text, "tier", self.falls.tiers.iter(), |tier| tier.to_string());
        falls(&mut text, "number of actions a look", self.falls.commits.iter(), |commit| {
            commit.name().to_owned()
        });
        text
    }
}

fn falls<'a, T: Copy + 'a>(
    text: &mut String,
    what: &str,
    falls: impl Iterator<Item = &'a Fall<T>>,
    name: impl Fn(T) -> String,
) {
    let mut falls = falls.peekable();
    if falls.peek().is_none() {
        return;
    }
    let _ = writeln!(
        text,
        "\nSteps from each {what} to the next, paired over the games that have both:\n\n\
         | player | step | games | win rates | fall in points |\n|---|---|---|---|---|"
    );
    for Fall { player, from, to, games, rates, fall, interval } in falls {
        let player: &dyn Display = player.as_ref().map_or(&"mean of all", |player| player);
        let ([from_rate, to_rate], [low, high]) = (rates.map(percent), interval.map(percent));
        let (fall, from, to) = (percent(*fall), name(*from), name(*to));
        let _ = writeln!(
            text,
            "| {player} | {from} to {to} | {games} | {from_rate} to {to_rate} | {fall} ({low} to {high}) |"
        );
    }
}

/// Formats a fraction in whole percent, without a minus sign for zero.
fn percent(share: f64) -> String {
    let text = format!("{:.0}", 100.0 * share);
    if text == "-0" { "0".to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::super::tests::marks;
    use super::percent;
    use validators::Tier;

    #[test]
    fn every_rate_and_fall_is_told() {
        let ids = ["a", "b", "c", "d", "e", "f"];
        let marks = marks(&ids, |_, tier| vec![vec![u64::from(tier == Tier::One), 0], vec![2, 2]]);
        let words = marks.in_words();
        for line in [
            "| player | actions a look | tier 1, 6 levels | tier 4, 6 levels | all, 12 levels |",
            "| `random` | 1 | 50 (14 to 86) | 0 (0 to 52) | 25 (4 to 72) |",
            "| mean of all | 1 to 4 | 6 | 62 to 50 | 12 (-43 to 59) |",
            "| random | 1 to all | 6 | 25 to 0 | 25 (-31 to 72) |",
        ] {
            assert!(words.contains(line), "{line}\n{words}");
        }
        assert_eq!([percent(-0.001), percent(-0.02), percent(0.5)], ["0", "-2", "50"]);
    }
}
