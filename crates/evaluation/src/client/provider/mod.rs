//! The APIs of model servers. For each API, a module builds request bodies and parses reply bodies.

mod anthropic;
mod gemini;
mod openai;

pub(crate) use openai::Content;

use super::chat::{ChatReply, ChatRequest, Decoding};
use super::key::Key;
use crate::error::EvaluationError;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Deserialize;
use serde_json::Value;
use ureq::http::HeaderValue;

base::named_enum! {
    /// A server's API.
    pub enum Provider {
        /// OpenAI's chat-completions API, in the dialect of OpenAI's own servers.
        OpenAi = "openai",
        /// The chat-completions API as implemented by other servers, such as vLLM, llama.cpp, Ollama and
        /// gateways.
        Compatible = "compatible",
        /// Anthropic's messages API.
        Anthropic = "anthropic",
        /// Gemini's `generateContent` API.
        Gemini = "gemini",
    }
}

impl Provider {
    pub(super) fn from_prefix(prefix: &str) -> Option<Provider> {
        let prefixed = [Provider::OpenAi, Provider::Anthropic, Provider::Gemini];
        prefixed.into_iter().find(|provider| provider.name() == prefix)
    }

    /// Returns the base URL of the provider's own servers, or `None` if the provider has no servers of its
    /// own.
    pub(super) fn own_url(self) -> Option<&'static str> {
        match self {
            Provider::OpenAi => Some("https://api.openai.com/v1"),
            Provider::Compatible => None,
            Provider::Anthropic => Some("https://api.anthropic.com/v1"),
            Provider::Gemini => Some("https://generativelanguage.googleapis.com/v1beta"),
        }
    }

    /// Returns the name of the environment variable that contains the key.
    pub fn key_variable(self) -> &'static str {
        match self {
            Provider::OpenAi | Provider::Compatible => "OPENAI_API_KEY",
            Provider::Anthropic => "ANTHROPIC_API_KEY",
            Provider::Gemini => "GEMINI_API_KEY",
        }
    }

    /// Returns the sampling settings to send: the requested settings, and the settings that the provider requires.
    ///
    /// # Errors
    /// Returns an error if the request uses a setting that the provider does not support, or an out-of-range
    /// number.
    pub(super) fn decoding(self, requested: &Decoding) -> Result<Decoding, EvaluationError> {
        let mut decoding = requested.clone();
        check_ranges(requested).map_err(EvaluationError::Malformed)?;
        if self == Provider::Anthropic {
            if requested.seed.is_some() {
                let problem = "anthropic does not support a sampling seed; remove --sampling-seed".to_owned();
                return Err(EvaluationError::Malformed(problem));
            }
            decoding.max_output_tokens.get_or_insert(anthropic::MAX_TOKENS);
        }
        let effort = requested.reasoning_effort.as_deref().and_then(|effort| effort.parse::<u32>().ok());
        if let Some((effort, most)) = effort.zip(decoding.max_output_tokens).filter(|(own, most)| own >= most)
        {
            return Err(EvaluationError::Malformed(format!(
                "--reasoning-effort {effort} leaves no tokens for the answer; pass fewer than the {most} tokens of \
                 --max-output-tokens"
            )));
        }
        Ok(decoding)
    }

    /// Returns the URL path to append to the base URL.
    pub(super) fn path(self, model: &str) -> String {
        match self {
            Provider::OpenAi | Provider::Compatible => "/chat/completions".to_owned(),
            Provider::Anthropic => "/messages".to_owned(),
            Provider::Gemini => format!("/models/{model}:generateContent"),
        }
    }

    /// Returns the headers to send in addition to `Content-Type`.
    pub(super) fn headers(self, key: Option<&Key>) -> Vec<(&'static str, HeaderValue)> {
        let mut headers = Vec::new();
        if self == Provider::Anthropic {
            headers.push(("anthropic-version", HeaderValue::from_static(anthropic::VERSION)));
        }
        headers.extend(key.map(|key| match self {
            Provider::OpenAi | Provider::Compatible => ("authorization", key.header("Bearer ")),
            Provider::Anthropic => ("x-api-key", key.header("")),
            Provider::Gemini => ("x-goog-api-key", key.header("")),
        }));
        headers
    }

    pub(super) fn body(self, model: &str, request: &ChatRequest) -> Value {
        match self {
            Provider::OpenAi => openai::body(model, request, openai::Dialect::Own),
            Provider::Compatible => openai::body(model, request, openai::Dialect::Compatible),
            Provider::Anthropic => anthropic::body(model, request),
            Provider::Gemini => gemini::body(request),
        }
    }

    /// Parses a reply body.
    ///
    /// # Errors
    /// Returns the reason why the body is not a reply.
    pub(super) fn answer(self, body: &str) -> Result<ChatReply, String> {
        let answer = match self {
            Provider::OpenAi | Provider::Compatible => openai::answer(body),
            Provider::Anthropic => anthropic::answer(body),
            Provider::Gemini => gemini::answer(body),
        }?;
        Ok(ChatReply { usage: answer.usage.plausible(), ..answer })
    }
}

