//! Model IDs such as `openai:gpt-4o-mini`, and their servers.

use super::provider::Provider;
use crate::error::EvaluationError;
use std::net::IpAddr;
use ureq::http::Uri;

/// A model and its server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelSpec {
    /// The server's API.
    pub provider: Provider,
    /// The server's name for the model.
    pub model: String,
    /// The server that hosts the model.
    pub server: Server,
}

/// A server that hosts models.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Server {
    /// The base URL for API paths, without a trailing slash.
    pub base_url: String,
    /// The host, with the port if the URL contains one.
    pub host: String,
    /// `true` if the server runs on this machine.
    pub loopback: bool,
    /// `true` if the connection is encrypted.
    pub encrypted: bool,
    /// `true` if the server belongs to the provider.
    pub own: bool,
}

impl ModelSpec {
    /// Parses a model ID as typed by users: `openai:…`, `anthropic:…` or `gemini:…`. With a base URL, any
    /// name is accepted, and the server is assumed to be OpenAI-compatible. If both a prefix and a base URL
    /// are given, the prefix determines the API of the server at that URL.
    ///
    /// # Errors
    /// Returns an error if the ID or the URL is malformed. The message shows the expected form.
    pub fn parse(id: &str, base_url: Option<&str>) -> Result<ModelSpec, EvaluationError> {
        let prefixed =
            id.split_once(':').and_then(|(prefix, model)| Some((Provider::from_prefix(prefix)?, model)));
        let (provider, model) = match (prefixed, base_url) {
            (Some(found), _) => found,
            // The names of local models can contain colons, as in `qwen3:32b`.
            (None, Some(_)) => (Provider::Compatible, id),
            (None, None) => return Err(EvaluationError::Malformed(unknown(id))),
        };
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.:/@+".contains(c);
        if model.is_empty() || !model.chars().all(plain) || model.contains("..") {
            let problem = format!(
                "`{model}` isn't a valid model name; use letters, digits and `-_.:/@+`, as in \
                 `openai:gpt-4o-mini`"
            );
            return Err(EvaluationError::Malformed(problem));
        }
        let own = provider.own_url();
        let url = base_url.or(own).expect("the provider has a server of its own, or a base URL was given");
        let mut server = Server::parse(url)?;
        server.own = own.is_some_and(|own| Server::parse(own).is_ok_and(|own| own.host == server.host));
        Ok(ModelSpec { provider, model: model.to_owned(), server })
    }
}

/// Returns the error message for an ID without a known prefix.
fn unknown(id: &str) -> String {
    let starts = [
        ("gpt", "openai"),
        ("o1", "openai"),
        ("o3", "openai"),
        ("o4", "openai"),
        ("chatgpt", "openai"),
        ("claude", "anthropic"),
        ("gemini", "gemini"),
    ];
    let guess = starts.iter().find(|(start, _)| id.starts_with(start));
    let guess = guess.map(|(_, prefix)| format!("{prefix}:{id}")).or_else(|| {
        let (prefix, model) = id.split_once(':')?;
        let near = engine::nearest(prefix, ["openai", "anthropic", "gemini"])?;
        Some(format!("{near}:{model}"))
    });
    let guess = guess.map(|guess| format!("; did you mean `{guess}`?")).unwrap_or_default();
    format!(
        "`{id}` does not name the model's provider{guess}\n  pass `openai:NAME`, `anthropic:NAME` or \
         `gemini:NAME`, or the server's address: `--base-url http://localhost:8000/v1`"
    )
}

