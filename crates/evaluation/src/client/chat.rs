//! Requests to a model, and its answers.

use base::Seed;
use serde::{Deserialize, Serialize};

/// A language model that answers chats.
pub trait Model: Sync + Send {
    /// Requests one answer. Retries after transient failures, and returns the failure of each try.
    ///
    /// # Errors
    /// No answer could be obtained: see [`ChatErrorKind`].
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError>;
}

/// A request to a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChatRequest {
    /// The conversation, the oldest message first: an optional system message, then user and assistant in turn.
    pub messages: Vec<ChatMessage>,
    /// The sampling of the answer.
    pub decoding: Decoding,
    /// The seed of this draw. Equal requests that need independent answers have different seeds, for example derived from
    /// the episode's seed, run, step and attempt. It determines the jitter of waits and, unless the temperature is 0, the
    /// answer taken from the cache; it is not sent.
    pub sample: Seed,
}

/// A message of a conversation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChatMessage {
    /// The author.
    pub role: Role,
    /// The text.
    pub text: String,
    /// A picture beside the text, PNG.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<Vec<u8>>,
}

/// The author of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The instructions of the conversation.
    System,
    /// The client.
    User,
    /// The model.
    Assistant,
}

/// The sampling of an answer. `None` is not sent, so that the provider's default applies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decoding {
    /// Sampling temperature.
    pub temperature: Option<f64>,
    /// Nucleus sampling.
    pub top_p: Option<f64>,
    /// The maximum number of tokens of the answer, reasoning included.
    pub max_output_tokens: Option<u32>,
    /// The provider's sampling seed.
    pub seed: Option<u64>,
    /// `low`, `medium`, `high`, or another value of the provider.
    pub reasoning_effort: Option<String>,
}

/// A model's answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ChatReply {
    /// The text.
    pub text: String,
    /// The reasoning, if the provider returns it.
    pub reasoning: Option<String>,
    /// The reason why the answer ends.
    pub finish: Finish,
    /// The tokens used.
    pub usage: Usage,
    /// The model that answered, as the provider calls it.
    pub served_by: Option<String>,
    /// The failed tries before this one.
    pub failures: Vec<Failure>,
    /// The time from the request to the complete answer, without earlier tries and waits, ms.
    pub latency_ms: f64,
    /// `true` if the answer comes from the cache and cost nothing.
    pub cached: bool,
}

impl ChatReply {
    /// Creates an answer of which nothing else is known.
    pub fn new(text: String, finish: Finish) -> ChatReply {
        ChatReply { text, finish, ..ChatReply::default() }
    }
}

/// The reason why an answer ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// It is complete.
    Stop,
    /// The token limit was reached.
    Length,
    /// The model or its provider declined (content filter, refusal).
    Refusal,
    /// Another reason of the provider, or none.
    #[default]
    Other,
}

/// Tokens as the provider counts them. Unreported counts are `None`, never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Usage {
    /// The tokens of the prompt, cached ones included.
    pub input_tokens: Option<u64>,
    /// The part read from the provider's prefix cache.
    pub cached_input_tokens: Option<u64>,
    /// The part written to the provider's prefix cache, if that costs more than reading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cache_write_tokens: Option<u64>,
    /// The tokens of the answer, reasoning included.
    pub output_tokens: Option<u64>,
    /// The part used for reasoning.
    pub reasoning_tokens: Option<u64>,
}

/// The largest plausible token count of one request; no context window comes near it.
const MAX_PLAUSIBLE_TOKENS: u64 = 1 << 40;

impl Usage {
    /// Removes implausible counts, which are then replaced by our own.
    pub(super) fn plausible(self) -> Usage {
        let plausible = |count: Option<u64>| count.filter(|&tokens| tokens <= MAX_PLAUSIBLE_TOKENS);
        Usage {
            input_tokens: plausible(self.input_tokens),
            cached_input_tokens: plausible(self.cached_input_tokens),
            cache_write_tokens: plausible(self.cache_write_tokens),
            output_tokens: plausible(self.output_tokens),
            reasoning_tokens: plausible(self.reasoning_tokens),
        }
    }
}

/// A failed try.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The HTTP status, if there was a reply at all.
    pub status: Option<u16>,
    /// The error message: never with a key, and never longer than a few hundred characters.
    pub message: String,
    /// The wait after it, ms.
    pub waited_ms: u64,
}

/// The error if there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct ChatError {
    /// The kind of error.
    pub kind: ChatErrorKind,
    /// The error message, with the server and the next step.
    pub message: String,
    /// All tries.
    pub failures: Vec<Failure>,
}

/// The cause of a missing answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ChatErrorKind {
    /// The network or the server failed in every try.
    Infrastructure,
    /// A cap on cost, tokens or requests forbids the request.
    Budget,
    /// The server rejects the request (400, 401, 403, 404, 422): a retry would not help.
    Rejected,
}
