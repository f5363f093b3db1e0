//! Gemini's `generateContent` API.

use super::{base64, object, parse, text_or_placeholder};
use crate::client::chat::{ChatMessage, ChatReply, ChatRequest, Decoding, Finish, Role, Usage};
use serde::Deserialize;
use serde_json::{Value, json};

/// Returns a request's body. The model is not in the body, because it is part of the URL.
pub(super) fn body(request: &ChatRequest) -> Value {
    let of_system = |message: &&ChatMessage| message.role == Role::System;
    let system: Vec<Value> = request.messages.iter().filter(of_system).map(|m| text(&m.text)).collect();
    let contents = request.messages.iter().filter(|message| !of_system(message)).map(content);
    let configuration = generation(&request.decoding);
    let configured = configuration.as_object().is_some_and(|fields| !fields.is_empty());
    object(vec![
        ("systemInstruction", (!system.is_empty()).then(|| json!({ "parts": system }))),
        ("contents", Some(contents.collect())),
        ("generationConfig", configured.then_some(configuration)),
    ])
}

fn generation(decoding: &Decoding) -> Value {
    // Models that do not support thinking reject requests for thoughts.
    let thinking = decoding.reasoning_effort.as_deref().map(|effort| match effort.parse::<u32>() {
        Ok(tokens) => json!({ "thinkingBudget": tokens, "includeThoughts": tokens > 0 }),
        Err(_) if effort == "none" => json!({ "thinkingBudget": 0 }),
        Err(_) => json!({ "thinkingLevel": effort, "includeThoughts": true }),
    });
    object(vec![
        ("temperature", decoding.temperature.map(Value::from)),
        ("topP", decoding.top_p.map(Value::from)),
        ("maxOutputTokens", decoding.max_output_tokens.map(Value::from)),
        ("seed", decoding.seed.map(Value::from)),
        ("thinkingConfig", thinking),
    ])
}

fn text(text: &str) -> Value {
    json!({ "text": text_or_placeholder(text) })
}

