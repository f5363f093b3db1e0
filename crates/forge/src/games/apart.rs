//! Inventions at a large distance from the known games.

use base::{Sampler, Seed};
use generators::Variation;
use generators::invention::{Census, Invention, InventionConfig, InventionVariation, Lead};
use validators::novelty::{GameForm, distance};

/// The distance to every known game, from 0 (the same rules) to 1, at which a draw is accepted immediately.
const FAR: f64 = 0.6;
/// The maximum number of draws to compare.
const DRAWS: u64 = 12;

/// The number of attempts at a game after which a different mechanic is requested for the draws.
const PATIENCE: u32 = 6;
/// The number of attempts at a game after which a different danger and a different ending are requested for the draws.
/// Some dangers and endings hardly ever pass in combination, so a game must not keep them for long.
pub(super) const LONG_PATIENCE: u32 = 12;
/// The number of turns by which the requested parts advance each time. It exceeds the number of games in a month.
const STRIDE: usize = 31;

/// Inventions as search candidates, drawn at a large distance from known games. [`InventionVariation`] makes the
/// changes.
pub(crate) struct FarInventions<'a> {
    variation: InventionVariation,
    known: &'a [GameForm],
    lead: Lead,
}

impl<'a> FarInventions<'a> {
    /// Creates the variation for an attempt at game `number`. Its draws prefer the mechanics with the lowest use counts
    /// in the census. If all games in an order use the same `seed`, different parts are requested for each game's
    /// draws.
    pub(crate) fn new(
        census: &Census,
        known: &'a [GameForm],
        (number, attempt): (u32, u32),
        seed: Seed,
    ) -> FarInventions<'a> {
        let turn = |patience: u32| number as usize + (attempt / patience) as usize * STRIDE;
        let lead = census.lead(seed, turn(LONG_PATIENCE), turn(PATIENCE));
        let config = InventionConfig { lead, ..InventionConfig::default() };
        FarInventions { variation: InventionVariation::new(config, census.clone()), known, lead }
    }

    /// Returns the child, or its parent if the child has lost a requested part. Otherwise, searches for different games
    /// would converge on the parts that pass most easily.
    fn led(&self, child: Invention, parent: &Invention) -> Invention {
        let has = |invention: &Invention, part| invention.mechanics().any(|name| Some(name) == part);
        let loses = |part| has(parent, part) && !has(&child, part);
        let parts = [self.lead.mechanic, self.lead.danger, self.lead.ending];
        if parts.into_iter().any(loses) { parent.clone() } else { child }
    }
}

impl Variation for FarInventions<'_> {
    type Candidate = Invention;

    /// Returns the first draw that is far from every known game. If none of the [`DRAWS`] draws is far enough, returns
    /// the farthest, or `None` if no draw yields a game.
    fn create(&self, seed: Seed) -> Option<Invention> {
        let mut farthest: Option<(f64, Invention)> = None;
        for draw in 0..DRAWS {
            let Some(drawn) = self.variation.create(seed.child("draw", draw)) else { continue };
            let Ok(built) = drawn.build() else { continue };
            let form = GameForm::of(&built.game.rules);
            let nearest = self.known.iter().map(|known| distance(&form, known)).fold(1.0, f64::min);
            if nearest >= FAR {
                return Some(drawn);
            }
            if farthest.as_ref().is_none_or(|(best, _)| nearest > *best) {
                farthest = Some((nearest, drawn));
            }
        }
        farthest.map(|(_, drawn)| drawn)
    }

    fn mutate(&self, parent: &Invention, sampler: &mut Sampler) -> Invention {
        self.led(self.variation.mutate(parent, sampler), parent)
    }

    fn cross(&self, one: &Invention, two: &Invention, sampler: &mut Sampler) -> Invention {
        self.led(self.variation.cross(one, two, sampler), one)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn games_of_an_order_are_led_by_different_mechanics() {
        let seed = Seed::from_text("leads");
        let lead = |number, attempt| {
            let far = FarInventions::new(&Census::default(), &[], (number, attempt), seed);
            let drawn = far.create(seed.child("rules", number.into())).unwrap();
            let turn = number as usize + (attempt / PATIENCE) as usize * STRIDE;
            let lead = Census::default().lead(seed, number as usize, turn);
            (lead.mechanic, drawn.mechanics().any(|name| Some(name) == lead.danger))
        };
        let leads: BTreeSet<Option<&str>> = (0..12).map(|number| lead(number, 0).0).collect();
        assert_eq!(leads.len(), 12);
        assert!((0..12).filter(|&number| lead(number, 0).1).count() > 8, "most dangers fit something");
        assert_ne!(lead(0, 0).0, lead(0, PATIENCE).0);
    }

    #[test]
    fn draws_keep_away_from_known_games() {
        let seed = Seed::from_text("far inventions");
        let form = |drawn: &Invention| GameForm::of(&drawn.build().unwrap().game.rules);
        let plain = InventionVariation::default();
        let nearest = |drawn: &Invention, known: &[GameForm]| form(drawn).nearest(known).unwrap().1;
        let known: Vec<GameForm> = (0..40)
            .filter_map(|at| plain.create(seed.child("known", at)))
            .map(|drawn| form(&drawn))
            .collect();
        let far = |known| FarInventions::new(&Census::default(), known, (0, 0), seed);
        let (near, apart) = (far(&[]), far(&known));
        for at in 0..4 {
            let seed = seed.child("drawn", at);
            let first = near.create(seed).unwrap();
            let drawn = apart.create(seed).unwrap();
            assert!(nearest(&drawn, &known) >= nearest(&first, &known).min(FAR));
        }
    }
}
