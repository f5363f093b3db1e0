//! Checks that precede every response. Requests are accepted only from the page that this server has served and that
//! was opened with the server's token.
//!
//! A page from any website can make a browser send requests to 127.0.0.1, and any program on this machine can
//! send them, too. Requests from foreign pages are recognised by the requested host name (which DNS rebinding
//! cannot hide), by the origin, and by the site that the browser reports. Foreign pages and other programs do
//! not know the token, which is only in the address printed by `arcade studio`.

use crate::refusal::Refusal;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use loopback::Asker;
use std::fmt::Write;
use std::sync::Arc;

/// The header that carries the token.
const TOKEN: HeaderName = HeaderName::from_static("x-arcade-token");
const FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// The page's content security policy. It allows the page to load only its own files, and images created from
/// data.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The host names and the token that requests must have.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    /// The accepted hosts: `127.0.0.1:PORT` and `localhost:PORT`.
    hosts: [String; 2],
    token: Arc<str>,
}

impl Guard {
    /// Creates a guard for the given port, with a fresh token.
    pub(crate) fn of(port: u16) -> std::io::Result<Guard> {
        let mut bytes = [0; 24];
        getrandom::fill(&mut bytes).map_err(std::io::Error::other)?;
        let mut token = String::new();
        for byte in bytes {
            let _ = write!(token, "{byte:02x}");
        }
        let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        Ok(Guard { hosts, token: token.into() })
    }

    pub(crate) fn token(&self) -> &str {
        &self.token
    }

    /// Returns the reason for rejecting a request with the given headers, or `None` if the request is
    /// accepted.
    fn problem(&self, path: &str, headers: &HeaderMap) -> Option<Refusal> {
        let all = |name: &HeaderName| -> Vec<&str> {
            headers.get_all(name).iter().map(|value| value.to_str().unwrap_or_default()).collect()
        };
        let forbidden = |error: &str| {
            Some(Refusal::forbidden(error).help("open the address that `arcade studio` printed"))
        };
        let own = |host: &str| self.hosts.iter().any(|own| host.eq_ignore_ascii_case(own));
        if !matches!(all(&header::HOST)[..], [host] if own(host)) {
            return forbidden("this server answers only requests to its own address");
        }
        let own_origin = |origin: &&str| origin.strip_prefix("http://").is_some_and(own);
        if !all(&header::ORIGIN).iter().all(own_origin) {
            return forbidden("this server rejects requests from pages of other origins");
        }
        if path != "/api" && !path.starts_with("/api/") {
            return None;
        }
        if !all(&FETCH_SITE).iter().all(|site| ["same-origin", "none"].contains(site)) {
            return forbidden("this server rejects requests from pages of other sites");
        }
        if !matches!(all(&TOKEN)[..], [token] if equal(token, &self.token)) {
            return forbidden("the token is missing or wrong");
        }
        None
    }
}

/// Compares two texts in a time that does not depend on the position of their first difference.
fn equal(one: &str, other: &str) -> bool {
    let differences = one.bytes().zip(other.bytes()).fold(0, |seen, (a, b)| seen | (a ^ b));
    one.len() == other.len() && differences == 0
}

/// Rejects requests that fail the guard's checks, and adds the security headers to every response.
pub(crate) async fn check(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let mut response = match guard.problem(request.uri().path(), request.headers()) {
        None => {
            let path = request.uri().path();
            let is_asked = path == "/api" || path.starts_with("/api/");
            // A client with the token is not disconnected in favour of a client that may not have it.
            if let Some(asker) = request.extensions().get::<Asker>().filter(|_| is_asked) {
                asker.trust();
            }
            next.run(request).await
        }
        Some(refusal) => refusal.into_response(),
    };
    let headers = response.headers_mut();
    let mut set =
        |name: HeaderName, value: &'static str| headers.insert(name, HeaderValue::from_static(value));
    set(header::CONTENT_SECURITY_POLICY, POLICY);
    set(header::X_CONTENT_TYPE_OPTIONS, "nosniff");
    set(header::REFERRER_POLICY, "no-referrer");
    set(header::CACHE_CONTROL, "no-store");
    set(HeaderName::from_static("cross-origin-resource-policy"), "same-origin");
    response
}

/// Rejects a method that the path does not support.
pub(crate) async fn no_method() -> Response {
    Refusal::new(StatusCode::METHOD_NOT_ALLOWED, "this path does not support this method").into_response()
}