fn content(message: &ChatMessage) -> Value {
    let mut parts = vec![text(&message.text)];
    let picture = message.image.as_ref();
    parts
        .extend(picture.map(|png| json!({ "inlineData": { "mimeType": "image/png", "data": base64(png) } })));
    let role = if message.role == Role::Assistant { "model" } else { "user" };
    json!({ "role": role, "parts": parts })
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Reply {
    #[serde(default)]
    candidates: Vec<Candidate>,
    prompt_feedback: Option<Feedback>,
    usage_metadata: Option<Counts>,
    model_version: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Candidate {
    content: Option<Parts>,
    finish_reason: Option<String>,
}

#[derive(Deserialize)]
struct Parts {
    #[serde(default)]
    parts: Vec<Part>,
}

#[derive(Deserialize)]
struct Part {
    text: Option<String>,
    #[serde(default)]
    thought: bool,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Feedback {
    block_reason: Option<String>,
}

/// The token counts in a reply. The answer's count excludes thoughts.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Counts {
    prompt_token_count: Option<u64>,
    cached_content_token_count: Option<u64>,
    candidates_token_count: Option<u64>,
    thoughts_token_count: Option<u64>,
}

pub(super) fn answer(body: &str) -> Result<ChatReply, String> {
    let reply: Reply = parse(body)?;
    let blocked = reply.prompt_feedback.is_some_and(|feedback| feedback.block_reason.is_some());
    let (mut text, mut thoughts) = (String::new(), String::new());
    let finish = match reply.candidates.into_iter().next() {
        None if blocked => Finish::Refusal,
        None => return Err("a body without candidates".to_owned()),
        Some(candidate) => {
            // The parts are pieces of one text, which the server may split anywhere.
            for part in candidate.content.map(|content| content.parts).unwrap_or_default() {
                let target = if part.thought { &mut thoughts } else { &mut text };
                target.push_str(part.text.as_deref().unwrap_or_default());
            }
            finish(candidate.finish_reason.as_deref())
        }
    };
    Ok(ChatReply {
        reasoning: (!thoughts.is_empty()).then_some(thoughts),
        usage: reply.usage_metadata.map(usage).unwrap_or_default(),
        served_by: reply.model_version,
        ..ChatReply::new(text, finish)
    })
}

fn finish(reason: Option<&str>) -> Finish {
    match reason {
        Some("STOP") => Finish::Stop,
        Some("MAX_TOKENS") => Finish::Length,
        Some("SAFETY" | "RECITATION" | "BLOCKLIST" | "PROHIBITED_CONTENT" | "SPII") => Finish::Refusal,
        _ => Finish::Other,
    }
}

fn usage(counts: Counts) -> Usage {
    let (answer, thoughts) = (counts.candidates_token_count, counts.thoughts_token_count);
    Usage {
        input_tokens: counts.prompt_token_count,
        cached_input_tokens: counts.cached_content_token_count,
        cache_write_tokens: None,
        // When the server reports counts, it omits every field whose value is 0.
        output_tokens: match (answer, thoughts) {
            (None, None) => counts.prompt_token_count.map(|_| 0),
            _ => Some(answer.unwrap_or(0).saturating_add(thoughts.unwrap_or(0))),
        },
        reasoning_tokens: thoughts,
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{bare, request};
    use super::*;

    #[test]
    fn a_request_with_everything() {
        let expect = json!({
            "systemInstruction": { "parts": [{ "text": "The rules." }] },
            "contents": [
                { "role": "user", "parts": [{ "text": "First." }] },
                { "role": "model", "parts": [{ "text": "(no words)" }] },
                { "role": "user", "parts": [
                    { "text": "Now?" },
                    { "inlineData": { "mimeType": "image/png", "data": "AQID" } },
                ] },
            ],
            "generationConfig": {
                "temperature": 0.5,
                "topP": 0.9,
                "maxOutputTokens": 64,
                "seed": 7,
                "thinkingConfig": { "thinkingLevel": "low", "includeThoughts": true },
            },
        });
        assert_eq!(body(&request()), expect);
    }

    #[test]
    fn unset_options_are_not_sent() {
        assert_eq!(body(&bare()), json!({ "contents": [{ "role": "user", "parts": [{ "text": "Hi" }] }] }));
        let mut request = bare();
        request.decoding.reasoning_effort = Some("512".to_owned());
        let thinking = &body(&request)["generationConfig"]["thinkingConfig"];
        assert_eq!(thinking, &json!({ "thinkingBudget": 512, "includeThoughts": true }));
    }

    #[test]
    fn a_reply_with_everything() {
        let reply = json!({
            "candidates": [{
                "content": { "role": "model", "parts": [
                    { "text": "Hm.", "thought": true }, { "text": "Act" }, { "text": "ion: 2" },
                ] },
                "finishReason": "STOP", "index": 0,
            }],
            "usageMetadata": {
                "promptTokenCount": 100, "cachedContentTokenCount": 50, "candidatesTokenCount": 10,
                "thoughtsTokenCount": 20, "totalTokenCount": 130,
            },
            "modelVersion": "m-2026",
        });
        let answer = answer(&reply.to_string()).unwrap();
        assert_eq!((answer.text.as_str(), answer.reasoning.as_deref()), ("Action: 2", Some("Hm.")));
        assert_eq!((answer.finish, answer.served_by.as_deref()), (Finish::Stop, Some("m-2026")));
        let expect = Usage {
            input_tokens: Some(100),
            cached_input_tokens: Some(50),
            cache_write_tokens: None,
            output_tokens: Some(30),
            reasoning_tokens: Some(20),
        };
        assert_eq!(answer.usage, expect);
    }

    #[test]
    fn finish_reasons() {
        let end = |body: Value| answer(&body.to_string()).map(|answer| answer.finish);
        assert_eq!(end(json!({ "candidates": [{ "finishReason": "MAX_TOKENS" }] })), Ok(Finish::Length));
        assert_eq!(end(json!({ "candidates": [{ "finishReason": "SAFETY" }] })), Ok(Finish::Refusal));
        assert_eq!(end(json!({ "candidates": [{ "finishReason": "NEW" }] })), Ok(Finish::Other));
        assert_eq!(end(json!({ "promptFeedback": { "blockReason": "OTHER" } })), Ok(Finish::Refusal));
        assert!(end(json!({})).unwrap_err().contains("without candidates"));
    }

    #[test]
    fn counts_of_zero_are_left_out_by_the_server() {
        let body = json!({ "candidates": [{}], "usageMetadata": { "promptTokenCount": 9 } });
        let usage = answer(&body.to_string()).unwrap().usage;
        assert_eq!((usage.output_tokens, usage.reasoning_tokens), (Some(0), None));
    }
}
