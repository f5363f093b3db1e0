//! Connecting to a model with the user's options.

use super::cache::Cache;
use super::caps::{Caps, Limits};
use super::chat::{Decoding, Model};
use super::clock::{Clock, SystemClock};
use super::key::{Key, environment};
use super::pace::Pace;
use super::prices::{Price, Prices};
use super::provider::Provider;
use super::remote::Remote;
use super::spec::ModelSpec;
use super::wire::Wire;
use crate::error::EvaluationError;
use base::Digest;
use serde::{Deserialize, Serialize};
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

base::with_defaults! {
    /// The user's options for a model. They contain no API key, because keys are read from the environment.
    #[derive(Clone, Debug)]
    pub struct ModelOptions {
        /// The model: `openai:…`, `anthropic:…`, `gemini:…`, or any name with a base URL.
        pub model: String = String::new(),
        /// The server's base URL, if it is not the provider's own.
        pub base_url: Option<String> = None,
        /// The name of the environment variable that holds the key, if it is not the provider's default.
        pub key_variable: Option<String> = None,
        /// The sampling settings for answers.
        pub decoding: Decoding = Decoding::default(),
        /// The caps on spending.
        pub limits: Limits = Limits::default(),
        /// A table of prices that takes precedence over the embedded one.
        pub prices: Option<PathBuf> = None,
        /// The folder of the response cache, if enabled.
        pub cache: Option<PathBuf> = None,
        /// The maximum number of concurrent requests.
        pub concurrency: NonZeroUsize = NonZeroUsize::new(4).expect("not zero"),
        /// The maximum number of requests started per minute.
        pub requests_per_minute: Option<NonZeroU64> = None,
        /// The maximum number of tokens per minute, in requests and replies.
        pub tokens_per_minute: Option<NonZeroU64> = None,
        /// The maximum number of tries per request.
        pub tries: NonZeroU32 = NonZeroU32::new(8).expect("not zero"),
        /// The time limit for one try, from the first byte to the last.
        pub timeout: Duration = Duration::from_secs(600),
        /// The time limit for opening a connection.
        pub connect_timeout: Duration = Duration::from_secs(10),
        /// The maximum size of a reply, in bytes.
        pub reply_limit: u64 = 4 << 20,
    }
}

impl ModelOptions {
    /// Creates the options for a model, with defaults for everything else: four concurrent requests, eight tries, ten
    /// minutes per try and ten seconds for its connection, replies of up to 4 MiB, no caps, and no cache.
    pub fn new(model: &str) -> ModelOptions {
        ModelOptions { model: model.to_owned(), ..ModelOptions::default() }
    }
}

/// A model that is ready to answer.
pub struct Connection {
    /// The model. It may be shared by all threads.
    pub model: Box<dyn Model>,
    /// The amounts spent so far, and the limits.
    pub caps: Arc<Caps>,
    /// The part of the configuration that is stored with the results.
    pub settings: ModelSettings,
    /// The price of the model's tokens, if it is known.
    pub price: Option<Price>,
}

/// The part of the configuration that affects the answers and is stored with the results. Caps, rates, tries and the cache
/// do not affect them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelSettings {
    /// The API.
    pub provider: Provider,
    /// The host of the server, including the port if one is given.
    pub server: String,
    /// The name that the server uses for the model.
    pub model: String,
    /// The sampling settings for answers, including the ones that the provider requires. Requests must use them.
    pub decoding: Decoding,
}

impl ModelSettings {
    /// Returns a digest that distinguishes settings.
    pub fn digest(&self) -> Digest {
        Digest::of(&serde_json::to_vec(self).expect("settings are plain data"))
    }
}

