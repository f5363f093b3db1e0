//! The random number generator for games: the 48-bit linear congruential generator that the reference uses in
//! VGDL games (`spec/01` §7.1). The algorithm is the one published for `java.util.Random`.

use crate::flat::bytes_of_wrapper;
use base::Seed;

const MULTIPLIER: u64 = 0x5_DEEC_E66D;
const MASK: u64 = (1 << 48) - 1;
/// The number of bits that [`Chance::float`] draws.
pub(crate) const DRAW: u32 = 24;

/// An eight-byte random number generator, which is part of every [`State`](crate::State).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Chance(pub(crate) u64);

bytes_of_wrapper! { Chance }

impl Chance {
    /// Creates the generator for an episode with the given seed (`spec/01` §7).
    pub fn from_seed(seed: Seed) -> Chance {
        Chance::from_java(seed.number("infinite-arcade 1 chance"))
    }

    /// Creates the same generator as the reference creates from a seed recorded in a trace.
    pub fn from_java(seed: i64) -> Chance {
        Chance((seed as u64 ^ MULTIPLIER) & MASK)
    }

    /// Returns the 48-bit state, as recorded in traces.
    pub fn state(self) -> u64 {
        self.0
    }

    /// Draws up to 31 bits.
    pub(crate) fn next(&mut self, bits: u32) -> i32 {
        self.0 = self.0.wrapping_mul(MULTIPLIER).wrapping_add(0xB) & MASK;
        (self.0 >> (48 - bits)) as i32
    }

    /// Returns a uniform number in `0..bound`. A bound that is a power of two needs one draw, and other
    /// bounds rarely need more.
    pub fn below(&mut self, bound: i32) -> i32 {
        debug_assert!(bound > 0, "a choice needs at least one option");
        let mut draw = self.next(31);
        let most = bound - 1;
        if bound & most == 0 {
            return ((i64::from(bound) * i64::from(draw)) >> 31) as i32;
        }
        loop {
            let rest = draw % bound;
            if draw.wrapping_sub(rest).wrapping_add(most) >= 0 {
                return rest;
            }
            draw = self.next(31);
        }
    }

    /// Returns a uniform 24-bit number in [0, 1), using one draw.
    pub fn float(&mut self) -> f32 {
        self.next(DRAW) as f32 / (1 << DRAW) as f32
    }

    /// Returns a uniform 53-bit number in [0, 1), using two draws.
    pub fn double(&mut self) -> f64 {
        let high = i64::from(self.next(26)) << 27;
        let low = i64::from(self.next(27));
        (high + low) as f64 * (1.0 / (1u64 << 53) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares random numbers with a golden vector. If the vector changes, the games of all releases get
    /// different random numbers.
    #[test]
    fn the_randomness_of_a_seed_is_frozen() {
        let seed = Seed::from_text("starter").child("game", 7);
        assert_eq!(Chance::from_seed(seed).state(), 149_835_684_101_585);
    }

    /// Checks the vector in `spec/01` §7.1.
    #[test]
    fn the_vector_of_the_specification() {
        let mut chance = Chance::from_java(42);
        assert_eq!(chance.below(4), 2);
        assert_eq!(chance.below(3), 0);
        assert_eq!(chance.float(), 0.683_223_4);
        assert_eq!(chance.double(), 0.047_939_305_137_387_644);
        assert_eq!(chance.below(2), 1);
        assert_eq!(chance.below(5), 0);
        assert_eq!(chance.below(8), 5);
    }
}
