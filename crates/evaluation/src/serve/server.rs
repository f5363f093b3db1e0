//! A server for OpenAI-compatible chat completion requests, which a player answers.

use super::refusal::refusal;
use super::{PromptPlayer, origin, prompt_tokens, seed, tokens};
use crate::client::{ChatMessage, Content, Role};
use crate::error::EvaluationError;
use axum::body::Body;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Json, Response};
use axum::routing::{get, post};
use axum::{Extension, Router};
use loopback::{Asker, Bodies, Bounds, Unread};
use serde::Deserialize;
use serde_json::{Value, json};
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;
use tokio::sync::oneshot;

/// A server that is bound to its port but does not serve requests yet.
#[derive(Debug)]
pub struct Server {
    player: PromptPlayer,
    bounds: Bounds,
    listener: TcpListener,
    address: SocketAddr,
}

impl Server {
    /// Binds the given port on 127.0.0.1, or any free port if `port` is 0. Only programs on this machine can
    /// reach the server.
    ///
    /// # Errors
    /// Returns an error if the port cannot be bound.
    pub fn bind(player: PromptPlayer, port: u16) -> Result<Server, EvaluationError> {
        let bound = loopback::bind(port).and_then(|listener| {
            let address = listener.local_addr()?;
            Ok(Server { player, bounds: Bounds::default(), listener, address })
        });
        let place = format!("127.0.0.1:{port}");
        bound.map_err(EvaluationError::io("listen on", place.as_ref()))
    }

    /// Replaces the server's limits.
    pub fn within(self, bounds: Bounds) -> Server {
        Server { bounds, ..self }
    }

    /// Returns the server's address.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Returns the base URL for clients.
    pub fn base_url(&self) -> String {
        format!("http://{}/v1", self.address)
    }

    /// Serves requests until the program ends. A slow player does not delay other requests.
    ///
    /// # Errors
    /// Returns an error if the server cannot be started.
    pub fn run(self) -> Result<(), EvaluationError> {
        self.run_until(std::future::pending())
    }

    /// Serves requests in the background until the returned handle is dropped.
    pub fn spawn(self) -> Running {
        let base_url = self.base_url();
        let (stop, stopped) = oneshot::channel();
        let thread = std::thread::spawn(move || {
            let _ = self.run_until(async {
                let _: Result<(), _> = stopped.await;
            });
        });
        Running { base_url, stop: Some(stop), thread: Some(thread) }
    }

    fn run_until(self, stopped: impl Future<Output = ()> + Send + 'static) -> Result<(), EvaluationError> {
        let place = self.address.to_string();
        let router = router(self.player, self.bounds);
        // Stopping does not wait for a player that is still thinking.
        let answered = loopback::answer(self.listener, router, self.bounds, stopped);
        answered.map_err(EvaluationError::io("listen on", place.as_ref()))
    }
}