/// Returns the settings for these options. It opens no connection and needs no key, so dry runs can use it too.
///
/// # Errors
/// Returns an error if the options are malformed, or use a feature that the provider does not have.
pub fn settings(options: &ModelOptions) -> Result<ModelSettings, EvaluationError> {
    let spec = ModelSpec::parse(&options.model, options.base_url.as_deref())?;
    let decoding = spec.provider.decoding(&options.decoding)?;
    check_variable(options.key_variable.as_deref())?;
    Ok(ModelSettings { provider: spec.provider, server: spec.server.host, model: spec.model, decoding })
}

/// Returns the price of the model's tokens, if a table contains it.
///
/// # Errors
/// Returns an error if the options are malformed, the table cannot be used, or a cap on the cost cannot be enforced
/// because the price is unknown.
pub fn price(options: &ModelOptions) -> Result<Option<Price>, EvaluationError> {
    let spec = ModelSpec::parse(&options.model, options.base_url.as_deref())?;
    let prices = options.prices.as_deref().map_or_else(|| Ok(Prices::embedded()), Prices::with_file)?;
    let price = prices.find(spec.provider, &spec.model);
    if options.limits.cost.is_some() && price.is_none() {
        let (provider, model) = (spec.provider.name(), &spec.model);
        let problem = format!(
            "--max-cost needs a price, but no price is known for `{model}`; add the price with --prices FILE \
             (provider = \"{provider}\", name = \"{model}\"), or use --max-tokens"
        );
        return Err(EvaluationError::Malformed(problem));
    }
    Ok(price)
}

/// Creates the model for these options. Nothing is sent yet, so only the first request shows whether the server
/// answers.
///
/// # Errors
/// Returns an error if the options are malformed, a key is missing, or a file or folder cannot be accessed.
pub fn connect(options: &ModelOptions) -> Result<Connection, EvaluationError> {
    connect_with(options, &environment, Arc::new(SystemClock::start()))
}

/// Connects like [`connect`], with the given environment and clock, for tests without keys and real time.
///
/// # Errors
/// See [`connect`].
pub fn connect_with(
    options: &ModelOptions,
    environment: &dyn Fn(&str) -> Option<String>,
    clock: Arc<dyn Clock>,
) -> Result<Connection, EvaluationError> {
    let (settings, price) = (settings(options)?, price(options)?);
    let spec = ModelSpec::parse(&options.model, options.base_url.as_deref())?;
    let key = key(options, &spec, environment)?;
    let caps = Arc::new(Caps::new(options.limits, price.clone()));
    let remote = Remote {
        wire: Wire::new(&spec.server, options),
        pace: Pace::new(options, clock.clone()),
        cache: options.cache.as_deref().map(Cache::open).transpose()?,
        caps: caps.clone(),
        tries: options.tries,
        spec,
        key,
        clock,
    };
    Ok(Connection { model: Box::new(remote), caps, settings, price })
}

/// Rejects anything that is not a variable name, without repeating it, because it may be the key itself.
fn check_variable(name: Option<&str>) -> Result<(), EvaluationError> {
    let is_name = |name: &str| {
        let plain = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        name.chars().all(plain) && name.starts_with(|c: char| !c.is_ascii_digit())
    };
    if name.is_none_or(is_name) {
        return Ok(());
    }
    let problem = "--key-variable takes the name of an environment variable, in capitals, digits and `_`, such as \
                   `MY_API_KEY`; export the key under that name, and never put the key itself on the command line";
    Err(EvaluationError::Malformed(problem.to_owned()))
}

