//! The differences between the distributions of two releases, and permutation tests of their significance.
//!
//! Levels of the same game are correlated, so tests permute games rather than levels. A test deals the games
//! to the two releases at random, [`DEALS`] times. The p-value is the fraction of deals, including the
//! observed one, whose difference is at least as large as observed (B. Phipson and G. K. Smyth, "Permutation
//! p-values should never be zero", 2010).

use super::Compared;
use base::Seed;
use report::Quantiles;
use serde::Serialize;
use std::collections::BTreeMap;

/// The number of deals in a permutation test, not counting the observed deal.
pub const DEALS: usize = 999;

/// A value in a distribution, with its count in each release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The label's value.
    pub value: String,
    /// The count in the earlier release.
    pub before: usize,
    /// The count in the later release.
    pub after: usize,
}

/// The distribution of a label in both releases.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shift {
    /// The distribution's name.
    pub name: &'static str,
    /// The counts for each value, ordered by value.
    pub shares: Vec<Share>,
    /// The total variation distance, from 0 for equal fractions to 1 for nothing in common; `None` if either release
    /// has no values.
    pub distance: Option<f64>,
    /// The p-value: the fraction of random deals whose distance is at least as large as the observed one.
    pub p: Option<f64>,
    /// The number of levels that have no value because they were not measured.
    #[serde(skip_serializing_if = "Unmeasured::is_none")]
    pub unmeasured: Unmeasured,
}

/// The number of unmeasured levels in each release.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Unmeasured {
    /// The number of unmeasured levels in the earlier release.
    pub before: usize,
    /// The number of unmeasured levels in the later release.
    pub after: usize,
}

impl Unmeasured {
    /// Returns `true` if all levels were measured.
    pub fn is_none(&self) -> bool {
        *self == Unmeasured::default()
    }

    /// Counts the levels without results of reference players.
    pub(super) fn of(before: &[Compared<'_>], after: &[Compared<'_>]) -> Unmeasured {
        let count = |side: &[Compared<'_>]| {
            let levels = side.iter().flat_map(|game| &game.released.card.levels);
            levels.filter(|level| level.ladder.is_none()).count()
        };
        Unmeasured { before: count(before), after: count(after) }
    }
}

/// The distribution of a numeric property in both releases.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NumberShift {
    /// The property's name.
    pub name: &'static str,
    /// The quantiles in the earlier release.
    pub before: Option<Quantiles>,
    /// The quantiles in the later release.
    pub after: Option<Quantiles>,
    /// The Kolmogorov–Smirnov distance: the maximum difference between the cumulative fractions; `None` if either
    /// release has no values.
    pub distance: Option<f64>,
    /// The p-value: the fraction of random deals whose distance is at least as large as the observed one.
    pub p: Option<f64>,
    /// The number of levels that have no value because they were not measured.
    #[serde(skip_serializing_if = "Unmeasured::is_none")]
    pub unmeasured: Unmeasured,
}

