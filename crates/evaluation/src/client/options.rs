//! The user's options for a model.

use super::chat::Decoding;
use super::spending::caps::Limits;
use std::fmt;
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

base::with_defaults! {
    /// The user's options for a model. The options contain no API key, because keys are read from the
    /// environment.
    #[derive(Clone, Debug)]
    pub struct ModelOptions {
        /// The model: `openai:…`, `anthropic:…`, `gemini:…` or, if a base URL is set, any name.
        pub model: String = String::new(),
        /// The server's base URL, if different from the provider's own.
        pub base_url: Option<String> = None,
        /// The name of the environment variable that contains the key, if different from the provider's
        /// default.
        pub key_variable: Option<String> = None,
        /// The sampling settings for answers.
        pub decoding: Decoding = Decoding::default(),
        /// The spending caps.
        pub limits: Limits = Limits::default(),
        /// A price table that takes precedence over the embedded one.
        pub prices: Option<PathBuf> = None,
        /// The response cache's folder, if caching is enabled.
        pub cache: Option<PathBuf> = None,
        /// The maximum number of concurrent requests.
        pub concurrency: NonZeroUsize = NonZeroUsize::new(4).expect("not zero"),
        /// The maximum number of requests started per minute.
        pub requests_per_minute: Option<NonZeroU64> = None,
        /// The maximum number of tokens per minute, counting requests and replies.
        pub tokens_per_minute: Option<NonZeroU64> = None,
        /// The maximum number of tries per request.
        pub tries: NonZeroU32 = NonZeroU32::new(8).expect("not zero"),
        /// The time limit for one complete try.
        pub timeout: Duration = Duration::from_secs(600),
        /// The time limit for opening a connection.
        pub connect_timeout: Duration = Duration::from_secs(10),
        /// The maximum size of a reply, in bytes.
        pub reply_limit: u64 = 4 << 20,
        /// The function that reports failed tries at once.
        pub on_failure: Option<OnFailure> = None,
    }
}

/// A function that shows a message about a failed try to the user. Threads may call it at the same time.
#[derive(Clone)]
pub struct OnFailure(pub Arc<dyn Fn(&str) + Send + Sync>);

impl fmt::Debug for OnFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OnFailure")
    }
}

impl ModelOptions {
    /// Creates a model's options with default settings: four concurrent requests, eight tries, ten minutes
    /// per try, ten seconds to connect, replies of up to 4 MiB, no caps, and no cache.
    pub fn new(model: &str) -> ModelOptions {
        ModelOptions { model: model.to_owned(), ..ModelOptions::default() }
    }
}
