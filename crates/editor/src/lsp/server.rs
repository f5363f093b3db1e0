//! The state of a session, and the handling of its messages.

use super::answers::{self, Refusal};
use super::documents::Documents;
use crate::positions::Unit;
use serde_json::{Value, json};

/// A session's phases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    /// The phase before `initialize`.
    #[default]
    Fresh,
    /// The phase after `initialize`.
    Running,
    /// The phase after `shutdown`.
    ShutDown,
}

/// A session with a client.
#[derive(Debug)]
pub(super) struct Server {
    phase: Phase,
    is_left: bool,
    unit: Unit,
    documents: Documents,
}

impl Default for Server {
    fn default() -> Server {
        let (phase, documents) = (Phase::default(), Documents::default());
        Server { phase, is_left: false, unit: Unit::Utf16, documents }
    }
}

/// Returns the response to a message that cannot be parsed.
pub(super) fn unreadable(reason: &str) -> Value {
    failure(&Value::Null, -32700, reason)
}

fn failure(id: &Value, code: i64, message: &str) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code, "message": message } })
}

impl Server {
    /// Returns `true` once the client has requested a shutdown.
    pub(super) fn is_shut_down(&self) -> bool {
        self.phase == Phase::ShutDown
    }

    /// Returns `true` once the client has left.
    pub(super) fn is_left(&self) -> bool {
        self.is_left
    }

    /// Returns the responses to a message.
    pub(super) fn receive(&mut self, bytes: &[u8]) -> Vec<Value> {
        let message: Value = match serde_json::from_slice(bytes) {
            Ok(message) => message,
            Err(error) => return vec![unreadable(&format!("the message isn't valid JSON: {error}"))],
        };
        let params = message.get("params").unwrap_or(&Value::Null);
        match (message.get("method").and_then(Value::as_str), message.get("id")) {
            (Some(method), Some(id)) => vec![match self.request(method, params) {
                Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
                Err(refusal) => failure(id, refusal.code(), &refusal.to_string()),
            }],
            (Some(method), None) => self.notification(method, params),
            // The message is a response, but the server sends no requests.
            (None, Some(_)) if message.get("result").is_some() || message.get("error").is_some() => {
                Vec::new()
            }
            (None, id) => {
                vec![failure(id.unwrap_or(&Value::Null), -32600, "the message has no method")]
            }
        }
    }

    fn request(&mut self, method: &str, params: &Value) -> Result<Value, Refusal> {
        match (self.phase, method) {
            (Phase::Fresh, "initialize") => Ok(self.initialize(params)),
            (Phase::Fresh, _) => Err(Refusal::TooEarly),
            (Phase::Running, "initialize") | (Phase::ShutDown, _) => Err(Refusal::TooLate),
            (Phase::Running, "shutdown") => {
                self.phase = Phase::ShutDown;
                Ok(Value::Null)
            }
            (Phase::Running, _) => answers::answer(&self.documents, self.unit, method, params),
        }
    }

    fn notification(&mut self, method: &str, params: &Value) -> Vec<Value> {
        let uri = || params.pointer("/textDocument/uri").and_then(Value::as_str);
        let done = match method {
            "exit" => {
                self.is_left = true;
                Some(())
            }
            _ if self.phase != Phase::Running => Some(()),
            "textDocument/didOpen" => params.get("textDocument").and_then(|item| self.documents.open(item)),
            "textDocument/didChange" => self.documents.change(params, self.unit),
            "textDocument/didSave" => uri().map(|uri| self.documents.touch_levels(uri)),
            "textDocument/didClose" => {
                let Some(uri) = uri() else { return Vec::new() };
                self.documents.0.remove(uri);
                self.documents.touch_levels(uri);
                return vec![answers::published(uri, &Value::Null, &Value::Array(Vec::new()))];
            }
            _ => Some(()),
        };
        match done {
            Some(()) => Vec::new(),
            None => {
                let message = format!("arcade lsp cannot read the parameters of {method}");
                vec![
                    json!({ "jsonrpc": "2.0", "method": "window/logMessage", "params": { "type": 1, "message": message } }),
                ]
            }
        }
    }

