//! An estimate of the number of games that a chain of monthly releases can still invent, based on rules alone.
//!
//! [`simulate`] draws a chain's invented games as minting does, but without boards. Every month takes the games of all
//! earlier months into account and prefers the mechanics least used so far. `chain.rs` draws rules, `clusters.rs` and
//! `species.rs` count repetitions, `words.rs` counts repeated texts, and `table.rs` formats the months.

mod chain;
mod clusters;
mod month;
mod species;
mod table;
mod words;

pub use month::{Again, Nearest, Top, Well, WellMonth, WellOrder};

use crate::games::{Cast, FarInventions};
use base::Seed;
use chain::Chain;
use generators::Variation;
use generators::invention::{Census, Invention, InventionConfig, InventionSupply};
use month::Sketch;
use rayon::prelude::*;
use validators::novelty::GameForm;

/// The number of mechanic combinations to draw, for each number of mechanics, when estimating the number of rule sets.
const SUPPLY_SAMPLES: u64 = 500;
/// The number of draws used to estimate how many rule sets are near a known game.
const NEAR_SAMPLES: u64 = 64;

/// Estimates the number of rule sets that are not near a known game. The sample is drawn as in a month that follows the
/// games counted in the census. Costs one or two core seconds, and a few microseconds per known game.
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

/// Simulates a chain of monthly releases whose invented games must differ from the `known` games. `noted` is called
/// with each month.
///
/// The same order, known games and seed give the same result on any number of threads. Costs about 10 ms of processor
/// time per passing candidate, and a few microseconds per pair of candidates.
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