/// Rejects numbers outside the ranges that samplers accept.
fn check_ranges(decoding: &Decoding) -> Result<(), String> {
    let in_range = |flag: &str, value: Option<f64>, most: f64| match value {
        Some(value) if !(0.0..=most).contains(&value) => {
            Err(format!("{flag} takes a number from 0 to {most}, not {value}"))
        }
        _ => Ok(()),
    };
    in_range("--temperature", decoding.temperature, 2.0)?;
    in_range("--top-p", decoding.top_p, 1.0)?;
    match decoding.max_output_tokens {
        Some(0) => Err("--max-output-tokens must be at least 1, because an answer needs tokens".to_owned()),
        _ => Ok(()),
    }
}

/// The text sent in place of an empty message, because some APIs reject empty messages. It shows the model
/// that its answer was empty.
const PLACEHOLDER: &str = "(no words)";

/// Returns the text, or [`PLACEHOLDER`] if the text is empty.
fn text_or_placeholder(text: &str) -> &str {
    if text.trim().is_empty() { PLACEHOLDER } else { text }
}

fn base64(picture: &[u8]) -> String {
    STANDARD.encode(picture)
}

/// Returns a JSON object with the fields whose values are set.
fn object(fields: Vec<(&str, Option<Value>)>) -> Value {
    fields.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect()
}

fn parse<'a, T: Deserialize<'a>>(body: &'a str) -> Result<T, String> {
    serde_json::from_str(body).map_err(|error| format!("a body that is not a reply: {error}"))
}

/// Joins texts with line breaks. Returns `None` if the list is empty.
fn joined(texts: Vec<String>) -> Option<String> {
    (!texts.is_empty()).then(|| texts.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_outside_their_range_are_refused() {
        let refused = |decoding: Decoding, words: &str| {
            let problem = Provider::Compatible.decoding(&decoding).unwrap_err().to_string();
            assert!(problem.contains(words), "{problem}");
        };
        for temperature in [f64::NAN, f64::INFINITY, -1.0, 2.1] {
            let decoding = Decoding { temperature: Some(temperature), ..Decoding::default() };
            refused(decoding, "--temperature takes a number from 0 to 2");
        }
        refused(Decoding { top_p: Some(7.0), ..Decoding::default() }, "--top-p takes a number from 0 to 1");
        refused(Decoding { max_output_tokens: Some(0), ..Decoding::default() }, "at least 1");
        let fine = Decoding { temperature: Some(2.0), top_p: Some(0.0), ..Decoding::default() };
        assert_eq!(Provider::Compatible.decoding(&fine).unwrap(), fine);
    }

    /// Implausible counts are dropped, because they would make sums overflow, and a server's mistake could
    /// exhaust the caps.
    #[test]
    fn implausible_counts_are_left_out() {
        let body = r#"{"choices":[{"message":{"content":"up"},"finish_reason":"stop"}],
            "usage":{"prompt_tokens":18446744073709551615,"completion_tokens":10}}"#;
        let usage = Provider::Compatible.answer(body).unwrap().usage;
        assert_eq!((usage.input_tokens, usage.output_tokens), (None, Some(10)));
    }
}

#[cfg(test)]
mod examples {
    use super::*;
    use crate::client::chat::{ChatMessage, Role};
    use base::Seed;

    /// Returns a conversation that uses every feature of a request.
    pub(super) fn request() -> ChatRequest {
        let message = |role, text: &str| ChatMessage { role, text: text.to_owned(), image: None };
        let mut last = message(Role::User, "Now?");
        last.image = Some(vec![1, 2, 3]);
        ChatRequest {
            messages: vec![
                message(Role::System, "The rules."),
                message(Role::User, "First."),
                message(Role::Assistant, ""),
                last,
            ],
            decoding: Decoding {
                temperature: Some(0.5),
                top_p: Some(0.9),
                max_output_tokens: Some(64),
                seed: Some(7),
                reasoning_effort: Some("low".to_owned()),
            },
            sample: Seed::from_text("examples"),
        }
    }

    /// Returns a request with one short message and no options.
    pub(super) fn bare() -> ChatRequest {
        let messages = vec![ChatMessage { role: Role::User, text: "Hi".to_owned(), image: None }];
        ChatRequest { messages, decoding: Decoding::default(), sample: Seed::from_text("bare") }
    }
}
