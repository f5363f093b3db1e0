//! Random numbers for simulations. They come from ChaCha8 and are the same on every machine.

use libm::{log, sqrt};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A stream of random numbers, determined by its seed.
pub(crate) struct Draws(ChaCha8Rng);

impl Draws {
    pub(crate) fn new(seed: u64) -> Draws {
        Draws(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Draws a number uniformly from 0..1.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Draws a standard normal number (G. Marsaglia and T. A. Bray, "A convenient method for generating
    /// normal variables", 1964).
    pub(crate) fn normal(&mut self) -> f64 {
        loop {
            let [x, y] = [0, 1].map(|_| 2.0 * self.uniform() - 1.0);
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                return x * sqrt(-2.0 * log(square) / square);
            }
        }
    }

    /// Draws the number of successes in `trials` independent trials, each with success probability `chance`.
    pub(crate) fn successes(&mut self, chance: f64, trials: u64) -> u64 {
        (0..trials).filter(|_| self.uniform() < chance).count() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_normal() {
        let mut stream = Draws::new(30);
        let draws: Vec<f64> = (0..20000).map(|_| stream.normal()).collect();
        let (mean, square) = draws.iter().fold((0.0, 0.0), |sum, z| (sum.0 + z, sum.1 + z * z));
        assert!((mean / 20000.0).abs() < 0.03 && (square / 20000.0 - 1.0).abs() < 0.04);
    }

    #[test]
    fn successes_have_their_chance() {
        let found = Draws::new(31).successes(0.3, 20000);
        assert!((5800..6200).contains(&found), "{found}");
    }
}
