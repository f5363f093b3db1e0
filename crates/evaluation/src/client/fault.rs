//! Classifies HTTP replies as answers, transient failures or final rejections.

use super::chat::{ChatReply, Finish};
use super::http::HttpReply;
use super::provider::Provider;
use itertools::Itertools;
use serde_json::Value;
use std::time::{Duration, SystemTime};

/// The reason why a try yielded no answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Fault {
    /// A temporary failure, after which another try may succeed.
    Transient {
        /// The reply's HTTP status, if any.
        status: Option<u16>,
        message: String,
        wait: Option<Duration>,
    },
    /// The first connection was refused, so there is probably no server.
    Unreachable { message: String },
    /// A permanent failure: the server will always reject this request.
    Final {
        status: u16,
        /// The server's own explanation.
        message: String,
    },
}

/// The maximum number of characters retained from a server's message.
const MAX_MESSAGE: usize = 300;

/// Classifies a reply received at `date`.
pub(super) fn classify(provider: Provider, reply: &HttpReply, date: SystemTime) -> Result<ChatReply, Fault> {
    let status = reply.status;
    let transient = |message: String, wait| Fault::Transient { status: Some(status), message, wait };
    if (200..300).contains(&status) {
        return provider.answer(&reply.body).map_err(|problem| match body_kind(&reply.body) {
            Some(kind) => transient(kind.to_owned(), None),
            None => transient(shorten(&problem), None),
        });
    }
    let error_body = ErrorBody::read(&reply.body);
    if error_body.is_refusal() {
        return Ok(ChatReply::new(shorten(&error_body.message), Finish::Refusal));
    }
    let words = match (body_kind(&reply.body), &reply.location) {
        (_, Some(target)) if (300..400).contains(&status) => {
            format!("the server redirects to {}", shorten(target))
        }
        (Some(kind), _) => kind.to_owned(),
        (None, _) => shorten(&error_body.message),
    };
    let is_transient = matches!(status, 408 | 409 | 425 | 429 | 500..600);
    if is_transient && error_body.code != "insufficient_quota" {
        let requested_wait = reply.retry_after.as_deref().and_then(|value| retry_after(value, date));
        return Err(transient(words, requested_wait.or(error_body.wait)));
    }
    Err(Fault::Final { status, message: words })
}

/// Returns a description of a body that no model server would send, or `None` for any other body.
fn body_kind(body: &str) -> Option<&'static str> {
    let body = body.trim_start();
    if body.is_empty() {
        return Some("an empty body");
    }
    body.starts_with('<').then_some("an HTML page")
}

/// The maximum wait accepted from a header or a body: one year.
const MAX_RETRY_AFTER: Duration = Duration::from_secs(365 * 24 * 60 * 60);

/// Parses the wait in a `Retry-After` header, which is either a date or a number of seconds with any number
/// of digits. The result is at most [`MAX_RETRY_AFTER`].
fn retry_after(value: &str, date: SystemTime) -> Option<Duration> {
    let value = value.trim();
    if !value.is_empty() && value.bytes().all(|byte| byte.is_ascii_digit()) {
        return Some(value.parse().map_or(MAX_RETRY_AFTER, Duration::from_secs).min(MAX_RETRY_AFTER));
    }
    let until = httpdate::parse_http_date(value).ok()?;
    Some(until.duration_since(date).unwrap_or_default().min(MAX_RETRY_AFTER))
}

/// The content of an error body, in any of the layouts used by servers.
struct ErrorBody {
    message: String,
    code: String,
    wait: Option<Duration>,
}

impl ErrorBody {
    fn read(body: &str) -> ErrorBody {
        let parsed: Value = serde_json::from_str(body).unwrap_or_default();
        // Some servers wrap the body in a list.
        let parsed = parsed.get(0).unwrap_or(&parsed);
        let error = parsed.get("error").unwrap_or(parsed);
        let text = |value: Option<&Value>| value.and_then(Value::as_str).map(str::to_owned);
        let message =
            text(error.get("message")).or_else(|| text(Some(error))).or_else(|| text(error.get("detail")));
        let code = text(error.get("code")).or_else(|| text(error.get("type")));
        let details = error.get("details").and_then(Value::as_array);
        let delay = details.and_then(|all| all.iter().find_map(|detail| detail.get("retryDelay")?.as_str()));
        ErrorBody {
            message: message.unwrap_or_else(|| body.to_owned()),
            code: code.unwrap_or_default(),
            wait: delay.and_then(seconds),
        }
    }

