//! Connects to a model according to the user's options.

use super::cache::Cache;
use super::chat::{Decoding, Model};
use super::clock::{Clock, SystemClock};
use super::http::HttpClient;
use super::key::{Key, environment};
use super::options::ModelOptions;
use super::pace::Pace;
use super::provider::Provider;
use super::remote::Remote;
use super::spec::ModelSpec;
use super::spending::caps::Caps;
use super::spending::prices::{Price, Prices};
use crate::error::EvaluationError;
use base::Digest;
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// A model ready to answer requests.
pub struct Connection {
    /// The model, shareable between threads.
    pub model: Box<dyn Model>,
    /// The spending limits and the amounts spent so far.
    pub caps: Arc<Caps>,
    /// The part of the configuration saved with the results.
    pub settings: ModelSettings,
    /// The price of the model's tokens, if known.
    pub price: Option<Price>,
}

/// The part of the configuration that affects answers and is stored with the results. Caps, rates, tries and
/// the cache do not affect answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelSettings {
    /// The server's API.
    pub provider: Provider,
    /// The server's host, with the port if the URL contains one.
    pub server: String,
    /// The server's name for the model.
    pub model: String,
    /// The sampling settings for answers, including settings that the provider requires. All requests must use
    /// exactly these settings.
    pub decoding: Decoding,
}

impl ModelSettings {
    /// Returns a digest of the settings. Distinct settings have distinct digests.
    pub fn digest(&self) -> Digest {
        Digest::of(&serde_json::to_vec(self).expect("settings are plain data"))
    }
}

/// Returns the settings for the given options. Opens no connection and needs no key, so dry runs can use it.
///
/// # Errors
/// Returns an error if the options are malformed, or use a feature that the provider does not support.
pub fn settings(options: &ModelOptions) -> Result<ModelSettings, EvaluationError> {
    let spec = ModelSpec::parse(&options.model, options.base_url.as_deref())?;
    let decoding = spec.provider.decoding(&options.decoding)?;
    check_variable(options.key_variable.as_deref())?;
    Ok(ModelSettings { provider: spec.provider, server: spec.server.host, model: spec.model, decoding })
}

/// Returns the price of the model's tokens, if listed in a price table.
///
/// # Errors
/// Returns an error if the options are malformed, the table cannot be used, or a cap on the cost cannot be
/// enforced because the price is unknown.
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

/// Creates the model for the given options. Sends nothing: only the first request shows whether the server
/// responds.
///
/// # Errors
/// Returns an error if the options are malformed, a key is missing, or a file or folder cannot be accessed.
pub fn connect(options: &ModelOptions) -> Result<Connection, EvaluationError> {
    connect_with(options, &environment, Arc::new(SystemClock::start()))
}

/// Connects like [`connect`], but with an explicit environment and clock, so that tests need neither keys nor
/// real time.
///
/// # Errors
/// Returns an error in the same cases as [`connect`].
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
        http: HttpClient::new(&spec.server, options),
        pace: Pace::new(options, clock.clone()),
        cache: options.cache.as_deref().map(Cache::open).transpose()?,
        caps: caps.clone(),
        tries: options.tries,
        is_reached: AtomicBool::new(false),
        on_failure: options.on_failure.clone(),
        reported: Mutex::default(),
        spec,
        key,
        clock,
    };
    Ok(Connection { model: Box::new(remote), caps, settings, price })
}

/// Rejects invalid variable names. The error message does not repeat the value, because the value may be the
/// key itself.
fn check_variable(name: Option<&str>) -> Result<(), EvaluationError> {
    let is_name = |name: &str| {
        let plain = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        name.chars().all(plain) && name.starts_with(|c: char| !c.is_ascii_digit())
    };
    if name.is_none_or(is_name) {
        return Ok(());
    }
    let problem = "--key-variable takes the name of an environment variable, which consists of capital \
                   letters, digits and `_`, such as `MY_API_KEY`; export the key under that name, and never \
                   put the key itself on the command line";
    Err(EvaluationError::Malformed(problem.to_owned()))
}

/// Returns the key to send. Servers on this machine, and servers reached over unencrypted connections, get a
/// key only if the user specifies the variable.
fn key(
    options: &ModelOptions,
    spec: &ModelSpec,
    environment: &dyn Fn(&str) -> Option<String>,
) -> Result<Option<Key>, EvaluationError> {
    let usual = spec.provider.key_variable();
    let wanted = |variable: &str| {
        let key = Key::read(variable, environment)?;
        let problem = format!(
            "{} requires a key, but {variable} is not set; export the key under that name",
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
        capped.limits.cost = super::super::spending::prices::Usd::from_dollars(1.0);
        assert!(problem(&capped, &all_keys).contains("name = \"gpt-99\""));
        for pasted in ["sk-ZEBRA123", "zebra", "", "1ZEBRA"] {
            let named =
                ModelOptions { key_variable: Some(pasted.to_owned()), ..ModelOptions::new("gemini:m") };
            let told = problem(&named, &all_keys);
            assert!(told.contains("--key-variable takes the name") && !told.to_lowercase().contains("zebra"));
        }
        let mut seeded = ModelOptions::new("anthropic:m");
        seeded.decoding.seed = Some(1);
        assert!(problem(&seeded, &all_keys).contains("does not support a sampling seed"));
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
