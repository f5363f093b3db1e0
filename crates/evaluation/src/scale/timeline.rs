//! A timeline of the months on a scale, with the players' abilities and each month's difficulty.

use super::file::{Estimate, ScaleFile, Span};
use super::person::{MonthAbility, PersonAbility, Refusal, of_person};
use super::played::PersonPlays;
use base::Digest;
use itertools::Itertools;
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{Z95, benjamini_hochberg, chi_squared_p};
use std::collections::BTreeSet;

/// A scale's months, with players' abilities.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Timeline {
    /// The maximum number of actions per episode.
    pub max_steps: u64,
    /// The correlation between the difficulties for planners and for readers (players that see only prompts).
    pub correlation: Option<Span>,
    /// The months of the scale, in chronological order.
    pub months: Vec<TimelineMonth>,
    /// The timeline's players. Those that were not used to calibrate the scale come first. Within each of the
    /// two groups, players are sorted by descending mean ability.
    pub players: Vec<TimelinePlayer>,
}

/// A month in a timeline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimelineMonth {
    /// The month's name.
    pub name: String,
    /// The root digest of the month, if it is a snapshot.
    pub snapshot: Option<Digest>,
    /// The number of games in the month.
    pub games: u64,
    /// The number of levels in the month.
    pub levels: u64,
    /// The mean difficulty relative to the first month, for arbitrary planners and for arbitrary readers (players that
    /// see only prompts).
    pub shifts: [Estimate; 2],
    /// The mean difficulty relative to the first month, for exactly the planners of the scale.
    pub planners_shift: Estimate,
    /// The standard deviations of the level difficulties, for planners and for readers (players that see only prompts).
    pub spreads: [f64; 2],
    /// The mean misfit of the month's games, which is about 1 if the episodes fit the model.
    pub misfit: f64,
    /// The number of anchors that played the month. Anchors are players that see only prompts and never change.
    pub anchors: u64,
    /// The month's additional difficulty for the anchors (unchanging players that see only prompts), beyond that
    /// implied by its difficulty for planners.
    pub drift: Option<Estimate>,
    /// `true` if the drift's 95% interval excludes 0.
    pub is_drift_flagged: bool,
}

/// A player in a timeline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimelinePlayer {
    /// The player's abilities.
    #[serde(flatten)]
    pub ability: PersonAbility,
    /// `true` if the player was used to calibrate the scale, in which case its abilities are not independent
    /// evidence.
    pub is_examinee: bool,
    /// The versions of the suite that evaluated the player, in the order of the ability's `months`.
    pub suites: Vec<BTreeSet<String>>,
    /// The evidence for a change in ability. `None` if there are fewer than two months in which the player
    /// both won and lost episodes.
    pub change: Option<Change>,
}

/// The evidence for a change in a player's ability over the months.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The number of months in which the player both won and lost episodes. In other months, the ability's
    /// interval has only one end.
    pub months: u64,
    /// The mean ability, weighted by the inverse squares of the standard errors.
    pub mean: Estimate,
    /// The ability in the last month minus the ability in the first month. Only months in which the player
    /// both won and lost are considered.
    pub from_first_to_last: Span,
    /// The sum of the squared deviations from the mean, each divided by the ability's squared standard error.
    pub chi_squared: f64,
    /// The probability of a sum at least as large if the ability never changed.
    pub p: f64,
    /// The p-value adjusted for the number of players by the Benjamini–Hochberg method.
    pub q: f64,
}