/// A game's values in a distribution: one, several, or one for each level.
type Values = fn(&Compared<'_>) -> Vec<String>;

/// The name of the distribution of difficulty labels.
pub(super) const DIFFICULTY: &str = "difficulty of levels";
/// The name of the distribution of level ease.
const EASE: &str = "ease of a level";

const SHIFTS: &[(&str, Values)] = &[
    (DIFFICULTY, |game| {
        let ladders = game.released.card.levels.iter().filter_map(|level| level.ladder.as_ref());
        ladders.map(|ladder| ladder.difficulty.to_string()).collect()
    }),
    ("goal of games", |game| vec![game.kind.goal.name().to_owned()]),
    ("avatar of games", |game| vec![game.kind.avatar.name().to_owned()]),
    ("goal and avatar of games", |game| {
        vec![format!("{} × {}", game.kind.goal.name(), game.kind.avatar.name())]
    }),
    ("randomness in games", |game| vec![game.kind.chance.name().to_owned()]),
    ("origin of games", |game| vec![if game.is_generated() { "generated" } else { "corpus" }.to_owned()]),
    ("patterns of generated games", |game| {
        game.released.card.origin.mechanics().into_iter().map(str::to_owned).collect()
    }),
    ("effects of rules", |game| game.kind.effects.iter().map(|family| family.name().to_owned()).collect()),
    ("generators of levels", |game| {
        game.released.card.levels.iter().map(|level| level.generator.clone()).collect()
    }),
];

type Numbers = fn(&Compared<'_>) -> Vec<f64>;

const NUMBERS: &[(&str, Numbers)] = &[
    ("cells of a board", |game| {
        game.released.levels.iter().map(|level| level.level.cells().len() as f64).collect()
    }),
    ("columns of a board", |game| {
        game.released.levels.iter().map(|level| level.level.columns() as f64).collect()
    }),
    ("rows of a board", |game| game.released.levels.iter().map(|level| level.level.rows() as f64).collect()),
    ("interactions of a game, without guards", |game| vec![game.kind.interactions as f64]),
    ("levels of a game", |game| vec![game.released.levels.len() as f64]),
    ("ticks of a witness", |game| {
        game.released.card.levels.iter().map(|level| level.witness_ticks as f64).collect()
    }),
    (EASE, |game| {
        let ladders = game.released.card.levels.iter().filter_map(|level| level.ladder.as_ref());
        ladders.filter_map(|ladder| ladder.ease).collect()
    }),
];

/// Computes all distributions of labels.
pub(super) fn shifts(before: &[Compared<'_>], after: &[Compared<'_>]) -> Vec<Shift> {
    let shift = |&(name, of): &(&'static str, Values)| {
        let games = |side: &[Compared<'_>]| side.iter().map(of).collect::<Vec<_>>();
        let shift = Shift::of(name, &games(before), &games(after));
        let unmeasured = if name == DIFFICULTY { Unmeasured::of(before, after) } else { shift.unmeasured };
        Shift { unmeasured, ..shift }
    };
    SHIFTS.iter().map(shift).collect()
}

/// Computes all distributions of numbers.
pub(super) fn numbers(before: &[Compared<'_>], after: &[Compared<'_>]) -> Vec<NumberShift> {
    let shift = |&(name, of): &(&'static str, Numbers)| {
        let games = |side: &[Compared<'_>]| side.iter().map(of).collect::<Vec<_>>();
        let shift = NumberShift::of(name, &games(before), &games(after));
        let unmeasured = if name == EASE { Unmeasured::of(before, after) } else { shift.unmeasured };
        NumberShift { unmeasured, ..shift }
    };
    NUMBERS.iter().map(shift).collect()
}

impl Shift {
    /// Computes the shift between the values of the games in the two releases.
    pub(super) fn of(name: &'static str, before: &[Vec<String>], after: &[Vec<String>]) -> Shift {
        let mut counts: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
        for (side, games) in [before, after].into_iter().enumerate() {
            for value in games.iter().flatten() {
                counts.entry(value).or_default()[side] += 1;
            }
        }
        let values: Vec<&str> = counts.keys().copied().collect();
        let place = |value: &String| values.binary_search(&value.as_str()).expect("every value was counted");
        let games: Vec<Vec<usize>> =
            before.iter().chain(after).map(|game| game.iter().map(place).collect()).collect();
        let distance = |sides: &[bool]| {
            let mut counts = vec![[0_u32; 2]; values.len()];
            for (game, side) in games.iter().zip(sides) {
                game.iter().for_each(|value| counts[*value][usize::from(*side)] += 1);
            }
            variation(&counts)
        };
        let (distance, p) = test(name, (before.len(), after.len()), distance);
        let share =
            |(value, [before, after]): (&str, [usize; 2])| Share { value: value.to_owned(), before, after };
        let shares = counts.into_iter().map(share).collect();
        Shift { name, shares, distance, p, unmeasured: Unmeasured::default() }
    }
}

impl NumberShift {
    /// Computes the shift between the numbers of the games in the two releases.
    pub(super) fn of(name: &'static str, before: &[Vec<f64>], after: &[Vec<f64>]) -> NumberShift {
        let games = before.iter().chain(after).enumerate();
        let mut numbers: Vec<(f64, usize)> =
            games.flat_map(|(at, game)| game.iter().map(move |number| (*number, at))).collect();
        numbers.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let distance = |sides: &[bool]| {
            let mut all = [0_u32; 2];
            numbers.iter().for_each(|(_, game)| all[usize::from(sides[*game])] += 1);
            if all.contains(&0) {
                return None;
            }
            let (mut below, mut most) = ([0_u32; 2], 0.0_f64);
            for (at, (number, game)) in numbers.iter().enumerate() {
                below[usize::from(sides[*game])] += 1;
                // Among equal numbers, the distance is computed only at the last one, where the count includes all of
                // them.
                if numbers.get(at + 1).is_none_or(|(next, _)| next != number) {
                    let [one, other] = [0, 1].map(|side| f64::from(below[side]) / f64::from(all[side]));
                    most = most.max((one - other).abs());
                }
            }
            Some(most)
        };
        let (distance, p) = test(name, (before.len(), after.len()), distance);
        let quantiles = |games: &[Vec<f64>]| Quantiles::of(&games.concat());
        let unmeasured = Unmeasured::default();
        NumberShift { name, before: quantiles(before), after: quantiles(after), distance, p, unmeasured }
    }
}

/// Returns the total variation distance, which is half the sum of the absolute differences between the fractions;
/// `None` if either side is empty.
fn variation(counts: &[[u32; 2]]) -> Option<f64> {
    let all = [0, 1].map(|side: usize| counts.iter().map(|count| count[side]).sum::<u32>());
    let share = |count: &[u32; 2], side: usize| f64::from(count[side]) / f64::from(all[side]);
    let apart = |count: &[u32; 2]| (share(count, 0) - share(count, 1)).abs();
    (!all.contains(&0)).then(|| counts.iter().map(apart).sum::<f64>() / 2.0)
}

/// Computes a distance and its p-value. `distance` is called with the side assigned to each game, earlier games
/// first.
fn test(
    name: &str,
    (before, after): (usize, usize),
    distance: impl Fn(&[bool]) -> Option<f64>,
) -> (Option<f64>, Option<f64>) {
    let mut sides = vec![false; before];
    sides.resize(before + after, true);
    let Some(found) = distance(&sides) else { return (None, None) };
    let mut sampler = Seed::from_text("diff").child(name, 0).sampler();
    let mut as_far = 1;
    for _ in 0..DEALS {
        sampler.shuffle(&mut sides);
        // The tolerance allows for rounding. A deal that leaves one side without values counts as the largest
        // distance.
        as_far += usize::from(distance(&sides).is_none_or(|apart| apart >= found - 1e-12));
    }
    (Some(found), Some(as_far as f64 / (DEALS + 1) as f64))
}
