//! Anthropic's messages API.

use super::{base64, joined, object, parse, text_or_placeholder};
use crate::client::chat::{ChatMessage, ChatReply, ChatRequest, Finish, Role, Usage};
use serde::Deserialize;
use serde_json::{Value, json};

/// The API version, sent in a header with every request.
pub(super) const VERSION: &str = "2023-06-01";

/// The default token limit for an answer. The API requires a limit.
pub(super) const MAX_TOKENS: u32 = 8192;

/// Returns a request's body. The system message is constant throughout an episode, so its end marks the end
/// of the cached prefix.
pub(super) fn body(model: &str, request: &ChatRequest) -> Value {
    let decoding = &request.decoding;
    let of_system = |message: &&ChatMessage| message.role == Role::System;
    let mut system: Vec<Value> = request.messages.iter().filter(of_system).map(|m| text(&m.text)).collect();
    if let Some(last) = system.last_mut() {
        last["cache_control"] = json!({ "type": "ephemeral" });
    }
    let messages = request.messages.iter().filter(|message| !of_system(message)).map(message);
    let effort = decoding.reasoning_effort.as_deref();
    let tokens = effort.and_then(|effort| effort.parse::<u32>().ok());
    let (thinking, output_config) = match (effort, tokens) {
        (None, _) => (None, None),
        (Some("none"), _) => (Some(json!({ "type": "disabled" })), None),
        (Some(_), Some(tokens)) => (Some(json!({ "type": "enabled", "budget_tokens": tokens })), None),
        (Some(effort), None) => (Some(json!({ "type": "adaptive" })), Some(json!({ "effort": effort }))),
    };
    object(vec![
        ("model", Some(json!(model))),
        ("system", (!system.is_empty()).then(|| system.into())),
        ("messages", Some(messages.collect())),
        ("max_tokens", Some(json!(decoding.max_output_tokens.unwrap_or(MAX_TOKENS)))),
        ("temperature", decoding.temperature.map(Value::from)),
        ("top_p", decoding.top_p.map(Value::from)),
        ("thinking", thinking),
        ("output_config", output_config),
    ])
}

fn text(text: &str) -> Value {
    json!({ "type": "text", "text": text_or_placeholder(text) })
}

fn message(message: &ChatMessage) -> Value {
    let mut content = vec![text(&message.text)];
    content.extend(message.image.as_ref().map(|png| {
        json!({ "type": "image", "source": { "type": "base64", "media_type": "image/png", "data": base64(png) } })
    }));
    json!({ "role": message.role, "content": content })
}

#[derive(Deserialize)]
struct Reply {
    content: Vec<Block>,
    stop_reason: Option<String>,
    usage: Option<Counts>,
    model: Option<String>,
}

#[derive(Deserialize)]
struct Block {
    text: Option<String>,
    thinking: Option<String>,
}

/// The token counts in a reply. The three counts of prompt tokens do not overlap.
#[derive(Deserialize)]
struct Counts {
    input_tokens: Option<u64>,
    cache_creation_input_tokens: Option<u64>,
    cache_read_input_tokens: Option<u64>,
    output_tokens: Option<u64>,
}

pub(super) fn answer(body: &str) -> Result<ChatReply, String> {
    let reply: Reply = parse(body)?;
    let finish = match reply.stop_reason.as_deref() {
        Some("end_turn" | "stop_sequence") => Finish::Stop,
        Some("max_tokens" | "model_context_window_exceeded") => Finish::Length,
        Some("refusal") => Finish::Refusal,
        _ => Finish::Other,
    };
    let (mut texts, mut thoughts) = (Vec::new(), Vec::new());
    for block in reply.content {
        texts.extend(block.text);
        thoughts.extend(block.thinking.filter(|thought| !thought.is_empty()));
    }
    Ok(ChatReply {
        reasoning: joined(thoughts),
        usage: reply.usage.map(usage).unwrap_or_default(),
        served_by: reply.model,
        ..ChatReply::new(joined(texts).unwrap_or_default(), finish)
    })
}

