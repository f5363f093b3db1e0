//! Estimates the tokens and costs of requests before they are sent.

use super::prices::{Price, Usd};
use crate::client::chat::{ChatMessage, ChatRequest, Usage};
use crate::tokens;

/// The token count assumed for an image whose size cannot be read.
const PICTURE: u64 = 1000;

/// Estimates the number of tokens in a request's prompt. A local count is only an estimate, because models
/// have different vocabularies.
pub(in crate::client) fn prompt_tokens(request: &ChatRequest) -> u64 {
    let picture =
        |png: &Vec<u8>| size(png).map_or(PICTURE, |(width, height)| tokens::of_picture(width, height));
    let message = |message: &ChatMessage| {
        tokens::count(&message.text) + tokens::PER_MESSAGE + message.image.as_ref().map_or(0, picture)
    };
    request.messages.iter().map(message).sum()
}

/// Returns the width and height of a PNG image, read from the image's first chunk; `None` if there are too few bytes.
fn size(png: &[u8]) -> Option<(u32, u32)> {
    let word = |at: usize| Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?));
    Some((word(16)?, word(20)?))
}

/// A group of expected requests whose prompts share a prefix, such as all requests in an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batch {
    /// The number of requests.
    pub requests: u64,
    /// The number of tokens in the prefix common to all prompts.
    pub stable_tokens: u64,
    /// The average number of tokens per prompt after the common prefix.
    pub changing_tokens: u64,
    /// The average number of tokens per answer, including reasoning.
    pub output_tokens: u64,
}

/// The estimate for an entire evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// The number of requests, assuming that none is repeated.
    pub requests: u64,
    /// The number of tokens in all prompts.
    pub input_tokens: u64,
    /// The maximum number of prompt tokens that the provider's cache can serve. In each batch, these are the
    /// common prefixes of all requests except the first.
    pub cacheable_tokens: u64,
    /// The number of tokens in all answers.
    pub output_tokens: u64,
    /// The cost if the provider's cache is never used, or `None` if the price is unknown.
    pub cost: Option<Usd>,
    /// The cost if the provider's cache is used as much as possible, or `None` if the price is unknown.
    pub cost_if_cached: Option<Usd>,
}

impl Estimate {
    /// Estimates the tokens and costs of the given batches of requests.
    pub fn of(batches: &[Batch], price: Option<&Price>) -> Estimate {
        let mut all = Estimate::default();
        let mut written = 0u64;
        for batch in batches {
            let input =
                batch.stable_tokens.saturating_add(batch.changing_tokens).saturating_mul(batch.requests);
            let cacheable = batch.stable_tokens.saturating_mul(batch.requests.saturating_sub(1));
            all.requests = all.requests.saturating_add(batch.requests);
            all.input_tokens = all.input_tokens.saturating_add(input);
            all.cacheable_tokens = all.cacheable_tokens.saturating_add(cacheable);
            all.output_tokens =
                all.output_tokens.saturating_add(batch.output_tokens.saturating_mul(batch.requests));
            written = written.saturating_add(if batch.requests > 0 { batch.stable_tokens } else { 0 });
        }
        let plain = Usage {
            input_tokens: Some(all.input_tokens),
            output_tokens: Some(all.output_tokens),
            ..Usage::default()
        };
        let cached = Usage {
            cached_input_tokens: Some(all.cacheable_tokens),
            cache_write_tokens: Some(written),
            ..plain
        };
        all.cost = price.and_then(|price| price.cost(&plain));
        all.cost_if_cached = price.and_then(|price| price.cost(&cached));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::chat::{Decoding, Role};

    #[test]
    fn two_episodes() {
        let price =
            Price { input: 2.0, cached_input: 0.2, cache_write: 2.5, output: 10.0, as_of: String::new() };
        let episode = Batch { requests: 100, stable_tokens: 1000, changing_tokens: 200, output_tokens: 50 };
        let shorter = Batch { requests: 10, ..episode };
        let estimate = Estimate::of(&[episode, shorter], Some(&price));
        assert_eq!((estimate.requests, estimate.input_tokens), (110, 132_000));
        assert_eq!((estimate.cacheable_tokens, estimate.output_tokens), (108_000, 5_500));
        let output = 0.055;
        assert_eq!(estimate.cost, Usd::from_dollars(0.264 + output));
        assert_eq!(
            estimate.cost_if_cached,
            Usd::from_dollars(0.108 * 0.2 + 0.002 * 2.5 + 0.022 * 2.0 + output)
        );
        let unpriced = Estimate::of(&[episode, shorter], None);
        assert_eq!((unpriced.cost, unpriced.input_tokens), (None, 132_000));
        assert_eq!(Estimate::of(&[], None), Estimate::default());
    }

    #[test]
    fn prompts_with_pictures() {
        let png =
            [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..], &280u32.to_be_bytes(), &56u32.to_be_bytes()].concat();
        let prompt = |image: Option<Vec<u8>>| {
            let messages = vec![ChatMessage { role: Role::User, text: "left".to_owned(), image }];
            let sample = base::Seed::from_text("x");
            prompt_tokens(&ChatRequest { messages, decoding: Decoding::default(), sample })
        };
        assert_eq!(prompt(None), 1 + tokens::PER_MESSAGE);
        assert_eq!(prompt(Some(png)), prompt(None) + 20);
        assert_eq!(prompt(Some(Vec::new())), prompt(None) + PICTURE);
    }
}
