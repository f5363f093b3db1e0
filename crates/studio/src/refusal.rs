//! The response to an unsuccessful request: a status, a message, and advice.

use axum::http::StatusCode;
use axum::response::{IntoResponse, Json, Response};
use serde_json::{Map, Value, json};
use std::fmt;

/// The reason why a request has failed.
#[derive(Debug)]
pub(crate) struct Refusal {
    status: StatusCode,
    error: String,
    help: Option<String>,
    /// Additional fields in the response.
    more: Map<String, Value>,
}

impl Refusal {
    pub(crate) fn new(status: StatusCode, error: impl fmt::Display) -> Refusal {
        Refusal { status, error: error.to_string(), help: None, more: Map::new() }
    }

    /// Creates the error response to an invalid request.
    pub(crate) fn bad(error: impl fmt::Display) -> Refusal {
        Refusal::new(StatusCode::BAD_REQUEST, error)
    }

    /// Creates the error response to a request about an item that does not exist.
    pub(crate) fn missing(error: impl fmt::Display) -> Refusal {
        Refusal::new(StatusCode::NOT_FOUND, error)
    }

    /// Creates the error response to a valid request that is not allowed.
    pub(crate) fn forbidden(error: impl fmt::Display) -> Refusal {
        Refusal::new(StatusCode::FORBIDDEN, error)
    }

    /// Creates the error response after a failure of the machine, such as an I/O error or a lack of memory.
    pub(crate) fn failed(error: impl fmt::Display) -> Refusal {
        Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, error)
    }

    /// Adds advice on what to do next.
    pub(crate) fn help(self, help: impl fmt::Display) -> Refusal {
        Refusal { help: Some(help.to_string()), ..self }
    }

    /// Adds a field to the response.
    pub(crate) fn with(mut self, key: &str, value: impl Into<Value>) -> Refusal {
        self.more.insert(key.to_owned(), value.into());
        self
    }

    /// Returns the message and the advice.
    pub(crate) fn text(&self) -> String {
        match &self.help {
            Some(help) => format!("{}; {help}", self.error),
            None => self.error.clone(),
        }
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let mut document = json!({ "error": self.error, "help": self.help });
        for (key, value) in self.more {
            document[key] = value;
        }
        (self.status, Json(document)).into_response()
    }
}