/// Returns the key to send. Unless the user specifies the variable, a server on this machine gets no key, and no
/// other server gets one unencrypted.
fn key(
    options: &ModelOptions,
    spec: &ModelSpec,
    environment: &dyn Fn(&str) -> Option<String>,
) -> Result<Option<Key>, EvaluationError> {
    let usual = spec.provider.key_variable();
    let wanted = |variable: &str| {
        let key = Key::read(variable, environment)?;
        let problem = format!(
            "{} requires a key, but {variable} is not set; export the key under that \
                               name",
            spec.server.host
        );
        key.map(Some).ok_or(EvaluationError::Malformed(problem))
    };
    match &options.key_variable {
        Some(variable) => wanted(variable),
        None if spec.server.loopback || !spec.server.encrypted => Ok(None),
        None if spec.server.own => wanted(usual),
        None => Key::read(usual, environment),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_keys(variable: &str) -> Option<String> {
        variable.ends_with("_API_KEY").then(|| format!("zebra-{variable}"))
    }

    fn sent(model: &str, base_url: Option<&str>, named: Option<&str>) -> Option<String> {
        let options = ModelOptions { key_variable: named.map(str::to_owned), ..ModelOptions::new(model) };
        let spec = ModelSpec::parse(model, base_url).unwrap();
        key(&options, &spec, &all_keys).unwrap().map(|key| key.variable)
    }

    #[test]
    fn keys_are_sent_to_their_provider_only() {
        let variable = |name: &str| Some(name.to_owned());
        assert_eq!(sent("openai:m", None, None), variable("OPENAI_API_KEY"));
        assert_eq!(sent("anthropic:m", None, None), variable("ANTHROPIC_API_KEY"));
        assert_eq!(sent("gemini:m", None, None), variable("GEMINI_API_KEY"));
        assert_eq!(sent("m", Some("https://example.org/v1"), None), variable("OPENAI_API_KEY"));
        assert_eq!(sent("m", Some("http://example.org/v1"), None), None, "not in the clear");
        assert_eq!(sent("m", Some("http://localhost:8000/v1"), None), None);
        assert_eq!(sent("openai:m", Some("http://127.0.0.1:1/v1"), None), None);
        assert_eq!(sent("m", Some("http://localhost:8000/v1"), Some("MY_API_KEY")), variable("MY_API_KEY"));
    }

    fn problem(options: &ModelOptions, environment: &dyn Fn(&str) -> Option<String>) -> String {
        let connection = connect_with(options, environment, Arc::new(SystemClock::start()));
        connection.err().expect("it cannot be connected").to_string()
    }

    #[test]
    fn missing_settings_are_named() {
        let nothing = |_: &str| None;
        assert!(problem(&ModelOptions::new("openai:m"), &nothing).contains("OPENAI_API_KEY is not set"));
        let named = ModelOptions { key_variable: Some("MINE".to_owned()), ..ModelOptions::new("gemini:m") };
        assert!(problem(&named, &all_keys).contains("MINE is not set"));
        let mut capped = ModelOptions::new("openai:gpt-99");
        capped.limits.cost = super::super::prices::Usd::from_dollars(1.0);
        assert!(problem(&capped, &all_keys).contains("name = \"gpt-99\""));
        for pasted in ["sk-ZEBRA123", "zebra", "", "1ZEBRA"] {
            let named =
                ModelOptions { key_variable: Some(pasted.to_owned()), ..ModelOptions::new("gemini:m") };
            let told = problem(&named, &all_keys);
            assert!(told.contains("--key-variable takes the name") && !told.to_lowercase().contains("zebra"));
        }
        let mut seeded = ModelOptions::new("anthropic:m");
        seeded.decoding.seed = Some(1);
        assert!(problem(&seeded, &all_keys).contains("no sampling seed"));
    }

    #[test]
    fn settings_record_the_decoding_sent() {
        let mut options = ModelOptions::new("anthropic:claude-sonnet-4-5-20250929");
        let found = settings(&options).unwrap();
        assert_eq!(found.decoding.max_output_tokens, Some(8192));
        assert_eq!(found.server, "api.anthropic.com");
        assert_eq!(price(&options).unwrap().unwrap().output, 15.0);
        let text = serde_json::to_string(&found).unwrap();
        let back: ModelSettings = serde_json::from_str(&text).unwrap();
        assert_eq!((back.digest(), &back), (found.digest(), &found));
        options.decoding.temperature = Some(0.5);
        assert_ne!(settings(&options).unwrap().digest(), found.digest());
    }
}
