//! The chat-completions API of OpenAI, and the compatible APIs of many other servers.

use super::{base64, object, parse};
use crate::client::chat::{ChatMessage, ChatReply, ChatRequest, Finish, Usage};
use itertools::Itertools;
use serde::Deserialize;
use serde_json::{Value, json};

/// The dialects of the chat-completions API.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dialect {
    /// The dialect of OpenAI's own servers. Their reasoning models accept only the newer name of the token
    /// limit.
    Own,
    /// The dialect of other servers, some of which accept only the older name of the token limit.
    Compatible,
}

pub(super) fn body(model: &str, request: &ChatRequest, dialect: Dialect) -> Value {
    let decoding = &request.decoding;
    let limit = match dialect {
        Dialect::Own => "max_completion_tokens",
        Dialect::Compatible => "max_tokens",
    };
    object(vec![
        ("model", Some(json!(model))),
        ("messages", Some(request.messages.iter().map(message).collect())),
        ("temperature", decoding.temperature.map(Value::from)),
        ("top_p", decoding.top_p.map(Value::from)),
        (limit, decoding.max_output_tokens.map(Value::from)),
        ("seed", decoding.seed.map(Value::from)),
        ("reasoning_effort", decoding.reasoning_effort.clone().map(Value::from)),
    ])
}

fn message(message: &ChatMessage) -> Value {
    let content = match &message.image {
        None => json!(message.text),
        Some(png) => json!([
            { "type": "text", "text": message.text },
            { "type": "image_url", "image_url": { "url": format!("data:image/png;base64,{}", base64(png)) } },
        ]),
    };
    json!({ "role": message.role, "content": content })
}

#[derive(Deserialize)]
struct Completion {
    #[serde(default)]
    choices: Vec<Choice>,
    usage: Option<Counts>,
    model: Option<String>,
    error: Option<Value>,
}

#[derive(Deserialize)]
struct Choice {
    message: Message,
    finish_reason: Option<String>,
}

#[derive(Deserialize)]
struct Message {
    content: Option<Content>,
    refusal: Option<String>,
    /// The reasoning, in the field used by DeepSeek, vLLM and llama.cpp.
    reasoning_content: Option<String>,
    /// The reasoning, in the field used by Ollama, OpenRouter and later versions of vLLM.
    reasoning: Option<String>,
}

/// The content of a message: a single text, or a list of parts. Some parts, such as images, have no text.
#[derive(Deserialize)]
#[serde(untagged)]
pub(crate) enum Content {
    Text(String),
    Parts(Vec<Part>),
}

#[derive(Deserialize)]
pub(crate) struct Part {
    text: Option<String>,
}

impl Content {
    /// Returns the content's texts, joined with line breaks.
    pub(crate) fn text(self) -> String {
        match self {
            Content::Text(text) => text,
            Content::Parts(parts) => parts.into_iter().filter_map(|part| part.text).join("\n"),
        }
    }
}

#[derive(Deserialize)]
struct Counts {
    prompt_tokens: Option<u64>,
    completion_tokens: Option<u64>,
    total_tokens: Option<u64>,
    prompt_tokens_details: Option<InputDetails>,
    completion_tokens_details: Option<OutputDetails>,
    /// The number of cached prompt tokens, in the field used by DeepSeek. Other servers report it in the
    /// token details.
    prompt_cache_hit_tokens: Option<u64>,
}

#[derive(Deserialize)]
struct InputDetails {
    cached_tokens: Option<u64>,
}

#[derive(Deserialize)]
struct OutputDetails {
    reasoning_tokens: Option<u64>,
}

pub(super) fn answer(body: &str) -> Result<ChatReply, String> {
    let completion: Completion = parse(body)?;
    let Some(choice) = completion.choices.into_iter().next() else {
        // Gateways report the errors of their upstream servers in this field.
        let error = completion.error.filter(|error| !error.is_null());
        return Err(error.map_or("a body without choices".to_owned(), |error| {
            format!("an error instead of a reply: {error}")
        }));
    };
    let refused = choice.message.refusal.filter(|words| !words.is_empty());
    let finish = match choice.finish_reason.as_deref() {
        _ if refused.is_some() => Finish::Refusal,
        Some("stop") => Finish::Stop,
        Some("length") => Finish::Length,
        Some("content_filter") => Finish::Refusal,
        _ => Finish::Other,
    };
    let text = choice.message.content.map(Content::text).unwrap_or_default();
    let text = if text.is_empty() { refused.unwrap_or_default() } else { text };
    let reasoning =
        choice.message.reasoning_content.or(choice.message.reasoning).filter(|text| !text.is_empty());
    let usage = completion.usage.map(usage).unwrap_or_default();
    Ok(ChatReply { reasoning, usage, served_by: completion.model, ..ChatReply::new(text, finish) })
}

