//! What is asked of a model, and what it answers.

use engine::Seed;
use serde::{Deserialize, Serialize};

/// A language model that answers chats.
pub trait Model: Sync + Send {
    /// One answer. Waits, tries again after passing failures, and returns what each try met.
    ///
    /// # Errors
    /// No answer was to be had: see [`ChatErrorKind`].
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError>;
}

/// What is asked of a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChatRequest {
    /// The conversation, the oldest first: an optional system message, then user and assistant in turn.
    pub messages: Vec<ChatMessage>,
    /// How the answer is to be sampled.
    pub decoding: Decoding,
    /// Which draw this is: two requests whose answers are to be independent, though they say the same, have different
    /// ones (of the episode's seed, run, step and attempt, say). It decides the jitter of waits and, unless the
    /// temperature is 0, which answer of the cache is meant; it is not sent.
    pub sample: Seed,
}

/// A message of a conversation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChatMessage {
    /// Who says it.
    pub role: Role,
    /// The words.
    pub text: String,
    /// A picture beside the words, PNG.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<Vec<u8>>,
}

/// Who says a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The frame of the conversation.
    System,
    /// We.
    User,
    /// The model.
    Assistant,
}

/// How an answer is sampled. What is `None` is not sent, and the provider's default holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decoding {
    /// Sampling temperature.
    pub temperature: Option<f64>,
    /// Nucleus sampling.
    pub top_p: Option<f64>,
    /// Tokens of the answer at most, reasoning included.
    pub max_output_tokens: Option<u32>,
    /// The provider's sampling seed.
    pub seed: Option<u64>,
    /// `low`, `medium`, `high`, or what the provider knows.
    pub reasoning_effort: Option<String>,
}

/// A model's answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChatReply {
    /// The words.
    pub text: String,
    /// The reasoning, where the provider shows it.
    pub reasoning: Option<String>,
    /// Why the answer ends.
    pub finish: Finish,
    /// What it cost.
    pub usage: Usage,
    /// The model that answered, as the provider calls it.
    pub served_by: Option<String>,
    /// The tries that failed before this one.
    pub failures: Vec<Failure>,
    /// From the request to the whole answer, without the tries before and the waits between, ms.
    pub latency_ms: f64,
    /// Whether the answer comes from the cache and cost nothing.
    pub cached: bool,
}

/// Why an answer ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// It is complete.
    Stop,
    /// The limit of tokens was met.
    Length,
    /// The model or its provider declined (content filter, refusal).
    Refusal,
    /// The provider gives another reason, or none.
    Other,
}

/// Tokens as the provider counts them; what it does not tell is `None`, never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Usage {
    /// Tokens of the prompt, cached ones included.
    pub input_tokens: Option<u64>,
    /// Of these, read from the provider's prefix cache.
    pub cached_input_tokens: Option<u64>,
    /// Of these, written to the provider's prefix cache, where that costs more than reading them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cache_write_tokens: Option<u64>,
    /// Tokens of the answer, reasoning included.
    pub output_tokens: Option<u64>,
    /// Of these, reasoning.
    pub reasoning_tokens: Option<u64>,
}

/// Tokens of one request above which a server's count is no count: no context window comes near.
const MOST_TOKENS: u64 = 1 << 40;

impl Usage {
    /// The counts without those that no request can have; what is left out is counted by ourselves.
    pub(super) fn plausible(self) -> Usage {
        let plausible = |count: Option<u64>| count.filter(|&tokens| tokens <= MOST_TOKENS);
        Usage {
            input_tokens: plausible(self.input_tokens),
            cached_input_tokens: plausible(self.cached_input_tokens),
            cache_write_tokens: plausible(self.cache_write_tokens),
            output_tokens: plausible(self.output_tokens),
            reasoning_tokens: plausible(self.reasoning_tokens),
        }
    }
}

/// A try that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The HTTP status, if there was an answer at all.
    pub status: Option<u16>,
    /// What went wrong; never a key, never more than a few hundred characters.
    pub message: String,
    /// How long was waited after it, ms.
    pub waited_ms: u64,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct ChatError {
    /// Whose fault it is.
    pub kind: ChatErrorKind,
    /// What went wrong, naming the server and the next move.
    pub message: String,
    /// All tries.
    pub failures: Vec<Failure>,
}

/// Whose fault it is that there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChatErrorKind {
    /// Network or server failed, however often it was tried.
    Infrastructure,
    /// A cap on cost, tokens or requests forbids the request.
    Budget,
    /// The server understands and will not (400, 401, 403, 404, 422): trying again is of no use.
    Rejected,
}