fn usage(counts: Counts) -> Usage {
    let cached = [counts.cache_creation_input_tokens, counts.cache_read_input_tokens];
    let whole = |plain: u64| cached.iter().flatten().fold(plain, |sum, tokens| sum.saturating_add(*tokens));
    Usage {
        input_tokens: counts.input_tokens.map(whole),
        cached_input_tokens: counts.cache_read_input_tokens,
        cache_write_tokens: counts.cache_creation_input_tokens,
        output_tokens: counts.output_tokens,
        reasoning_tokens: None,
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
            "system": [{ "type": "text", "text": "The rules.", "cache_control": { "type": "ephemeral" } }],
            "messages": [
                { "role": "user", "content": [{ "type": "text", "text": "First." }] },
                { "role": "assistant", "content": [{ "type": "text", "text": "(no words)" }] },
                { "role": "user", "content": [
                    { "type": "text", "text": "Now?" },
                    { "type": "image", "source": { "type": "base64", "media_type": "image/png", "data": "AQID" } },
                ] },
            ],
            "max_tokens": 64,
            "temperature": 0.5,
            "top_p": 0.9,
            "thinking": { "type": "adaptive" },
            "output_config": { "effort": "low" },
        });
        assert_eq!(body("m", &request()), expect);
    }

    #[test]
    fn unset_options_are_not_sent() {
        let expect = json!({
            "model": "m",
            "messages": [{ "role": "user", "content": [{ "type": "text", "text": "Hi" }] }],
            "max_tokens": 8192,
        });
        assert_eq!(body("m", &bare()), expect);
    }

    #[test]
    fn effort_in_tokens_and_none() {
        let thinking = |effort: &str| {
            let mut request = bare();
            request.decoding.reasoning_effort = Some(effort.to_owned());
            body("m", &request)["thinking"].clone()
        };
        assert_eq!(thinking("2048"), json!({ "type": "enabled", "budget_tokens": 2048 }));
        assert_eq!(thinking("none"), json!({ "type": "disabled" }));
    }

    #[test]
    fn a_reply_with_everything() {
        let reply = json!({
            "id": "x", "type": "message", "role": "assistant", "model": "m-2026",
            "content": [
                { "type": "thinking", "thinking": "Hm.", "signature": "s" },
                { "type": "redacted_thinking", "data": "d" },
                { "type": "text", "text": "Action: 2" },
            ],
            "stop_reason": "end_turn", "stop_sequence": null,
            "usage": {
                "input_tokens": 40, "cache_creation_input_tokens": 10, "cache_read_input_tokens": 50,
                "output_tokens": 30,
            },
        });
        let answer = answer(&reply.to_string()).unwrap();
        assert_eq!((answer.text.as_str(), answer.reasoning.as_deref()), ("Action: 2", Some("Hm.")));
        assert_eq!((answer.finish, answer.served_by.as_deref()), (Finish::Stop, Some("m-2026")));
        let expect = Usage {
            input_tokens: Some(100),
            cached_input_tokens: Some(50),
            cache_write_tokens: Some(10),
            output_tokens: Some(30),
            reasoning_tokens: None,
        };
        assert_eq!(answer.usage, expect);
    }

    #[test]
    fn stop_reasons() {
        for (reason, expect) in [
            ("max_tokens", Finish::Length),
            ("refusal", Finish::Refusal),
            ("stop_sequence", Finish::Stop),
            ("tool_use", Finish::Other),
        ] {
            let answer = answer(&json!({ "content": [], "stop_reason": reason }).to_string()).unwrap();
            assert_eq!((answer.finish, answer.text.as_str()), (expect, ""));
            assert_eq!(answer.usage, Usage::default());
        }
        assert!(answer("{\"type\":\"message\"}").unwrap_err().contains("not a reply"));
    }
}