    /// Returns `true` if the provider's content filter rejected the request.
    fn is_refusal(&self) -> bool {
        match self.code.as_str() {
            "content_filter" | "content_policy_violation" => true,
            "invalid_prompt" => self.message.contains("policy"),
            _ => false,
        }
    }
}

/// Parses a duration in Gemini's format, such as `34.07s`. The result is at most [`MAX_RETRY_AFTER`].
fn seconds(text: &str) -> Option<Duration> {
    let seconds: f64 = text.strip_suffix('s')?.parse().ok().filter(|seconds: &f64| !seconds.is_nan())?;
    Duration::try_from_secs_f64(seconds.min(MAX_RETRY_AFTER.as_secs_f64())).ok()
}

/// Shortens a text to at most [`MAX_MESSAGE`] characters on a single line, without control characters.
pub(super) fn shorten(text: &str) -> String {
    let plain = text.replace(char::is_control, " ");
    let line = plain.split_whitespace().join(" ");
    if line.chars().count() <= MAX_MESSAGE {
        line
    } else {
        line.chars().take(MAX_MESSAGE).chain(['…']).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn reply(status: u16, body: &str) -> HttpReply {
        HttpReply { status, retry_after: None, location: None, body: body.to_owned() }
    }

    fn classified(status: u16, body: &str) -> Result<ChatReply, Fault> {
        classify(Provider::Compatible, &reply(status, body), SystemTime::UNIX_EPOCH)
    }

    #[test]
    fn statuses() {
        for status in [408, 409, 425, 429, 500, 502, 503, 504, 529] {
            let fault = classified(status, "{\"error\":{\"message\":\"later\"}}").unwrap_err();
            let expect = Fault::Transient { status: Some(status), message: "later".to_owned(), wait: None };
            assert_eq!(fault, expect);
        }
        for status in [400, 401, 402, 403, 404, 413, 422] {
            let fault = classified(status, "{\"error\":{\"message\":\"no\"}}").unwrap_err();
            assert_eq!(fault, Fault::Final { status, message: "no".to_owned() });
        }
    }

    #[test]
    fn error_bodies_of_all_shapes() {
        for (body, words) in [
            ("{\"error\":{\"message\":\"one\",\"type\":\"x\"}}", "one"),
            ("{\"error\":\"two\"}", "two"),
            ("{\"object\":\"error\",\"message\":\"three\",\"code\":400}", "three"),
            ("{\"detail\":\"four\"}", "four"),
            ("[{\"error\":{\"message\":\"five\"}}]", "five"),
            ("six\n\u{1b}[31mred", "six [31mred"),
            ("", "an empty body"),
            ("<!doctype html><title>no</title>", "an HTML page"),
        ] {
            assert_eq!(classified(400, body), Err(Fault::Final { status: 400, message: words.to_owned() }));
        }
        let Err(Fault::Final { message, .. }) = classified(400, &"x".repeat(5000)) else { panic!() };
        assert_eq!(message.chars().count(), MAX_MESSAGE + 1);
    }

    #[test]
    fn exhausted_quota_is_final_and_a_filter_is_a_refusal() {
        let quota = "{\"error\":{\"message\":\"pay\",\"code\":\"insufficient_quota\"}}";
        assert_eq!(classified(429, quota), Err(Fault::Final { status: 429, message: "pay".to_owned() }));
        let filter = "{\"error\":{\"message\":\"filtered\",\"code\":\"content_filter\"}}";
        let answer = classified(400, filter).unwrap();
        assert_eq!((answer.finish, answer.text.as_str()), (Finish::Refusal, "filtered"));
        let flagged = "{\"error\":{\"message\":\"against our usage policy\",\"code\":\"invalid_prompt\"}}";
        assert_eq!(classified(400, flagged).unwrap().finish, Finish::Refusal);
    }

    #[test]
    fn redirects_are_reported() {
        let mut moved = reply(308, "");
        moved.location = Some("https://example.org/v1".to_owned());
        let fault = classify(Provider::Compatible, &moved, SystemTime::UNIX_EPOCH).unwrap_err();
        assert_eq!(
            fault,
            Fault::Final {
                status: 308,
                message: "the server redirects to https://example.org/v1".to_owned()
            }
        );
    }

    #[test]
    fn requested_waits_are_parsed() {
        let date = httpdate::parse_http_date("Tue, 01 Dec 2026 08:00:00 GMT").unwrap();
        let check = |value: &str, expect: Option<u64>| {
            assert_eq!(retry_after(value, date), expect.map(Duration::from_secs), "{value}");
        };
        check("7", Some(7));
        check("Tue, 01 Dec 2026 08:01:30 GMT", Some(90));
        check("Tue, 01 Dec 2026 07:00:00 GMT", Some(0));
        check("soon", None);
        check("", None);
        // Numbers that do not fit in 64 bits are also capped.
        for much in ["99999999999", "18446744073709551616", "99999999999999999999999999"] {
            check(much, Some(MAX_RETRY_AFTER.as_secs()));
        }
        assert_eq!(seconds("1e30s"), Some(MAX_RETRY_AFTER));
        assert_eq!((seconds("-1s"), seconds("NaNs")), (None, None));
        check("-5", None);
        let body = "{\"error\":{\"code\":429,\"message\":\"later\",\"details\":[{\"@type\":\"a\"},{\"retryDelay\":\"34.5s\"}]}}";
        let Err(Fault::Transient { wait, .. }) = classified(429, body) else { panic!() };
        assert_eq!(wait, Some(Duration::from_millis(34_500)));
    }

    #[test]
    fn malformed_bodies_are_transient() {
        for (body, words) in [
            ("", "an empty body"),
            (" \n", "an empty body"),
            ("<html>busy</html>", "an HTML page"),
            ("{\"choices\": [", "not a reply"),
        ] {
            let Err(Fault::Transient { status, message, .. }) = classified(200, body) else {
                panic!("{body}")
            };
            assert!(status == Some(200) && message.contains(words), "{message}");
        }
    }

    proptest! {
        /// For any body, the error message is short, on one line, and free of control characters.
        #[test]
        fn any_body_is_classified(status in 200u16..600, body in "\\PC*|[^a]*|\\{\"error\":\"[^\"]*\"\\}|\\{\"message\":.*") {
            for provider in [Provider::OpenAi, Provider::Anthropic, Provider::Gemini] {
                let message = match classify(provider, &reply(status, &body), SystemTime::UNIX_EPOCH) {
                    Ok(answer) => answer.text,
                    Err(
                        Fault::Transient { message, .. }
                        | Fault::Unreachable { message }
                        | Fault::Final { message, .. },
                    ) => message,
                };
                prop_assert!(message.chars().count() <= MAX_MESSAGE + 1 && !message.contains(char::is_control));
            }
        }
    }

    /// A reply truncated at any byte is not an answer.
    #[test]
    fn truncated_replies_are_rejected() {
        for (provider, body) in [
            (Provider::Compatible, r#"{"choices":[{"message":{"content":"é up"},"finish_reason":"stop"}]}"#),
            (Provider::Anthropic, r#"{"content":[{"type":"text","text":"é up"}],"stop_reason":"end_turn"}"#),
            (
                Provider::Gemini,
                r#"{"candidates":[{"content":{"parts":[{"text":"é up"}]},"finishReason":"STOP"}]}"#,
            ),
        ] {
            let whole = classify(provider, &reply(200, body), SystemTime::UNIX_EPOCH).unwrap();
            assert_eq!((whole.text.as_str(), whole.finish), ("é up", Finish::Stop));
            for (end, _) in body.char_indices() {
                let half = classify(provider, &reply(200, &body[..end]), SystemTime::UNIX_EPOCH);
                assert!(matches!(half, Err(Fault::Transient { status: Some(200), .. })), "{}", &body[..end]);
            }
        }
    }
}