impl Timeline {
    /// Computes the players' abilities on a scale's months. Cost: one ability estimate per player and month.
    pub fn of(scale: &ScaleFile, persons: &[PersonPlays]) -> Timeline {
        let mut players = persons.iter().map(|person| TimelinePlayer::of(scale, person)).collect_vec();
        let tested = (0..players.len()).filter(|&at| players[at].change.is_some()).collect_vec();
        let p = |at: &usize| players[*at].change.as_ref().map_or(1.0, |change| change.p);
        let adjusted = benjamini_hochberg(&tested.iter().map(p).collect_vec());
        for (&at, q) in tested.iter().zip(adjusted) {
            players[at].change.iter_mut().for_each(|change| change.q = q);
        }
        players.sort_by(|one, other| {
            let able = other.level().total_cmp(&one.level());
            one.is_examinee
                .cmp(&other.is_examinee)
                .then(able)
                .then(one.ability.player.cmp(&other.ability.player))
        });
        let month = |month: &super::MonthEntry| {
            let levels = || month.games.iter().flat_map(|game| &game.levels);
            let spread = |side: usize| {
                let all = levels().map(|level| level.difficulty[side].value).collect_vec();
                let count = all.len().max(1) as f64;
                let mean = all.iter().sum::<f64>() / count;
                (all.iter().map(|one| (one - mean) * (one - mean)).sum::<f64>() / count).sqrt()
            };
            let misfit = month.games.iter().map(|game| game.misfit).sum::<f64>();
            TimelineMonth {
                name: month.name.clone(),
                snapshot: month.snapshot,
                games: month.games.len() as u64,
                levels: levels().count() as u64,
                shifts: month.shifts,
                planners_shift: month.planners_shift,
                spreads: [0, 1].map(spread),
                misfit: misfit / month.games.len().max(1) as f64,
                anchors: month.anchors,
                drift: month.drift,
                is_drift_flagged: month.drift.is_some_and(|drift| drift.value.abs() > Z95 * drift.error),
            }
        };
        Timeline {
            max_steps: scale.max_steps,
            correlation: scale.correlation,
            months: scale.months.iter().map(month).collect(),
            players,
        }
    }

    /// Returns the players whose ability changed, and the number of players tested. A change is significant
    /// if its adjusted p-value is at most 5%.
    pub fn changed(&self) -> (Vec<&TimelinePlayer>, usize) {
        let tested = self.players.iter().filter(|player| player.change.is_some()).collect_vec();
        let count = tested.len();
        (
            tested
                .into_iter()
                .filter(|player| player.change.as_ref().is_some_and(|one| one.q < 0.05))
                .collect(),
            count,
        )
    }

    /// Returns all numbers as tables: the abilities, the changes, the months, and the underlying results.
    pub fn tables(&self) -> Vec<Table> {
        vec![self.abilities(), self.changes(), self.difficulties(), self.plays()]
    }

    fn abilities(&self) -> Table {
        let note = "Logits above the mean difficulty of the first month. Error² = sampling² + mismatch² + \
                    link². An interval has only one end if there is no win, or no loss.";
        let columns = [
            "player", "month", "ability", "error", "sampling", "mismatch", "link", "bounds", "won",
            "episodes", "games",
        ];
        let mut table = Table::new("abilities", "Ability by month", note, &columns);
        for (player, month) in
            self.players.iter().flat_map(|one| one.ability.months.iter().map(move |month| (one, month)))
        {
            let ability = month.ability.map_or(TableCell::Missing, |Span { value, low, high }| {
                TableCell::Interval { value, low, high, digits: 2 }
            });
            let error = month
                .error
                .map_or([None; 4], |one| [one.total, one.sampling, one.mismatch, one.link].map(Some));
            let bounds = match (&month.refusal, month.ability, month.is_bounded) {
                (Some(Refusal::FewAnchors { .. }), ..) => "not placed: too few anchors",
                (None, None, _) => "not placed",
                (None, Some(_), [true, true]) => "both",
                (None, Some(_), [false, _]) => "upper only: no win",
                (None, Some(_), [_, false]) => "lower only: no loss",
            };
            let mut row =
                vec![TableCell::text(&*player.ability.player), TableCell::text(&*month.month), ability];
            row.extend(error.map(|part| part.map_or(TableCell::Missing, |part| TableCell::number(part, 2))));
            row.push(TableCell::text(bounds));
            row.extend([month.won, month.episodes, month.games].map(TableCell::Count));
            table.push(row);
        }
        table
    }