fn usage(counts: Counts) -> Usage {
    let cached = counts.prompt_tokens_details.and_then(|details| details.cached_tokens);
    let reasoning = counts.completion_tokens_details.and_then(|details| details.reasoning_tokens);
    let mut output = counts.completion_tokens;
    // Some servers count reasoning tokens in addition to the answer's tokens, and others as part of them. The
    // total shows which of the two applies.
    if let (Some(input), Some(answer), Some(reasoning), Some(total)) =
        (counts.prompt_tokens, output, reasoning, counts.total_tokens)
        && reasoning > 0
        && input.checked_add(answer).and_then(|sum| sum.checked_add(reasoning)) == Some(total)
    {
        output = Some(answer + reasoning);
    }
    Usage {
        input_tokens: counts.prompt_tokens,
        cached_input_tokens: cached.or(counts.prompt_cache_hit_tokens),
        cache_write_tokens: None,
        output_tokens: output,
        reasoning_tokens: reasoning,
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{bare, request};
    use super::*;

    #[test]
    fn a_request_with_everything() {
        let expect = json!({
            "model": "m",
            "messages": [
                { "role": "system", "content": "The rules." },
                { "role": "user", "content": "First." },
                { "role": "assistant", "content": "" },
                { "role": "user", "content": [
                    { "type": "text", "text": "Now?" },
                    { "type": "image_url", "image_url": { "url": "data:image/png;base64,AQID" } },
                ] },
            ],
            "temperature": 0.5,
            "top_p": 0.9,
            "max_tokens": 64,
            "seed": 7,
            "reasoning_effort": "low",
        });
        assert_eq!(body("m", &request(), Dialect::Compatible), expect);
        let own = body("m", &request(), Dialect::Own);
        assert_eq!((&own["max_completion_tokens"], &own["max_tokens"]), (&json!(64), &Value::Null));
    }

    #[test]
    fn unset_options_are_not_sent() {
        let expect = json!({ "model": "m", "messages": [{ "role": "user", "content": "Hi" }] });
        assert_eq!(body("m", &bare(), Dialect::Own), expect);
    }

    fn check(body: Value, text: &str, finish: Finish) -> ChatReply {
        let answer = answer(&body.to_string()).unwrap();
        assert_eq!((answer.text.as_str(), answer.finish), (text, finish));
        answer
    }

    #[test]
    fn a_reply_with_everything() {
        let answer = check(
            json!({
                "id": "x", "object": "chat.completion", "created": 1, "model": "m-2026",
                "choices": [{
                    "index": 0, "finish_reason": "stop", "logprobs": null,
                    "message": { "role": "assistant", "content": "Action: 2", "refusal": null, "reasoning_content": "Hm." },
                }],
                "usage": {
                    "prompt_tokens": 100, "completion_tokens": 30, "total_tokens": 130,
                    "prompt_tokens_details": { "cached_tokens": 64, "audio_tokens": 0 },
                    "completion_tokens_details": { "reasoning_tokens": 20 },
                },
            }),
            "Action: 2",
            Finish::Stop,
        );
        assert_eq!(answer.reasoning.as_deref(), Some("Hm."));
        assert_eq!(answer.served_by.as_deref(), Some("m-2026"));
        let expect = Usage {
            input_tokens: Some(100),
            cached_input_tokens: Some(64),
            cache_write_tokens: None,
            output_tokens: Some(30),
            reasoning_tokens: Some(20),
        };
        assert_eq!(answer.usage, expect);
    }

    #[test]
    fn separate_reasoning_tokens_are_counted() {
        let answer = check(
            json!({
                "choices": [{ "message": { "content": "up" }, "finish_reason": "stop" }],
                "usage": {
                    "prompt_tokens": 10, "completion_tokens": 3, "total_tokens": 18,
                    "completion_tokens_details": { "reasoning_tokens": 5 },
                },
            }),
            "up",
            Finish::Stop,
        );
        assert_eq!(answer.usage.output_tokens, Some(8));
    }

    #[test]
    fn other_finish_reasons_and_shapes() {
        let choice = |message: Value, finish: &str| json!({ "choices": [{ "message": message, "finish_reason": finish }] });
        let answer = check(choice(json!({ "content": "So, I th" }), "length"), "So, I th", Finish::Length);
        assert_eq!(answer.usage, Usage::default(), "what is not told is not 0");
        check(choice(json!({ "content": "" }), "content_filter"), "", Finish::Refusal);
        check(
            choice(json!({ "content": null, "refusal": "I will not." }), "stop"),
            "I will not.",
            Finish::Refusal,
        );
        check(choice(json!({ "content": null }), "stop"), "", Finish::Stop);
        check(choice(json!({ "content": [{ "type": "text", "text": "up" }] }), "stop"), "up", Finish::Stop);
        check(choice(json!({ "content": "up" }), "tool_calls"), "up", Finish::Other);
        check(json!({ "choices": [{ "message": { "content": "up" } }], "usage": null }), "up", Finish::Other);
        let answer =
            check(choice(json!({ "content": "up", "reasoning": "Hm." }), "stop"), "up", Finish::Stop);
        assert_eq!(answer.reasoning.as_deref(), Some("Hm."));
    }

    #[test]
    fn malformed_bodies_are_rejected() {
        for (body, words) in [
            ("", "not a reply"),
            ("<html></html>", "not a reply"),
            ("{\"choices\":[", "not a reply"),
            ("{}", "without choices"),
            ("{\"choices\":[]}", "without choices"),
            ("{\"error\":{\"message\":\"upstream\",\"code\":502}}", "upstream"),
            ("{\"choices\":[{\"text\":\"up\"}]}", "not a reply"),
        ] {
            let problem = answer(body).unwrap_err();
            assert!(problem.contains(words), "{body}: {problem}");
        }
    }
}