    fn initialize(&mut self, params: &Value) -> Value {
        self.phase = Phase::Running;
        let encodings = params.pointer("/capabilities/general/positionEncodings").and_then(Value::as_array);
        let counts_bytes = encodings.is_some_and(|all| all.iter().any(|encoding| encoding == "utf-8"));
        self.unit = if counts_bytes { Unit::Byte } else { Unit::Utf16 };
        let prepares =
            params.pointer("/capabilities/textDocument/rename/prepareSupport") == Some(&Value::Bool(true));
        json!({
            "capabilities": {
                "positionEncoding": if counts_bytes { "utf-8" } else { "utf-16" },
                "textDocumentSync": { "openClose": true, "change": 2, "save": true },
                "hoverProvider": true,
                "completionProvider": { "triggerCharacters": [" ", "=", ",", ">"] },
                "definitionProvider": true,
                "referencesProvider": true,
                "renameProvider": if prepares { json!({ "prepareProvider": true }) } else { json!(true) },
                "documentFormattingProvider": true,
                "documentSymbolProvider": true,
                "codeActionProvider": { "codeActionKinds": ["quickfix"] },
            },
            "serverInfo": { "name": "arcade lsp", "version": env!("CARGO_PKG_VERSION") },
        })
    }

    /// Returns the problems of the documents that have changed since the last call.
    pub(super) fn published(&mut self) -> Vec<Value> {
        let mut messages = Vec::new();
        let changed = |documents: &Documents| {
            let found = documents.0.iter().find(|(_, document)| document.is_changed);
            found.map(|(uri, _)| uri.clone())
        };
        while let Some(uri) = changed(&self.documents) {
            let problems = answers::diagnostics(&self.documents, self.unit, &uri);
            if let Some(document) = self.documents.0.get_mut(&uri) {
                document.is_changed = false;
                messages.push(answers::published(&uri, &document.version, &problems));
            }
        }
        messages
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: [i64; 0] = [];

    fn codes(server: &mut Server, message: &Value) -> Vec<i64> {
        let answers = server.receive(message.to_string().as_bytes());
        answers.iter().filter_map(|answer| answer.pointer("/error/code")?.as_i64()).collect()
    }

    #[test]
    fn messages_out_of_turn_are_refused() {
        let mut server = Server::default();
        let request = |method: &str| json!({ "jsonrpc": "2.0", "id": 1, "method": method, "params": {} });
        assert_eq!(codes(&mut server, &request("textDocument/hover")), [-32002]);
        assert_eq!(codes(&mut server, &request("initialize")), NONE);
        assert_eq!(codes(&mut server, &request("initialize")), [-32600]);
        assert_eq!(codes(&mut server, &request("nonsense")), [-32601]);
        assert_eq!(codes(&mut server, &request("textDocument/hover")), [-32602]);
        assert_eq!(codes(&mut server, &request("shutdown")), NONE);
        assert_eq!(codes(&mut server, &request("textDocument/hover")), [-32600]);
        assert!(server.is_shut_down() && !server.is_left());
        assert_eq!(codes(&mut server, &json!({ "jsonrpc": "2.0", "method": "exit" })), NONE);
        assert!(server.is_left());
    }

    #[test]
    fn messages_of_no_shape_are_answered() {
        let mut server = Server::default();
        for (bytes, code) in
            [(&b"{"[..], -32700), (b"\xff", -32700), (b"[]", -32600), (b"5", -32600), (b"{\"id\":3}", -32600)]
        {
            let answers = server.receive(bytes);
            assert_eq!(answers[0].pointer("/error/code"), Some(&json!(code)), "{bytes:?}");
        }
        assert_eq!(server.receive(b"{\"id\":3,\"result\":null}"), Vec::<Value>::new());
        let deep = "[".repeat(1 << 20);
        assert_eq!(server.receive(deep.as_bytes()).len(), 1);
    }
}
