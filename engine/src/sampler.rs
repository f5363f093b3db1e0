//! Random draws for everything that is not part of a game's rules: search, generation, imagined futures.
//!
//! ChaCha8 produces the bits. The few distributions are implemented here and pinned by golden vectors, because a library
//! may change the values of its distributions in a minor release, and minted bytes depend on them
//! (`docs/decisions/0003-determinism.md`).

use crate::seed::Seed;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// A stream of random draws. It is saved as its seed and its position.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(into = "Saved", from = "Saved")]
pub struct Sampler(ChaCha8Rng);

#[derive(Serialize, Deserialize)]
struct Saved {
    seed: Seed,
    /// The number of 64-bit draws so far.
    drawn: u64,
}

impl From<Sampler> for Saved {
    fn from(Sampler(stream): Sampler) -> Saved {
        // Each draw takes two 32-bit words, and nothing takes a single one.
        Saved { seed: Seed::from_bytes(stream.get_seed()), drawn: (stream.get_word_pos() / 2) as u64 }
    }
}

impl From<Saved> for Sampler {
    fn from(Saved { seed, drawn }: Saved) -> Sampler {
        let mut sampler = seed.sampler();
        sampler.0.set_word_pos(u128::from(drawn) * 2);
        sampler
    }
}

impl Sampler {
    pub(crate) fn new(seed: [u8; 32]) -> Sampler {
        Sampler(ChaCha8Rng::from_seed(seed))
    }

    /// 64 uniform bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A uniform number in `0..bound`, without bias (Lemire 2019, "Fast random integer generation in an interval").
    ///
    /// # Panics
    /// If `bound` is 0.
    pub fn below(&mut self, bound: usize) -> usize {
        assert!(bound > 0, "a choice needs at least one option");
        let bound = bound as u64;
        let mut wide = u128::from(self.bits()) * u128::from(bound);
        if (wide as u64) < bound {
            let threshold = bound.wrapping_neg() % bound;
            while (wide as u64) < threshold {
                wide = u128::from(self.bits()) * u128::from(bound);
            }
        }
        (wide >> 64) as usize
    }

    /// A uniform number in `low..=high`.
    pub fn between(&mut self, low: usize, high: usize) -> usize {
        low + self.below(high - low + 1)
    }

    /// A uniform number in [0, 1) with 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns `true` with probability `numerator / denominator`.
    pub fn ratio(&mut self, numerator: usize, denominator: usize) -> bool {
        self.below(denominator) < numerator
    }

    /// One of `options`, uniformly.
    ///
    /// # Panics
    /// If there are none.
    pub fn choose<'a, T>(&mut self, options: &'a [T]) -> &'a T {
        &options[self.below(options.len())]
    }

    /// An index drawn in proportion to `weights`; `None` if they sum to 0.
    pub fn weighted(&mut self, weights: &[u32]) -> Option<usize> {
        let total: u64 = weights.iter().map(|&weight| u64::from(weight)).sum();
        if total == 0 {
            return None;
        }
        let mut ticket = self.below(total as usize) as u64;
        weights.iter().position(|&weight| {
            let hit = ticket < u64::from(weight);
            ticket = ticket.saturating_sub(u64::from(weight));
            hit
        })
    }

    /// Shuffles `items` (Fisher–Yates, from the last place down).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Sampler;
    use crate::Seed;

    /// Golden vectors: if they change, GENERATION must be incremented.
    #[test]
    fn draws_are_frozen() {
        let mut sampler = Seed::from_text("golden").sampler();
        let below: Vec<usize> = (0..8).map(|_| sampler.below(1000)).collect();
        let mut deck: Vec<usize> = (0..10).collect();
        sampler.shuffle(&mut deck);
        let weighted: Vec<_> = (0..6).map(|_| sampler.weighted(&[1, 0, 3]).unwrap()).collect();
        let unit = sampler.unit();
        assert_eq!(
            format!("{below:?} {deck:?} {weighted:?} {unit:?}"),
            "[689, 939, 409, 440, 878, 202, 696, 398] [5, 4, 7, 0, 8, 2, 6, 1, 9, 3] [2, 0, 0, 2, 2, 2] 0.3425580970223794"
        );
    }

    #[test]
    fn a_saved_stream_goes_on() {
        let mut sampler = Seed::from_text("saved").sampler();
        let drawn: Vec<u64> = (0..37).map(|_| sampler.bits()).collect();
        assert_eq!(drawn.len(), 37);
        let saved = serde_json::to_string(&sampler).unwrap();
        let mut loaded: Sampler = serde_json::from_str(&saved).unwrap();
        assert!((0..100).all(|_| sampler.bits() == loaded.bits()), "{saved}");
    }

    #[test]
    fn weights_of_zero_are_never_drawn() {
        let mut sampler = Seed::from_text("weights").sampler();
        assert!((0..200).all(|_| sampler.weighted(&[0, 5, 0]) == Some(1)));
        assert_eq!(sampler.weighted(&[0, 0]), None);
    }
}
