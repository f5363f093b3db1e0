//! Distances between the rules of the games in two releases.

use super::Compared;
use rayon::prelude::*;
use report::Quantiles;
use serde::Serialize;
use validators::novelty::{NEAR, distance};

/// Two games and the distance between their rules.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// The later game.
    pub after: String,
    /// The earlier game.
    pub before: String,
    /// The distance from 0 (the same rules) to 1 (nothing in common): [`validators::novelty::distance`].
    pub distance: f64,
}

/// The nearest neighbours across two releases.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Neighbours {
    /// The distance from each later game to its nearest earlier game.
    pub across: Option<Quantiles>,
    /// The same distances for generated games only, because corpus games return by design.
    pub across_generated: Option<Quantiles>,
    /// The distance from each later game to its nearest neighbour among the later games, for comparison.
    pub within: Option<Quantiles>,
    /// The number of later games nearer than [`NEAR`] to an earlier game. Such games have the same rules with
    /// different numbers or a different theme.
    pub near: usize,
    /// The number of pairs nearer than [`NEAR`] in which both games are generated.
    pub near_generated: usize,
    /// The nearest pairs, in order of increasing distance.
    pub closest: Vec<Pair>,
}

impl Neighbours {
    /// Finds the nearest neighbours. Cost: O(rules) per pair of games.
    pub(super) fn of(before: &[Compared<'_>], after: &[Compared<'_>], closest: usize) -> Neighbours {
        let rows: Vec<Vec<f64>> = after
            .par_iter()
            .map(|game| before.iter().map(|other| distance(&game.form, &other.form)).collect())
            .collect();
        let own: Vec<f64> = after
            .par_iter()
            .enumerate()
            .filter_map(|(at, game)| {
                let others = after.iter().enumerate().filter(|(other, _)| *other != at);
                least(others.map(|(_, other)| distance(&game.form, &other.form)))
            })
            .collect();
        let across: Vec<f64> = rows.iter().filter_map(|row| least(row.iter().copied())).collect();
        let generated: Vec<f64> = rows
            .iter()
            .zip(after)
            .filter(|(_, game)| game.is_generated())
            .filter_map(|(row, _)| {
                let made = row.iter().zip(before).filter(|(_, other)| other.is_generated());
                least(made.map(|(apart, _)| *apart))
            })
            .collect();
        let mut pairs: Vec<(f64, usize, usize)> = rows
            .iter()
            .enumerate()
            .flat_map(|(at, row)| row.iter().enumerate().map(move |(other, apart)| (*apart, at, other)))
            .collect();
        pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        pairs.truncate(closest);
        let near = |distances: &[f64]| distances.iter().filter(|apart| **apart < NEAR).count();
        let id = |game: &Compared<'_>| game.released.card.id.clone();
        Neighbours {
            near: near(&across),
            near_generated: near(&generated),
            across: Quantiles::of(&across),
            across_generated: Quantiles::of(&generated),
            within: Quantiles::of(&own),
            closest: pairs
                .into_iter()
                .map(|(distance, at, other)| Pair {
                    after: id(&after[at]),
                    before: id(&before[other]),
                    distance,
                })
                .collect(),
        }
    }
}

fn least(distances: impl Iterator<Item = f64>) -> Option<f64> {
    distances.min_by(f64::total_cmp)
}