    fn changes(&self) -> Table {
        let note = "χ²: the statistic for the deviations of the abilities from their mean, with one degree of freedom \
                    fewer than there are months. p: the probability of at least this value if the ability \
                    never changed. q: p adjusted for the number of players. Months without a win or \
                    without a loss are excluded.";
        let columns = ["player", "part", "months", "mean ability", "last − first", "χ²", "p", "q"];
        let mut table = Table::new("changes", "Change over the months", note, &columns);
        for player in &self.players {
            let part = if player.is_examinee { "calibrates the scale" } else { "placed on the scale" };
            let mut row = vec![TableCell::text(&*player.ability.player), TableCell::text(part)];
            if let Some(change) = &player.change {
                let Span { value, low, high } = change.from_first_to_last;
                let (mean, half) = (change.mean.value, Z95 * change.mean.error);
                row.push(TableCell::Count(change.months));
                row.push(TableCell::Interval { value: mean, low: mean - half, high: mean + half, digits: 2 });
                row.push(TableCell::Interval { value, low, high, digits: 2 });
                row.extend([
                    TableCell::number(change.chi_squared, 1),
                    TableCell::Probability(change.p),
                    TableCell::Probability(change.q),
                ]);
            }
            table.push(row);
        }
        table
    }

    fn difficulties(&self) -> Table {
        let note = "Mean difficulty relative to the first month, in logits, with 95% intervals: for exactly the planners of the scale, for any planner, and for any reader. Drift: how much more difficult the month is for the anchors than the planners' results predict. SD: standard deviation \
                    of the difficulties of its levels. Misfit: about 1 if the episodes fit the model.";
        let columns = [
            "month",
            "games",
            "levels",
            "these planners",
            "any planner",
            "any reader",
            "SD, planners",
            "SD, readers",
            "misfit",
            "anchors",
            "drift",
            "flagged",
            "root",
        ];
        let mut table = Table::new("months", "The months", note, &columns);
        let interval = |one: Estimate| {
            let half = Z95 * one.error;
            TableCell::Interval { value: one.value, low: one.value - half, high: one.value + half, digits: 2 }
        };
        for month in &self.months {
            let mut row = vec![
                TableCell::text(&*month.name),
                TableCell::Count(month.games),
                TableCell::Count(month.levels),
            ];
            row.extend([month.planners_shift, month.shifts[0], month.shifts[1]].map(interval));
            row.extend(month.spreads.map(|sd| TableCell::number(sd, 2)));
            row.extend([TableCell::number(month.misfit, 2), TableCell::Count(month.anchors)]);
            row.push(month.drift.map_or(TableCell::Missing, interval));
            row.push(TableCell::text(if month.is_drift_flagged { "yes" } else { "no" }));
            row.push(month.snapshot.map_or(TableCell::Missing, |root| {
                TableCell::text(root.to_string().chars().take(12).collect::<String>())
            }));
            table.push(row);
        }
        table
    }

    /// Returns a table of results by player and month, with the number of wins and the number of distinct
    /// episodes.
    fn plays(&self) -> Table {
        let note = "Wins and distinct episodes on the levels of the scale. A dash: the player did not play. Suite: \
                    the versions of arcade used for the evaluations.";
        let months = self.months.iter().map(|month| month.name.as_str());
        let columns = ["player"].into_iter().chain(months).chain(["suite"]).collect_vec();
        let mut table = Table::new("played", "Who played which month", note, &columns);
        for player in &self.players {
            let on = |month: &TimelineMonth| {
                let found = player.ability.months.iter().find(|one| one.month == month.name);
                found.map_or(TableCell::Missing, |one| {
                    TableCell::Figure(format!("{} of {}", one.won, one.episodes))
                })
            };
            let suites = player.suites.iter().flatten().unique().sorted().join(", ");
            let mut row = vec![TableCell::text(&*player.ability.player)];
            row.extend(self.months.iter().map(on));
            row.push(TableCell::text(suites));
            table.push(row);
        }
        table
    }
}

