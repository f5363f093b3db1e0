//! An estimate of the number of rule sets that the inventor can draw.

use super::draw::InventionConfig;
use super::genome::Invention;
use super::mechanic::Mechanic;
use base::Seed;

/// The estimated number of rule sets that the inventor can draw.
///
/// A rule set is a choice of mechanics and an ending. For each number of mechanics, the choices are counted exactly,
/// and the fraction that can be built is estimated from uniformly drawn choices. The result is a lower bound on the
/// number of distinct rules, because the ports (the mechanics' open roles) of most choices can be merged in several
/// ways.
#[derive(Clone, Debug, PartialEq)]
pub struct InventionSupply {
    strata: Vec<Stratum>,
}

/// The counts for a given number of mechanics: all choices of mechanics and an ending, the choices drawn as a sample,
/// and the drawn choices that can be built.
#[derive(Clone, Debug, PartialEq)]
struct Stratum {
    choices: f64,
    drawn: u64,
    sound: u64,
}

impl InventionSupply {
    /// Estimates the number of rule sets. For each number of mechanics, `samples` choices of mechanics and an ending
    /// are drawn and tested. Cost: about 2 milliseconds per choice.
    pub fn estimate(config: &InventionConfig, samples: u64, seed: Seed) -> InventionSupply {
        let [mechanics, endings] = [false, true].map(|are| Mechanic::endings(are).count() as f64);
        let stratum = |count: usize| {
            let seed = seed.child("mechanics", count as u64);
            let is_sound =
                |at: &u64| Invention::of_uniform_choice(count, seed.child("choice", *at)).is_some();
            Stratum {
                choices: combinations(mechanics, count) * endings,
                drawn: samples,
                sound: (0..samples).filter(is_sound).count() as u64,
            }
        };
        InventionSupply { strata: (2..=config.mechanics.max(2)).map(stratum).collect() }
    }

    /// Returns the estimated number of rule sets.
    pub fn sets(&self) -> f64 {
        let sets = |stratum: &Stratum| stratum.choices * stratum.sound as f64 / stratum.drawn.max(1) as f64;
        self.strata.iter().map(sets).sum()
    }

    /// Returns the total number of choices, including choices that cannot become a game.
    pub fn choices(&self) -> f64 {
        self.strata.iter().map(|stratum| stratum.choices).sum()
    }

    /// Returns the fraction of the drawn choices that can become a game.
    pub fn sound_share(&self) -> f64 {
        let [drawn, sound] = [|of: &Stratum| of.drawn, |of: &Stratum| of.sound]
            .map(|count| self.strata.iter().map(count).sum::<u64>() as f64);
        if drawn == 0.0 { 0.0 } else { sound / drawn }
    }
}

/// Returns the number of combinations of `count` elements from `all`.
fn combinations(all: f64, count: usize) -> f64 {
    (0..count).fold(1.0, |ways, at| ways * (all - at as f64).max(0.0) / (at + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_counted() {
        assert_eq!(combinations(93.0, 2), 4278.0);
        assert_eq!(combinations(5.0, 3), 10.0);
        assert_eq!(combinations(2.0, 3), 0.0);
    }

    #[test]
    fn the_estimate_is_of_its_seed_and_within_the_choices() {
        let estimate =
            |seed| InventionSupply::estimate(&InventionConfig::default(), 24, Seed::from_text(seed));
        let one = estimate("one");
        assert_eq!(one, estimate("one"));
        assert!(one.sets() > 1000.0 && one.sets() < one.choices(), "{one:?}");
        assert_eq!(
            InventionSupply::estimate(&InventionConfig::default(), 0, Seed::from_text("none")).sets(),
            0.0
        );
    }
}
