//! How long a text is for a language model.

use crate::answer::boundary;
use tiktoken_rs::o200k_base_singleton;

/// Tokens that the frame of a message takes beside its words, as providers count them: about this many.
pub const PER_MESSAGE: u64 = 4;

/// Bytes that are counted at once: the tables know no longer token, and a text without blanks, cut at these places, costs
/// no more than one with.
const PIECE: usize = 4096;

/// Tokens of a text in the vocabulary `o200k_base`, which is built in. Every family of models has its own; others come to
/// within some 20 % of it. Words that look like control tokens are counted as words. Cost: O(bytes); the first call in a
/// process reads the vocabulary, some 0.2 s.
pub fn count(text: &str) -> u64 {
    let vocabulary = o200k_base_singleton();
    let mut rest = text;
    let mut tokens = 0;
    while !rest.is_empty() {
        let window = &rest[..boundary(rest, PIECE)];
        // Best cut before a line or a word, so that the count is what it would be in one go.
        let cut = window.rfind('\n').map(|at| at + 1).or_else(|| window.rfind(' ')).filter(|&at| at > 0);
        let piece = if window.len() == rest.len() { rest } else { &rest[..cut.unwrap_or(window.len())] };
        tokens += vocabulary.encode_ordinary(piece).len() as u64;
        rest = &rest[piece.len()..];
    }
    tokens
}

/// About how many tokens a picture of this size is worth: a patch of 28 × 28 pixels is one.
pub fn of_picture(width: u32, height: u32) -> u64 {
    u64::from(width.div_ceil(28)) * u64::from(height.div_ceil(28))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_all_kinds() {
        assert_eq!(count(""), 0);
        assert_eq!(count("left"), 1);
        assert_eq!(count("You win when no lantern is left."), 8);
        assert!(count("<|endoftext|>") > 1, "no control token");
        let long = "wander ".repeat(200_000);
        assert_eq!(
            count(&long),
            count("wander ") * 200_000 - 199_999 * (count("wander ") - count(" wander"))
        );
        assert!(count(&"x".repeat(1_000_000)) > 10_000);
        assert!(count(&"é".repeat(100_001)) > 1000);
    }
}
