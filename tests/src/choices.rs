//! Decisions read from bytes, which turn a fuzzer's input into a game.

use base::Sampler;

/// Decisions read from bytes. Small decisions are read from the front. [`Choices::from_end`] reads bytes from
/// the back, so that changing one kind of decision does not shift the other. Past the end, every decision
/// yields the first option, which is always the simplest. Shorter inputs therefore give simpler games.
#[derive(Clone, Debug)]
pub struct Choices<'a> {
    bytes: &'a [u8],
}

impl<'a> Choices<'a> {
    /// Creates the decisions encoded in `bytes`.
    pub fn new(bytes: &'a [u8]) -> Choices<'a> {
        Choices { bytes }
    }

    /// Returns `true` once all bytes have been used.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Returns the remaining bytes.
    pub fn rest(&self) -> &'a [u8] {
        self.bytes
    }

    /// Returns the next byte, or 0 if no bytes are left.
    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        first
    }

    /// Returns the last byte, or 0 if no bytes are left.
    pub fn from_end(&mut self) -> u8 {
        let Some((&last, rest)) = self.bytes.split_last() else { return 0 };
        self.bytes = rest;
        last
    }

    /// Returns a number below `bound`. The bound must be between 1 and 65536.
    pub fn below(&mut self, bound: usize) -> usize {
        let high = if bound > 256 { usize::from(self.byte()) << 8 } else { 0 };
        (high | usize::from(self.byte())) % bound
    }

    /// Returns `true` once in `times` cases on average.
    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == times - 1
    }

    /// Returns one of the options.
    pub fn pick<T: Copy>(&mut self, options: &[T]) -> T {
        options[self.below(options.len())]
    }
}

/// Returns random bytes, for tests without a fuzzer.
pub fn random_bytes(sampler: &mut Sampler, length: usize) -> Vec<u8> {
    (0..length).map(|_| sampler.below(256) as u8).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decisions_from_both_ends() {
        let mut choices = Choices::new(&[7, 1, 2, 9]);
        assert_eq!((choices.below(4), choices.from_end()), (3, 9));
        assert_eq!(choices.below(1000), 258);
        assert!(choices.is_empty() && !choices.once_in(3));
        assert_eq!(choices.pick(&["first", "second"]), "first");
    }
}
