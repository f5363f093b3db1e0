//! A single HTTP exchange, with limits on its duration and the size of its reply.

use super::options::ModelOptions;
use super::spec::Server;
use std::io::{ErrorKind, Read};
use std::time::Duration;
use ureq::http::HeaderValue;
use ureq::http::header::{LOCATION, RETRY_AFTER};
use ureq::{Agent, Error};

/// An HTTP client that sends requests to one server.
pub(super) struct HttpClient {
    agent: Agent,
    reply_limit: u64,
    timeout: Duration,
    connect_timeout: Duration,
}

/// The reason why an exchange yielded no reply.
pub(super) struct HttpError {
    /// The HTTP status, if the reply contained one.
    pub(super) status: Option<u16>,
    pub(super) message: String,
    /// `true` if the server's machine refused the connection, usually because no server is running.
    pub(super) is_refused: bool,
}

#[derive(Clone, Debug)]
pub(super) struct HttpReply {
    pub(super) status: u16,
    pub(super) retry_after: Option<String>,
    pub(super) location: Option<String>,
    pub(super) body: String,
}

impl HttpClient {
    /// Creates a client for `server`. A request may take up to `timeout` in total, and a reply may have up to
    /// `reply_limit` bytes. Proxies from the environment are used, unless the server runs on this machine.
    pub(super) fn new(server: &Server, options: &ModelOptions) -> HttpClient {
        let &ModelOptions { timeout, connect_timeout, reply_limit, .. } = options;
        let mut config = Agent::config_builder()
            .http_status_as_error(false)
            // A redirect could send the key to a different server.
            .max_redirects(0)
            .max_redirects_will_error(false)
            .timeout_global(Some(timeout))
            .timeout_connect(Some(connect_timeout))
            .user_agent(concat!("infinite-arcade/", env!("CARGO_PKG_VERSION")));
        if server.loopback {
            config = config.proxy(None);
        }
        HttpClient { agent: config.build().new_agent(), reply_limit, timeout, connect_timeout }
    }

    /// Posts a JSON body and reads the reply.
    ///
    /// # Errors
    /// Returns an error if the reply is missing, incomplete, too large, or not text.
    pub(super) fn post(
        &self,
        url: &str,
        headers: &[(&'static str, HeaderValue)],
        body: &[u8],
    ) -> Result<HttpReply, HttpError> {
        let mut request = self.agent.post(url).content_type("application/json");
        for (name, value) in headers {
            request = request.header(*name, value.clone());
        }
        let mut response = request.send(body).map_err(|error| HttpError {
            status: None,
            is_refused: matches!(&error, Error::Io(error) if error.kind() == ErrorKind::ConnectionRefused),
            message: self.in_words(error),
        })?;
        let status = response.status().as_u16();
        let header =
            |name| response.headers().get(name).and_then(|value| value.to_str().ok()).map(str::to_owned);
        let (retry_after, location) = (header(RETRY_AFTER), header(LOCATION));
        let mut bytes = Vec::new();
        // Reading one byte beyond the limit detects a reply that is too large.
        let reader = response.body_mut().as_reader().take(self.reply_limit.saturating_add(1));
        let read = { reader }.read_to_end(&mut bytes);
        let broken = |message| HttpError { status: Some(status), message, is_refused: false };
        read.map_err(|error| broken(self.in_words(Error::from(error))))?;
        if bytes.len() as u64 > self.reply_limit {
            return Err(broken(format!("a body of more than {} bytes", self.reply_limit)));
        }
        let body =
            String::from_utf8(bytes).map_err(|_| broken("a body that is not UTF-8 text".to_owned()))?;
        Ok(HttpReply { status, retry_after, location, body })
    }

    fn in_words(&self, error: Error) -> String {
        match error {
            Error::Timeout(ureq::Timeout::Connect) => {
                format!("no connection within {:?}", self.connect_timeout)
            }
            Error::Timeout(_) => format!("no complete answer within {:?}", self.timeout),
            Error::HostNotFound => "the host was not found".to_owned(),
            Error::Io(error) => format!("the connection failed: {error}"),
            other => format!("the request failed: {other}"),
        }
    }
}
