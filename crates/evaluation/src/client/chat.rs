//! Requests to a model, and its answers.

use base::Seed;
use serde::{Deserialize, Serialize};

/// A language model that answers chats.
pub trait Model: Sync + Send {
    /// Requests one answer. Retries after transient failures, and returns the failure of each try.
    ///
    /// # Errors
    /// Returns an error if no answer could be obtained: see [`ChatErrorKind`].
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError>;
}

/// A request to a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChatRequest {
    /// The conversation, oldest message first: an optional system message, followed by alternating messages of user
    /// and assistant.
    pub messages: Vec<ChatMessage>,
    /// The sampling settings for the answer.
    pub decoding: Decoding,
    /// The seed of this draw. Equal requests that need independent answers have different seeds, which are derived,
    /// for example, from the episode's seed, run, step and attempt. The seed determines the jitter of waits and,
    /// unless the temperature is 0, the cached answer. It is not sent.
    pub sample: Seed,
}

/// A message of a conversation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChatMessage {
    /// The author.
    pub role: Role,
    /// The text.
    pub text: String,
    /// An image beside the text, in PNG format.
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

/// The sampling settings for an answer. `None` is not sent, so that the provider's default applies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decoding {
    /// The sampling temperature.
    pub temperature: Option<f64>,
    /// The probability mass of nucleus sampling.
    pub top_p: Option<f64>,
    /// The maximum number of tokens in the answer, including reasoning.
    pub max_output_tokens: Option<u32>,
    /// The provider's sampling seed.
    pub seed: Option<u64>,
    /// The reasoning effort: `low`, `medium`, `high`, or a different value of the provider.
    pub reasoning_effort: Option<String>,
}

/// A model's answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ChatReply {
    /// The text.
    pub text: String,
    /// The reasoning, if the provider returns it.
    pub reasoning: Option<String>,
    /// The reason why the answer ended.
    pub finish: Finish,
    /// The tokens used.
    pub usage: Usage,
    /// The name that the provider uses for the model that answered.
    pub served_by: Option<String>,
    /// The failed tries before this one.
    pub failures: Vec<Failure>,
    /// The time from the request to the complete answer, without earlier tries and waits, in milliseconds.
    pub latency_ms: f64,
    /// `true` if the answer comes from the cache and cost nothing.
    pub cached: bool,
}

impl ChatReply {
    /// Creates an answer with a text and a finish reason only.
    pub fn new(text: String, finish: Finish) -> ChatReply {
        ChatReply { text, finish, ..ChatReply::default() }
    }
}

/// The reason why an answer ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// The answer is complete.
    Stop,
    /// The token limit was reached.
    Length,
    /// The model or its provider declined (content filter, refusal).
    Refusal,
    /// The provider stated a different reason, or no reason.
    #[default]
    Other,
}

/// The token counts that the provider reports. Unreported counts are `None`, never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Usage {
    /// The number of tokens in the prompt, including cached ones.
    pub input_tokens: Option<u64>,
    /// The number of prompt tokens read from the provider's prefix cache.
    pub cached_input_tokens: Option<u64>,
    /// The number of prompt tokens written to the provider's prefix cache, if writing costs more than reading.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cache_write_tokens: Option<u64>,
    /// The number of tokens in the answer, including reasoning.
    pub output_tokens: Option<u64>,
    /// The number of answer tokens used for reasoning.
    pub reasoning_tokens: Option<u64>,
}

/// The maximum plausible token count of one request, far above any context window.
const MAX_PLAUSIBLE_TOKENS: u64 = 1 << 40;

impl Usage {
    /// Removes implausible counts, so that local counts replace them.
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
    /// The error message. It never contains a key, and has at most a few hundred characters.
    pub message: String,
    /// The wait after the try, in milliseconds.
    pub waited_ms: u64,
}

/// The error for a missing answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct ChatError {
    /// The kind of error.
    pub kind: ChatErrorKind,
    /// The error message, which includes the server and the next step.
    pub message: String,
    /// The failures of all tries.
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
    /// The server rejects the request (400, 401, 403, 404, 422), so a retry would not help.
    Rejected,
}
