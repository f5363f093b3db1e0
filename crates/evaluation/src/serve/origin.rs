//! Checks the origin of requests. Programs on this machine may send requests, but web pages from other sites
//! may not.
//!
//! Any web page can make a browser send requests to 127.0.0.1. Three headers reveal such requests:
//!
//! - `Host` contains the requested host name, which DNS rebinding cannot hide.
//! - `Origin` contains the page's origin.
//! - `Content-Type` is not JSON. A page may send text to any server, but JSON only to servers that allow it,
//!   and this server does not.

use super::refusal::refusal;
use axum::extract::Request;
use axum::http::{HeaderMap, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;

/// The host names that refer to this machine.
const LOOPBACK: [&str; 3] = ["127.0.0.1", "localhost", "[::1]"];

pub(super) async fn check(request: Request, next: Next) -> Response {
    match problem(request.method(), request.headers()) {
        None => next.run(request).await,
        Some((status, code, message)) => refusal(status, code, message),
    }
}

/// Returns the reason, if any, for rejecting a request with the given method and headers.
fn problem(method: &Method, headers: &HeaderMap) -> Option<(StatusCode, &'static str, &'static str)> {
    let all = |name| headers.get_all(name).iter().map(|value| value.to_str().unwrap_or_default());
    let hosts: Vec<&str> = all(header::HOST).collect();
    if hosts.len() != 1 || !is_loopback(hosts[0]) {
        return Some((
            StatusCode::MISDIRECTED_REQUEST,
            "foreign_host",
            "this server answers only on 127.0.0.1, localhost and [::1]; use its base URL",
        ));
    }
    let is_own = |origin: &str| origin.strip_prefix("http://").is_some_and(is_loopback);
    if !all(header::ORIGIN).all(is_own) {
        return Some((
            StatusCode::FORBIDDEN,
            "foreign_origin",
            "this server rejects requests from web pages of other hosts; send them from a program",
        ));
    }
    let is_json = |kind: &str| {
        kind.split(';').next().is_some_and(|kind| kind.trim().eq_ignore_ascii_case("application/json"))
    };
    let kinds: Vec<&str> = all(header::CONTENT_TYPE).collect();
    if method == Method::POST && !(kinds.len() == 1 && is_json(kinds[0])) {
        return Some((
            StatusCode::UNSUPPORTED_MEDIA_TYPE,
            "unsupported_content_type",
            "send JSON, with the header `Content-Type: application/json`",
        ));
    }
    None
}

/// Returns `true` if a host name with an optional port refers to this machine.
fn is_loopback(authority: &str) -> bool {
    let is_port = |rest: &str| {
        rest.is_empty()
            || rest.strip_prefix(':').is_some_and(|port| port.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let lower = authority.to_ascii_lowercase();
    LOOPBACK.iter().any(|name| lower.strip_prefix(name).is_some_and(is_port))
}

#[cfg(test)]
mod tests {
    use super::is_loopback;

    #[test]
    fn names_of_this_machine() {
        for own in ["127.0.0.1", "127.0.0.1:8090", "localhost:1", "LOCALHOST", "[::1]:80"] {
            assert!(is_loopback(own), "{own}");
        }
        for foreign in [
            "",
            "evil.example",
            "127.0.0.1.evil.example",
            "localhost.evil.example:80",
            "127.0.0.1:80@evil",
            "user@localhost",
            "::1",
            "0.0.0.0",
        ] {
            assert!(!is_loopback(foreign), "{foreign}");
        }
    }
}
