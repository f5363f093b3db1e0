//! The flags for language models, shared by all subcommands that use models.

use crate::failure::Failure;
use crate::flags::numbers::number;
use evaluation::client::{Decoding, Limits, ModelOptions, Usd};
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::time::Duration;

/// The model, its requests, and the limits on their cost.
#[derive(clap::Args)]
#[command(next_help_heading = "Language models")]
pub(crate) struct ClientArgs {
    /// A language model: `openai:ID`, `anthropic:ID` or `gemini:ID`, or any name with --base-url (see `arcade docs
    /// models`)
    #[arg(long, value_name = "ID")]
    pub(crate) model: Option<String>,
    /// Base URL of an OpenAI-compatible server, such as vLLM, llama.cpp, Ollama or `arcade serve-player`
    #[arg(long, value_name = "URL", requires = "model")]
    base_url: Option<String>,
    /// The environment variable with the API key, if it is not the provider's usual one
    #[arg(long, value_name = "VARIABLE", requires = "model")]
    key_variable: Option<String>,
    /// Sampling temperature; not sent by default
    #[arg(long, value_name = "T", requires = "model", value_parser = number(0.0..=2.0))]
    temperature: Option<f64>,
    /// Nucleus sampling threshold; not sent by default
    #[arg(long, value_name = "P", requires = "model", value_parser = number(0.0..=1.0))]
    top_p: Option<f64>,
    /// Maximum number of tokens per answer, including reasoning (see `arcade docs evaluate`)
    #[arg(long, value_name = "N")]
    max_output_tokens: Option<NonZeroU32>,
    /// The provider's sampling seed
    #[arg(long, value_name = "N", requires = "model")]
    sampling_seed: Option<u64>,
    /// `low`, `medium`, `high`, or another value that the provider accepts
    #[arg(long, value_name = "EFFORT", requires = "model")]
    reasoning_effort: Option<String>,
    /// Maximum amount to spend in US dollars, according to the price table
    #[arg(long, value_name = "USD", requires = "model", value_parser = number(0.0..=1e9))]
    max_cost: Option<f64>,
    /// Maximum number of tokens to spend on prompts and answers together
    #[arg(long, value_name = "N", requires = "model")]
    max_tokens: Option<u64>,
    /// Maximum number of answered requests
    #[arg(long, value_name = "N", requires = "model")]
    max_requests: Option<u64>,
    /// TOML file with prices that override the embedded ones
    #[arg(long, value_name = "FILE", requires = "model")]
    prices: Option<PathBuf>,
    /// Folder for an answer cache, which is kept between evaluations
    #[arg(long, value_name = "DIR", requires = "model")]
    cache: Option<PathBuf>,
    /// Number of concurrent requests, and therefore of concurrent episodes [default: 4]
    #[arg(long, value_name = "N", requires = "model")]
    concurrency: Option<NonZeroUsize>,
    /// Maximum number of requests to start per minute
    #[arg(long, value_name = "N", requires = "model")]
    requests_per_minute: Option<NonZeroU64>,
    /// Maximum number of tokens per minute in requests and answers together
    #[arg(long, value_name = "N", requires = "model")]
    tokens_per_minute: Option<NonZeroU64>,
    /// Maximum number of tries per request [default: 8]
    #[arg(long, value_name = "N", requires = "model")]
    tries: Option<NonZeroU32>,
    /// Maximum number of seconds per try, or per answer from a program [default: 600]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..), allow_negative_numbers = true)]
    pub(crate) timeout: Option<u64>,
}

/// Default values of flags that are rejected for players that they do not affect.
const CONCURRENCY: NonZeroUsize = NonZeroUsize::new(4).expect("the default is positive");
const TRIES: NonZeroU32 = NonZeroU32::new(8).expect("the default is positive");
const TIMEOUT: u64 = 600;

impl ClientArgs {
    /// Returns the maximum number of output tokens per answer, if the user set it.
    pub(crate) fn max_output_tokens(&self) -> Option<u32> {
        self.max_output_tokens.map(NonZeroU32::get)
    }

    /// Returns the first flag set by the user that affects only language models, if any. `is_limited` is `true` for
    /// a player that accepts a limit on its output tokens although it is not a model.
    pub(crate) fn unused_without_model(&self, is_limited: bool) -> Option<&'static str> {
        let given = [
            ("--base-url", self.base_url.is_some()),
            ("--key-variable", self.key_variable.is_some()),
            ("--temperature", self.temperature.is_some()),
            ("--top-p", self.top_p.is_some()),
            ("--max-output-tokens", self.max_output_tokens.is_some() && !is_limited),
            ("--sampling-seed", self.sampling_seed.is_some()),
            ("--reasoning-effort", self.reasoning_effort.is_some()),
            ("--max-cost", self.max_cost.is_some()),
            ("--max-tokens", self.max_tokens.is_some()),
            ("--max-requests", self.max_requests.is_some()),
            ("--prices", self.prices.is_some()),
            ("--cache", self.cache.is_some()),
            ("--requests-per-minute", self.requests_per_minute.is_some()),
            ("--tokens-per-minute", self.tokens_per_minute.is_some()),
            ("--concurrency", self.concurrency.is_some()),
            ("--tries", self.tries.is_some()),
        ];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// Returns `true` if the user set the number of concurrent requests.
    pub(crate) fn has_concurrency(&self) -> bool {
        self.concurrency.is_some()
    }

    /// Returns the number of concurrent requests.
    pub(crate) fn concurrency(&self) -> NonZeroUsize {
        self.concurrency.unwrap_or(CONCURRENCY)
    }

    /// Returns the time limit for a single try, or for a program's answer.
    pub(crate) fn timeout(&self) -> Duration {
        Duration::from_secs(self.timeout.unwrap_or(TIMEOUT))
    }

    /// Returns the options of the client for the given model.
    pub(crate) fn options(&self, model: &str) -> Result<ModelOptions, Failure> {
        let cost = |dollars: f64| {
            Usd::from_dollars(dollars)
                .ok_or_else(|| malformed!("--max-cost takes an amount in US dollars, not {dollars}"))
        };
        let cost = self.max_cost.map(cost).transpose()?;
        Ok(ModelOptions {
            base_url: self.base_url.clone(),
            key_variable: self.key_variable.clone(),
            decoding: Decoding {
                temperature: self.temperature,
                top_p: self.top_p,
                max_output_tokens: self.max_output_tokens(),
                seed: self.sampling_seed,
                reasoning_effort: self.reasoning_effort.clone(),
            },
            limits: Limits { cost, tokens: self.max_tokens, requests: self.max_requests },
            prices: self.prices.clone(),
            cache: self.cache.clone(),
            concurrency: self.concurrency(),
            requests_per_minute: self.requests_per_minute,
            tokens_per_minute: self.tokens_per_minute,
            tries: self.tries.unwrap_or(TRIES),
            timeout: self.timeout(),
            ..ModelOptions::new(model)
        })
    }
}