impl Server {
    fn parse(url: &str) -> Result<Server, EvaluationError> {
        let malformed = |problem: &str| {
            // The message does not repeat the URL, which may contain a password.
            EvaluationError::Malformed(format!(
                "the base URL {problem}; use one like `http://localhost:8000/v1` or `https://example.org/v1`"
            ))
        };
        let uri: Uri = url.trim().parse().map_err(|_| malformed("is not a URL"))?;
        let encrypted = match uri.scheme_str() {
            Some("https") if !cfg!(feature = "https") => {
                return Err(malformed("needs https, but this program was built without the `https` feature"));
            }
            Some("https") => true,
            Some("http") => false,
            _ => return Err(malformed("does not begin with http:// or https://")),
        };
        let authority = uri.authority().ok_or_else(|| malformed("has no host"))?;
        if authority.as_str().contains('@') {
            return Err(malformed(
                "contains a user name or password, which belongs in an environment variable",
            ));
        }
        let port = authority.as_str()[authority.host().len()..].strip_prefix(':');
        if port.is_some_and(|port| !matches!(port.parse::<u16>(), Ok(1..))) {
            return Err(malformed("has a port that is not a number from 1 to 65535"));
        }
        if uri.query().is_some() {
            return Err(malformed("has a query string"));
        }
        let host = authority.host();
        let bare = host.trim_start_matches('[').trim_end_matches(']');
        let address = bare.parse::<IpAddr>();
        let loopback =
            host.eq_ignore_ascii_case("localhost") || address.is_ok_and(|address| address.is_loopback());
        let path = uri.path().trim_end_matches('/');
        Ok(Server {
            base_url: format!("{}://{authority}{path}", if encrypted { "https" } else { "http" }),
            host: authority.to_string(),
            loopback,
            encrypted,
            own: false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(id: &str, base_url: Option<&str>, expect: Result<(Provider, &str, &str), &str>) {
        match (ModelSpec::parse(id, base_url), expect) {
            (Ok(spec), Ok((provider, model, url))) => {
                assert_eq!(
                    (spec.provider, spec.model.as_str(), spec.server.base_url.as_str()),
                    (provider, model, url)
                );
            }
            (Err(problem), Err(words)) => assert!(problem.to_string().contains(words), "{problem}"),
            (found, expect) => panic!("{id} at {base_url:?}: {found:?}, not {expect:?}"),
        }
    }

    #[test]
    fn ids() {
        use Provider::{Anthropic, Compatible, Gemini, OpenAi};
        let local = Some("http://localhost:11434/v1/");
        check("openai:gpt-4o-mini", None, Ok((OpenAi, "gpt-4o-mini", "https://api.openai.com/v1")));
        check("anthropic:claude-x", None, Ok((Anthropic, "claude-x", "https://api.anthropic.com/v1")));
        let gemini = "https://generativelanguage.googleapis.com/v1beta";
        check("gemini:gemini-x", None, Ok((Gemini, "gemini-x", gemini)));
        check("qwen3:32b", local, Ok((Compatible, "qwen3:32b", "http://localhost:11434/v1")));
        check("org/model-7B", local, Ok((Compatible, "org/model-7B", "http://localhost:11434/v1")));
        check("openai:gpt-x", local, Ok((OpenAi, "gpt-x", "http://localhost:11434/v1")));
        check("gpt-4o-mini", None, Err("did you mean `openai:gpt-4o-mini`?"));
        check("claude-x", None, Err("did you mean `anthropic:claude-x`?"));
        check("opnai:gpt-4o-mini", None, Err("did you mean `openai:gpt-4o-mini`?"));
        check("mcts", None, Err("--base-url"));
        check("openai:", None, Err("isn't a valid model name"));
        check("gemini:../x", None, Err("isn't a valid model name"));
        check("a model", local, Err("isn't a valid model name"));
    }

    #[test]
    fn servers() {
        let server = |url: &str| ModelSpec::parse("m", Some(url)).unwrap().server;
        for url in ["http://localhost:1", "http://127.0.0.1:8000/v1", "http://[::1]:8/v1"] {
            assert!(server(url).loopback, "{url}");
        }
        for url in ["http://10.0.0.1/v1", "https://localhost.example.org/v1", "http://127.0.0.1.example.org"]
        {
            assert!(!server(url).loopback, "{url}");
        }
        let own = ModelSpec::parse("openai:m", Some("https://api.openai.com/v1")).unwrap();
        assert!(own.server.own);
        assert!(!ModelSpec::parse("openai:m", Some("https://example.org/v1")).unwrap().server.own);
    }

    #[test]
    fn bad_urls_are_reported_without_their_passwords() {
        for (url, words) in [
            ("localhost:8000", "http://"),
            ("ftp://example.org", "http://"),
            ("https://me:zebra@example.org/v1", "password"),
            ("https://example.org/v1?key=zebra", "query"),
            ("not a url", "is not a URL"),
            ("http://127.0.0.1:99999/v1", "from 1 to 65535"),
            ("http://127.0.0.1:0/v1", "from 1 to 65535"),
            ("http://[::1]:99999/v1", "from 1 to 65535"),
        ] {
            let problem = ModelSpec::parse("m", Some(url)).unwrap_err().to_string();
            assert!(problem.contains(words), "{url}: {problem}");
            assert!(!problem.contains("zebra"), "{problem}");
        }
    }
}
