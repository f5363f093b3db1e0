//! API keys, read from the environment and sent only to the provider.

use crate::error::EvaluationError;
use std::fmt;
use ureq::http::HeaderValue;

/// An API key. The type has no `Display` implementation, and its `Debug` implementation hides the key.
#[derive(Clone)]
pub(super) struct Key {
    pub(super) variable: String,
    secret: String,
}

/// The minimum length, in bytes, of keys that are searched for in answers. A shorter key could be an ordinary word.
const MIN_SEARCHED: usize = 16;

/// The text that replaces a key in a server's reply.
const HIDDEN: &str = "[key]";

/// Reads an environment variable. The client reads only variables that contain keys.
#[expect(
    clippy::disallowed_methods,
    reason = "keys come only from the environment, and never affect an action"
)]
pub(super) fn environment(variable: &str) -> Option<String> {
    std::env::var(variable).ok()
}

impl Key {
    /// Reads the key from a variable in `environment`. Returns `None` if the variable is unset or empty.
    pub(super) fn read(
        variable: &str,
        environment: &dyn Fn(&str) -> Option<String>,
    ) -> Result<Option<Key>, EvaluationError> {
        let Some(value) = environment(variable) else { return Ok(None) };
        let secret = value.trim();
        if secret.is_empty() {
            return Ok(None);
        }
        if !secret.bytes().all(|byte| byte.is_ascii_graphic()) {
            let problem = format!(
                "the value of {variable} contains characters that keys cannot contain; set the variable again"
            );
            return Err(EvaluationError::Malformed(problem));
        }
        Ok(Some(Key { variable: variable.to_owned(), secret: secret.to_owned() }))
    }

    /// Returns the header value that consists of `prefix` and the key.
    pub(super) fn header(&self, prefix: &str) -> HeaderValue {
        let value = HeaderValue::from_str(&format!("{prefix}{}", self.secret));
        let mut value = value.expect("keys are visible ASCII");
        value.set_sensitive(true);
        value
    }

    /// Replaces the key with [`HIDDEN`] in a server's error message.
    pub(super) fn hide_in_message(&self, words: &str) -> String {
        words.replace(&self.secret, HIDDEN)
    }

    pub(super) fn hide_in_answer(&self, text: String) -> String {
        if self.secret.len() >= MIN_SEARCHED && text.contains(&self.secret) {
            return self.hide_in_message(&text);
        }
        text
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Key({})", self.variable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(value: &'static str) -> Result<Option<Key>, EvaluationError> {
        Key::read("SOME_API_KEY", &move |name: &str| (name == "SOME_API_KEY").then(|| value.to_owned()))
    }

    #[test]
    fn invalid_keys_are_rejected() {
        assert!(read("").unwrap().is_none());
        assert!(read(" \n").unwrap().is_none());
        assert!(Key::read("OTHER", &|_| None).unwrap().is_none());
        let problem = read("sk-zebra zebra").unwrap_err().to_string();
        assert!(problem.contains("SOME_API_KEY") && !problem.contains("zebra"), "{problem}");
    }

    #[test]
    fn keys_are_not_shown() {
        let key = read("sk-zebra-0123456789\n").unwrap().unwrap();
        assert_eq!(format!("{key:?}"), "Key(SOME_API_KEY)");
        assert!(!format!("{:?}", key.header("Bearer ")).contains("zebra"));
        assert_eq!(key.header("Bearer ").to_str().unwrap(), "Bearer sk-zebra-0123456789");
        assert_eq!(key.hide_in_message("no such key: sk-zebra-0123456789."), "no such key: [key].");
        assert_eq!(key.hide_in_answer("{\"sk-zebra-0123456789\"}".to_owned()), "{\"[key]\"}");
        let short = read("up").unwrap().unwrap();
        assert_eq!(short.hide_in_answer("Action: up".to_owned()), "Action: up", "a word, not the key");
    }
}
