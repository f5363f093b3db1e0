//! The well: the games that a chain of months can still invent, measured on rules alone.
//!
//! [`simulate`] draws the invented games of a chain of months as minting draws them, without boards: every month knows the games of the
//! months before and prefers the mechanics that they used least. `chain.rs` draws, `clusters.rs` and `species.rs` count what was seen
//! before, `words.rs` counts what is said twice, and `table.rs` shows the months.

mod chain;
mod clusters;
mod species;
mod table;
mod words;

use crate::games::{Cast, FarInventions};
use base::Seed;
use chain::Chain;
use generators::Variation;
use generators::invention::{Census, Invention, InventionConfig, InventionSupply};
use rayon::prelude::*;
use serde::Serialize;
use validators::novelty::GameForm;

/// The choices of mechanics that are drawn to estimate the rule sets, for each number of mechanics.
const SUPPLY_SAMPLES: u64 = 500;
/// The draws that tell how many rule sets are near to a known game.
const NEAR_SAMPLES: u64 = 64;

/// A chain of months to simulate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WellOrder {
    /// The number of months.
    pub months: u32,
    /// The number of invented games of each month.
    pub games: u32,
    /// The number of candidate games per game of a month.
    pub candidates: f64,
    /// The maximum number of rule sets that are drawn for one candidate.
    pub tries: u32,
    /// The share of new rule sets for which boards are found that pass all judges. The seed draws which ones these are.
    pub passing: f64,
}

impl Default for WellOrder {
    fn default() -> WellOrder {
        WellOrder { months: 24, games: 100, candidates: 1.5, tries: 16, passing: 0.1 }
    }
}

/// The months of a chain, with the numbers of rule sets that they draw from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Well {
    /// The order.
    pub order: WellOrder,
    /// The estimated number of choices of mechanics and an ending for which a game can be built.
    pub sets: f64,
    /// The share of all choices of mechanics and an ending for which a game can be built.
    pub sound: f64,
    /// The months, the first first.
    pub months: Vec<WellMonth>,
}

/// A month of a chain. Shares and unseen masses are over all months up to this one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WellMonth {
    /// The number of the month, from 1.
    pub month: u32,
    /// The estimated number of rule sets that are not near to a game before this month.
    pub available: f64,
    /// The rule sets that were drawn for candidates.
    pub drawn: u64,
    /// The drawn rule sets that no board was found for: those that the seed failed.
    pub failed: u64,
    /// The drawn rule sets that were near to a game of an earlier month or to a known game.
    pub near: u64,
    /// The candidates that were near to another candidate of the month.
    pub near_in_month: u64,
    /// The candidates that had the title or the cast of another of the month.
    pub same_words: u64,
    /// The new games.
    pub games: u32,
    /// The new games of all months up to this one.
    pub used: u32,
    /// The candidates per drawn rule set.
    pub yielded: f64,
    /// The distances of the new games to the nearest game before them, known games included.
    pub nearest: Option<Nearest>,
    /// The unseen mass of rules (Good–Turing): the probability that the next rules are no nearer than 0.3 to any that were drawn.
    pub unseen_near: Option<f64>,
    /// The same for a distance of 0.4.
    pub unseen_far: Option<f64>,
    /// The unseen mass of merged pairs of ports.
    pub unseen_couplings: Option<f64>,
    /// The unseen mass of mechanics, endings apart.
    pub unseen_mechanics: Option<f64>,
    /// The mechanic that most games have.
    pub top_mechanic: Option<Top>,
    /// The ending that most games have.
    pub top_ending: Option<Top>,
    /// The merged pair of ports that most games have.
    pub top_coupling: Option<Top>,
    /// The words of the new games that were used within a year before.
    pub again: Again,
}

/// The distances of new games to the nearest game before each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Nearest {
    /// The least distance.
    pub least: f64,
    /// The 5 % quantile.
    pub low: f64,
    /// The median.
    pub median: f64,
}

/// The part that most games have.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Top {
    /// The name of the part.
    pub name: String,
    /// The share of the games that have it.
    pub share: f64,
}

/// The words of the games of a month that another game of the same month or of the eleven months before used earlier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Again {
    /// The games with a title that was used.
    pub titles: u32,
    /// The games whose things have just the names of those of another game.
    pub casts: u32,
    /// The games whose summary begins with the sentence of another: the story that leads to the rules.
    pub openings: u32,
    /// The sentences of all summaries that were used.
    pub sentences: u32,
    /// All sentences of the summaries of the month.
    pub all_sentences: u32,
}

/// The rules and words of a game that was drawn.
#[derive(Clone, Debug)]
pub(crate) struct Sketch {
    pub(crate) form: GameForm,
    pub(crate) title: String,
    pub(crate) summary: String,
    pub(crate) cast: Cast,
    pub(crate) patterns: Vec<String>,
}

/// Estimates the number of rule sets that are not near to a known game, from some that are drawn as for a month after the games of a
/// census. Cost: a second or two of one core, and some microseconds for each known game.
pub fn left(census: &Census, known: &[GameForm], seed: Seed) -> f64 {
    let sets =
        InventionSupply::estimate(&InventionConfig::default(), SUPPLY_SAMPLES, seed.child("supply", 0))
            .sets();
    if known.is_empty() {
        return sets;
    }
    let draw = |at: u64| {
        let game =
            Invention::draw(&InventionConfig::default(), census, seed.child("draw", at))?.build().ok()?.game;
        Some(GameForm::of(&game.rules))
    };
    let drawn: Vec<GameForm> = (0..NEAR_SAMPLES).into_par_iter().filter_map(draw).collect();
    let new = drawn.iter().filter(|form| !known.iter().any(|other| form.is_near(other))).count();
    sets * new as f64 / NEAR_SAMPLES as f64
}

/// Simulates a chain of months whose games are invented, and apart from `known` games. `noted` receives each month.
///
/// The same order, known games and seed give the same result on any number of threads. Cost: about 10 milliseconds of one core for each
/// candidate that passes, and a few microseconds for each pair of them.
pub fn simulate(order: &WellOrder, known: &[GameForm], seed: Seed, noted: &dyn Fn(&WellMonth)) -> Well {
    let supply =
        InventionSupply::estimate(&InventionConfig::default(), SUPPLY_SAMPLES, seed.child("supply", 0));
    let leads = seed.child("leads", 0);
    let sketch = |census: &Census, known: &[GameForm], turn: (u32, u32), seed: Seed| {
        let variation = FarInventions::new(census, known, turn, leads);
        let game = variation.create(seed.child("rules", 0))?.build().ok()?.game;
        Some(Sketch {
            form: GameForm::of(&game.rules),
            title: game.title,
            summary: game.summary,
            cast: Cast::of(&game.rules),
            patterns: game.patterns,
        })
    };
    let months = Chain::new(order, known, seed, &sketch, supply.sets()).run(noted);
    Well { order: order.clone(), sets: supply.sets(), sound: supply.sound_share(), months }
}
