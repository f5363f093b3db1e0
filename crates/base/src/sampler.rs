//! Random draws for everything that is not part of a game's rules: search, generation, imagined futures.
//!
//! ChaCha8 produces the bits. The few distributions that the suite needs are implemented here and pinned by
//! golden vectors. Other libraries may change the values of their distributions in a minor release, but
//! minted bytes depend on such values (`docs/lab/decisions/0003-determinism.md`).

use crate::seed::Seed;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng, TryRng, utils};
use serde::{Deserialize, Serialize};
use std::convert::Infallible;

/// A stream of random draws. A stream is saved as its seed and its position.
///
/// `Sampler` also implements the traits of `rand`, for use with `rand` and with other crates' distributions.
/// Other crates' results for the same bits may change between versions. The methods of `Sampler` itself
/// always return the same values.
///
/// ```
/// use infinite_arcade_base::{Sampler, Seed};
/// use rand::distr::{Bernoulli, Distribution};
/// use rand::seq::SliceRandom;
///
/// let mut sampler: Sampler = Seed::from_text("weather").sampler();
/// let gusts = Bernoulli::new(0.25)?;
/// let windy = gusts.sample_iter(&mut sampler).take(1000).filter(|&gust| gust).count();
/// assert!((200..300).contains(&windy));
///
/// let mut deck = ["sun", "rain", "hail"];
/// deck.shuffle(&mut sampler);
/// # Ok::<(), rand::distr::BernoulliError>(())
/// ```
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
        // Each draw consumes two 32-bit words, and no method consumes a single word.
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

    /// Returns 64 uniformly random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Returns a uniform number in `0..bound`, without bias (Lemire 2019, "Fast random integer generation in an interval").
    ///
    /// # Panics
    /// Panics if `bound` is 0.
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

    /// Returns a uniform number in `low..=high`.
    pub fn between(&mut self, low: usize, high: usize) -> usize {
        low + self.below(high - low + 1)
    }

    /// Returns a uniform 53-bit number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns `true` with probability `numerator / denominator`.
    pub fn ratio(&mut self, numerator: usize, denominator: usize) -> bool {
        self.below(denominator) < numerator
    }

    /// Returns one of `options`, chosen uniformly.
    ///
    /// # Panics
    /// Panics if `options` is empty.
    pub fn choose<'a, T>(&mut self, options: &'a [T]) -> &'a T {
        &options[self.below(options.len())]
    }

    /// Returns an index drawn in proportion to `weights`, or `None` if the weights sum to 0.
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

    /// Shuffles `items` (Fisher–Yates, from the last position downwards).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// Provides the bits from [`Sampler::bits`] to other crates' distributions. Every call consumes whole 64-bit
/// draws: `next_u32` consumes one draw, and `fill_bytes` one draw per eight bytes, lowest byte first.
impl TryRng for Sampler {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.bits() as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.bits())
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        utils::fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

/// Creates the stream that [`Seed::sampler`] creates for a seed with the same bytes.
impl SeedableRng for Sampler {
    type Seed = [u8; 32];

    fn from_seed(seed: [u8; 32]) -> Sampler {
        Sampler::new(seed)
    }
}

#[cfg(test)]
mod tests {
    use super::Sampler;
    use crate::Seed;
    use rand_core::{Rng, SeedableRng};

    /// Compares draws with golden vectors. If the vectors change, GENERATION must be incremented.
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

    /// Checks the bits that other crates receive, and the number of bits that each call consumes.
    #[test]
    fn the_traits_of_rand_give_the_same_bits() {
        let seed = Seed::from_text("golden");
        let mut plain = seed.sampler();
        let draws: Vec<u64> = (0..6).map(|_| plain.bits()).collect();
        assert_eq!(draws[0], 12_727_791_363_885_834_071);

        let mut sampler = Sampler::from_seed(*seed.as_bytes());
        let mut bytes = [0; 20];
        assert_eq!((sampler.next_u64(), sampler.next_u32()), (draws[0], draws[1] as u32));
        sampler.fill_bytes(&mut bytes);
        assert_eq!(bytes[..8], draws[2].to_le_bytes());
        assert_eq!(bytes[8..16], draws[3].to_le_bytes());
        assert_eq!(bytes[16..], draws[4].to_le_bytes()[..4]);
        let saved = serde_json::to_string(&sampler).unwrap();
        let mut loaded: Sampler = serde_json::from_str(&saved).unwrap();
        assert_eq!((sampler.bits(), loaded.next_u64()), (draws[5], draws[5]));
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
