//! Requests to models, and their answers.

use base::Seed;
use serde::{Deserialize, Serialize};

/// A language model that answers chats.
pub trait Model: Sync + Send {
    /// Requests one answer, and retries after transient failures. Both the answer and the error list the
    /// failed tries.
    ///
    /// # Errors
    /// Returns an error if no answer could be obtained. [`ChatErrorKind`] lists the causes.
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError>;
}

/// A request to a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChatRequest {
    /// The conversation, oldest message first. An optional system message is followed by alternating user and
    /// assistant messages.
    pub messages: Vec<ChatMessage>,
    /// The sampling settings for the answer.
    pub decoding: Decoding,
    /// The seed that identifies this answer's draw. It is not sent to the provider. Requests that have equal
    /// content but need independent answers use distinct seeds, derived from values such as the episode's
    /// seed, run, step and attempt. The seed determines the jitter of waits. Unless the temperature is 0, the
    /// seed also selects the cached answer.
    pub sample: Seed,
}

/// A conversation message.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChatMessage {
    /// The message's author.
    pub role: Role,
    /// The message text.
    pub text: String,
    /// An image that accompanies the text, in PNG format.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<Vec<u8>>,
}

/// A message's author.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The author of the conversation's initial instructions.
    System,
    /// The client that sends the requests.
    User,
    /// The model that answers.
    Assistant,
}

/// The sampling settings for an answer. Settings that are `None` are not sent, so the provider's defaults
/// apply.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decoding {
    /// The sampling temperature.
    pub temperature: Option<f64>,
    /// The probability mass for nucleus sampling.
    pub top_p: Option<f64>,
    /// The maximum number of tokens in the answer, including reasoning.
    pub max_output_tokens: Option<u32>,
    /// The sampling seed to send to the provider.
    pub seed: Option<u64>,
    /// The reasoning effort: `low`, `medium`, `high`, or a provider-specific value.
    pub reasoning_effort: Option<String>,
}

/// A model's answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ChatReply {
    /// The answer text.
    pub text: String,
    /// The model's reasoning, if the provider returns it.
    pub reasoning: Option<String>,
    /// The reason why the answer ended.
    pub finish: Finish,
    /// The token counts of the request and its answer.
    pub usage: Usage,
    /// The provider's name for the model that answered.
    pub served_by: Option<String>,
    /// The failed tries before the successful try.
    pub failures: Vec<Failure>,
    /// The time between sending the request and receiving the complete answer, in milliseconds, excluding
    /// earlier tries and waits.
    pub latency_ms: f64,
    /// `true` if the answer comes from the cache and cost nothing.
    pub cached: bool,
}

impl ChatReply {
    /// Creates an answer with the given text and finish reason, and default values for all other fields.
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
    /// The model or its provider declined to answer, for example because of a content filter.
    Refusal,
    /// The answer has more tokens than the evaluation allows, although the provider did not cut it off.
    Excess,
    /// The provider stated a different reason, or no reason.
    #[default]
    Other,
}

/// The token counts reported by the provider. An unreported count is `None`, never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Usage {
    /// The number of tokens in the prompt, including cached tokens.
    pub input_tokens: Option<u64>,
    /// The number of prompt tokens read from the provider's prefix cache.
    pub cached_input_tokens: Option<u64>,
    /// The number of prompt tokens written to the provider's prefix cache. Some providers charge extra for
    /// these tokens.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cache_write_tokens: Option<u64>,
    /// The number of tokens in the answer, including reasoning.
    pub output_tokens: Option<u64>,
    /// The number of answer tokens used for reasoning.
    pub reasoning_tokens: Option<u64>,
}

/// The maximum plausible token count for one request, far above any context window.
const MAX_PLAUSIBLE_TOKENS: u64 = 1 << 40;

impl Usage {
    /// Removes implausible counts, so that local counts are used instead.
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

/// A failed try at a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The HTTP status of the reply, if any.
    pub status: Option<u16>,
    /// The error message, which never contains a key and is limited to a few hundred characters.
    pub message: String,
    /// The time waited after the try, in milliseconds.
    pub waited_ms: u64,
}

/// The error returned when no answer could be obtained.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct ChatError {
    /// The kind of error.
    pub kind: ChatErrorKind,
    /// The error message, which states the server and the recommended next step.
    pub message: String,
    /// The failures of all tries.
    pub failures: Vec<Failure>,
}

/// The reason why no answer could be obtained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ChatErrorKind {
    /// Every try failed because of the network or the server.
    Infrastructure,
    /// The first connection to the server was refused, so no server seems to be running.
    Unreachable,
    /// The request would exceed a cap on cost, tokens or requests.
    Budget,
    /// The server rejected the request (400, 401, 403, 404, 422), so retrying would not help.
    Rejected,
}