/// A running server. Dropping it stops the server.
#[derive(Debug)]
pub struct Running {
    base_url: String,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Running {
    /// Returns the base URL for clients.
    pub fn base_url(&self) -> &str {
        &self.base_url
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn router(player: PromptPlayer, bounds: Bounds) -> Router {
    let no_route = || async {
        refusal(
            StatusCode::NOT_FOUND,
            "unknown_url",
            "unknown endpoint; use POST /v1/chat/completions or GET /v1/models",
        )
    };
    let no_method = || async {
        refusal(
            StatusCode::METHOD_NOT_ALLOWED,
            "method_not_supported",
            "use POST for /v1/chat/completions, GET for /v1/models",
        )
    };
    Router::new()
        .route("/v1/chat/completions", post(complete))
        .route("/v1/models", get(models))
        .fallback(no_route)
        .method_not_allowed_fallback(no_method)
        .layer(axum::middleware::from_fn(origin::check))
        .with_state(Arc::new(Serving { player, bodies: Bodies::new(bounds) }))
}

/// The state needed to answer a request.
struct Serving {
    player: PromptPlayer,
    bodies: Bodies,
}

/// The relevant fields of a request. Sampling parameters are ignored.
#[derive(Deserialize)]
struct Request {
    model: String,
    messages: Vec<Message>,
    #[serde(default)]
    stream: bool,
    n: Option<u32>,
}

#[derive(Deserialize)]
struct Message {
    role: String,
    content: Content,
}

async fn models(State(serving): State<Arc<Serving>>) -> Json<Value> {
    let id = serving.player.to_string();
    Json(json!({
        "object": "list",
        "data": [{"id": id, "object": "model", "created": 0, "owned_by": "infinite-arcade"}],
    }))
}

async fn complete(
    State(serving): State<Arc<Serving>>,
    Extension(asker): Extension<Asker>,
    body: Body,
) -> Response {
    let (body, taken) = match serving.bodies.read(body).await {
        Ok(read) => read,
        Err(why) => return unreadable(&why),
    };
    // The request is complete, so keeping its connection open until the player answers does not block other
    // clients.
    let _kept = asker.keep();
    let answered = tokio::task::spawn_blocking(move || {
        let answered = completion(&serving.player, &body);
        drop((body, taken));
        answered
    });
    match answered.await {
        Ok(Ok(document)) => Json(document).into_response(),
        Ok(Err(refusal)) => *refusal,
        Err(_) => refusal(StatusCode::INTERNAL_SERVER_ERROR, "player_failed", "the player failed"),
    }
}

/// Returns the response to a request with an unreadable body.
fn unreadable(why: &Unread) -> Response {
    let (status, code) = match why {
        Unread::TooLarge(_) => (StatusCode::PAYLOAD_TOO_LARGE, "unreadable_body"),
        Unread::CutOff(_) => (StatusCode::BAD_REQUEST, "unreadable_body"),
        Unread::Late => (StatusCode::REQUEST_TIMEOUT, "request_timeout"),
    };
    refusal(status, code, &why.to_string())
}

fn completion(player: &PromptPlayer, body: &[u8]) -> Result<Value, Box<Response>> {
    let bad = |code, message: &str| Box::new(refusal(StatusCode::BAD_REQUEST, code, message));
    let request: Request =
        serde_json::from_slice(body).map_err(|error| bad("invalid_json", &error.to_string()))?;
    let name = player.to_string();
    if request.model != name {
        let message = format!("the model `{}` does not exist; this server has `{name}`", request.model);
        return Err(Box::new(refusal(StatusCode::NOT_FOUND, "model_not_found", &message)));
    }
    if request.stream || request.n.is_some_and(|n| n != 1) {
        return Err(bad(
            "unsupported_value",
            "only one complete answer at a time is supported: remove `stream`, and set `n` to 1",
        ));
    }
    let messages = request.messages.into_iter().map(message).collect::<Result<Vec<_>, String>>();
    let messages = messages.map_err(|error| bad("invalid_role", &error))?;
    let answer = player.answer(&messages).map_err(|error| bad("unanswerable", &error.to_string()))?;
    let (prompt, said) = (prompt_tokens(&messages), tokens(&answer));
    let id = seed(&messages).to_string();
    Ok(json!({
        "id": format!("chatcmpl-{}", &id[..24.min(id.len())]),
        "object": "chat.completion",
        "created": 0,
        "model": name,
        "choices": [{
            "index": 0,
            "message": {"role": "assistant", "content": answer, "refusal": null},
            "logprobs": null,
            "finish_reason": "stop",
        }],
        "usage": {"prompt_tokens": prompt, "completion_tokens": said, "total_tokens": prompt + said},
    }))
}

fn message(message: Message) -> Result<ChatMessage, String> {
    let role = match message.role.as_str() {
        "system" | "developer" => Role::System,
        "user" => Role::User,
        "assistant" => Role::Assistant,
        other => return Err(format!("unknown role `{other}`; use system, user or assistant")),
    };
    // Served players cannot see images.
    Ok(ChatMessage { role, text: message.content.text(), image: None })
}