impl TimelinePlayer {
    fn of(scale: &ScaleFile, person: &PersonPlays) -> TimelinePlayer {
        let ability = of_person(scale, person);
        let suites = ability.months.iter().map(|month| {
            let games =
                scale.months.iter().filter(|entry| entry.name == month.month).flat_map(|entry| &entry.games);
            games.filter_map(|game| person.suites.get(&game.digest)).flatten().cloned().collect()
        });
        let suites = suites.collect();
        let change = Change::of(&ability.months);
        let is_examinee = scale.examinees.iter().any(|one| one.name == ability.player);
        TimelinePlayer { ability, is_examinee, suites, change }
    }

    /// Returns the mean ability, or negative infinity if no ability could be estimated.
    fn level(&self) -> f64 {
        let values = self.ability.months.iter().filter_map(|month| Some(month.ability?.value)).collect_vec();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        if values.is_empty() {
            f64::NEG_INFINITY
        } else {
            self.change.as_ref().map_or(mean, |change| change.mean.value)
        }
    }
}

impl Change {
    /// Computes the change in an ability. Returns `None` if fewer than two months contain both wins and
    /// losses. `q` is set to `p`, and adjusted later.
    fn of(months: &[MonthAbility]) -> Option<Change> {
        let placed = months.iter().filter(|month| month.is_bounded == [true, true]);
        let placed =
            placed.filter_map(|month| Some((month.ability?.value, month.error?.total))).collect_vec();
        let [(first, first_error), .., (last, last_error)] = placed[..] else { return None };
        let weight: f64 = placed.iter().map(|(_, error)| 1.0 / (error * error)).sum();
        let mean = placed.iter().map(|(value, error)| value / (error * error)).sum::<f64>() / weight;
        let chi_squared: f64 =
            placed.iter().map(|(value, error)| (value - mean) * (value - mean) / (error * error)).sum();
        let p = chi_squared_p(chi_squared, placed.len() as u64 - 1);
        let (value, half) =
            (last - first, Z95 * (first_error * first_error + last_error * last_error).sqrt());
        Some(Change {
            months: placed.len() as u64,
            mean: Estimate { value: mean, error: (1.0 / weight).sqrt() },
            from_first_to_last: Span { value, low: value - half, high: value + half },
            chi_squared,
            p,
            q: p,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::ErrorParts;

    fn month(name: &str, value: f64, is_bounded: [bool; 2]) -> MonthAbility {
        MonthAbility {
            month: name.to_owned(),
            won: 1,
            episodes: 2,
            games: 2,
            ability: Some(Span { value, low: value - 1.0, high: value + 1.0 }),
            is_bounded,
            error: Some(ErrorParts { total: 0.5, sampling: 0.4, mismatch: 0.3, link: 0.0 }),
            mismatch_sd: None,
            refusal: None,
            drift: None,
        }
    }

    #[test]
    fn changes_are_measured_in_errors() {
        let both = [true, true];
        let found =
            Change::of(&[month("a", 1.0, both), month("b", -9.0, [false, true]), month("c", 2.0, both)])
                .unwrap();
        assert_eq!((found.months, found.mean.value), (2, 1.5));
        assert!((found.chi_squared - 2.0).abs() < 1e-12 && (found.p - 0.1573).abs() < 1e-4, "{found:?}");
        let Span { value, low, high } = found.from_first_to_last;
        assert!(value == 1.0 && low < 0.0 && high > 2.3, "{found:?}");
        assert_eq!(Change::of(&[month("a", 1.0, both)]), None);
    }
}
