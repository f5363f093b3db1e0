//! Counts tokens in texts.

use crate::answer::boundary;
use tiktoken_rs::o200k_base_singleton;

/// The approximate number of tokens that providers count per message in addition to its text.
pub const PER_MESSAGE: u64 = 4;

/// The number of bytes counted at a time. No token in the vocabulary is longer. The limit keeps texts without
/// spaces as cheap to count as other texts.
const PIECE: usize = 4096;

/// Counts a text's tokens in the embedded vocabulary `o200k_base`.
///
/// Every model family has its own vocabulary. Its counts are within about 20% of the returned count. Text
/// that looks like control tokens is counted as ordinary text. Cost: O(bytes). The first call in a process
/// loads the vocabulary, which takes about 0.2 s.
pub fn count(text: &str) -> u64 {
    let vocabulary = o200k_base_singleton();
    let mut rest = text;
    let mut tokens = 0;
    while !rest.is_empty() {
        let window = &rest[..boundary(rest, PIECE)];
        // If possible, the text is cut before a line or a word, so that the count equals that of the uncut
        // text.
        let cut = window.rfind('\n').map(|at| at + 1).or_else(|| window.rfind(' ')).filter(|&at| at > 0);
        let piece = if window.len() == rest.len() { rest } else { &rest[..cut.unwrap_or(window.len())] };
        tokens += vocabulary.encode_ordinary(piece).len() as u64;
        rest = &rest[piece.len()..];
    }
    tokens
}

/// Estimates the number of tokens for an image of the given size: one token per 28 × 28 pixel patch.
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
