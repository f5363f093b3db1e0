//! The well: the supply of games that a chain of months can still invent, measured by rules alone.
//!
//! [`simulate`] draws the invented games of a chain of months like minting, but without boards. Every month knows the
//! games of all earlier months and prefers the mechanics that they used least. `chain.rs` draws rules, `clusters.rs`
//! and `species.rs` count what was seen before, `words.rs` counts repeated words, and `table.rs` shows the months.

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

/// The number of choices of mechanics that are drawn to estimate the number of rule sets, for each number of mechanics.
const SUPPLY_SAMPLES: u64 = 500;
/// The number of draws that estimate how many rule sets are near a known game.
const NEAR_SAMPLES: u64 = 64;

/// A chain of months to simulate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WellOrder {
    /// The number of months.
    pub months: u32,
    /// The number of invented games per month.
    pub games: u32,
    /// The number of candidate games per game of a month.
    pub candidates: f64,
    /// The maximum number of rule sets drawn for one candidate.
    pub tries: u32,
    /// The fraction of new rule sets whose boards pass all judges. The seed decides which rule sets these are.
    pub passing: f64,
}

impl Default for WellOrder {
    fn default() -> WellOrder {
        WellOrder { months: 24, games: 100, candidates: 1.5, tries: 16, passing: 0.1 }
    }
}

/// The months of a chain, with the number of rule sets that they draw from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Well {
    /// The order for the simulation.
    pub order: WellOrder,
    /// The estimated number of choices of mechanics and an ending for which a game can be built.
    pub sets: f64,
    /// The fraction of all choices of mechanics and an ending for which a game can be built.
    pub sound: f64,
    /// The months in chronological order.
    pub months: Vec<WellMonth>,
}

/// A month of a chain. Fractions and unseen masses refer to all months up to this one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WellMonth {
    /// The number of the month, from 1.
    pub month: u32,
    /// The estimated number of rule sets that are not near any game from before this month.
    pub available: f64,
    /// The number of rule sets that were drawn for candidates.
    pub drawn: u64,
    /// The number of drawn rule sets for which no board was found, as decided by the seed.
    pub failed: u64,
    /// The number of drawn rule sets that were near a game of an earlier month or a known game.
    pub near: u64,
    /// The number of candidates that were near another candidate of the month.
    pub near_in_month: u64,
    /// The number of candidates that had two mechanics of another candidate of the month.
    pub same_idea: u64,
    /// The number of candidates that had the title or the cast of another candidate of the month.
    pub same_words: u64,
    /// The number of new games.
    pub games: u32,
    /// The number of new games in all months up to this one.
    pub used: u32,
    /// The number of candidates per drawn rule set.
    pub yielded: f64,
    /// The distances between the new games and their nearest predecessors, including known games.
    pub nearest: Option<Nearest>,
    /// The unseen mass of rules (Good–Turing). It is the probability that the next rules have a distance of at least
    /// 0.3 from all rules drawn so far.
    pub unseen_near: Option<f64>,
    /// The unseen mass of rules for a distance of 0.4.
    pub unseen_far: Option<f64>,
    /// The unseen mass of merged pairs of ports.
    pub unseen_couplings: Option<f64>,
    /// The unseen mass of mechanics, not counting endings.
    pub unseen_mechanics: Option<f64>,
    /// The mechanic that occurs in the most games.
    pub top_mechanic: Option<Top>,
    /// The ending that occurs in the most games.
    pub top_ending: Option<Top>,
    /// The merged pair of ports that occurs in the most games.
    pub top_coupling: Option<Top>,
    /// The words of the new games that were already used within the preceding year.
    pub again: Again,
}

/// The distances between new games and their nearest predecessors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Nearest {
    /// The minimum of the distances.
    pub least: f64,
    /// The 5% quantile of the distances.
    pub low: f64,
    /// The median of the distances.
    pub median: f64,
}

/// The part that occurs in the most games.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Top {
    /// The name of the part.
    pub name: String,
    /// The fraction of games that have the part.
    pub share: f64,
}

/// The repeated words in the games of a month. An earlier game of the same month or of the preceding eleven months had
/// used these words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Again {
    /// The number of games with a repeated title.
    pub titles: u32,
    /// The number of games whose things have exactly the same names as the things of an earlier game.
    pub casts: u32,
    /// The number of games whose summary begins with the first sentence of another summary, which is the story that
    /// introduces the rules.
    pub openings: u32,
    /// The number of repeated sentences in all summaries.
    pub sentences: u32,
    /// The total number of sentences in the summaries of the month.
    pub all_sentences: u32,
}

/// The rules and words of a drawn game.
#[derive(Clone, Debug)]
pub(crate) struct Sketch {
    pub(crate) form: GameForm,
    pub(crate) title: String,
    pub(crate) summary: String,
    pub(crate) cast: Cast,
    pub(crate) patterns: Vec<String>,
}

/// Estimates the number of rule sets that are not near a known game. The sample is drawn as for a month after the games
/// of a census. Cost: a second or two of one core, and some microseconds per known game.
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

/// Simulates a chain of months with invented games that are kept apart from `known` games. `noted` receives each month.
///
/// The same order, known games and seed give the same result on any number of threads. Cost: about 10 milliseconds of
/// one core per candidate that passes, and a few microseconds per pair of candidates.
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
