//! OpenAI-compatible chat completions, answered by a player.

use super::bounds::Bounds;
use super::{PromptPlayer, origin, prompt_tokens, seed, tokens};
use crate::client::{ChatMessage, Content, Role};
use crate::error::EvaluationError;
use axum::Router;
use axum::body::{Body, Bytes, HttpBody};
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Json, Response};
use axum::routing::{get, post};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use serde::Deserialize;
use serde_json::{Value, json};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};

/// The pause after a failure to accept a connection because the system has too many open.
const PAUSE: Duration = Duration::from_millis(100);

/// The number of bytes of a request's body that one permit covers.
const UNIT: usize = 1024;

/// A server that is bound to its port but does not answer yet.
#[derive(Debug)]
pub struct Server {
    player: PromptPlayer,
    bounds: Bounds,
    listener: TcpListener,
    address: SocketAddr,
}

impl Server {
    /// Binds a port of 127.0.0.1; any free one for 0. Only this machine can reach it.
    ///
    /// # Errors
    /// The port cannot be bound.
    pub fn bind(player: PromptPlayer, port: u16) -> Result<Server, EvaluationError> {
        let bound = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).and_then(|listener| {
            listener.set_nonblocking(true)?;
            let address = listener.local_addr()?;
            Ok(Server { player, bounds: Bounds::default(), listener, address })
        });
        let place = format!("127.0.0.1:{port}");
        bound.map_err(EvaluationError::io("listen on", place.as_ref()))
    }

    /// Replaces the limits.
    pub fn within(self, bounds: Bounds) -> Server {
        Server { bounds, ..self }
    }

    /// The address of the server.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The base URL for clients.
    pub fn base_url(&self) -> String {
        format!("http://{}/v1", self.address)
    }

    /// Answers until the program ends. A player that thinks for a long time does not delay other requests.
    ///
    /// # Errors
    /// The server cannot be started.
    pub fn run(self) -> Result<(), EvaluationError> {
        self.run_until(std::future::pending())
    }

    /// Answers in the background until the returned handle is dropped.
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
        let serve = || {
            let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
            let router = router(self.player, self.bounds);
            let answered = runtime.block_on(async {
                let listener = tokio::net::TcpListener::from_std(self.listener)?;
                tokio::select! {
                    () = accept(listener, router, self.bounds) => {}
                    () = stopped => {}
                }
                Ok(())
            });
            // Do not wait for a player that is still thinking.
            runtime.shutdown_background();
            answered
        };
        serve().map_err(EvaluationError::io("listen on", place.as_ref()))
    }
}

/// Answers every connection, up to the bounds. Connections beyond them wait in the queue of the operating system.
async fn accept(listener: tokio::net::TcpListener, router: Router, bounds: Bounds) {
    let places = Arc::new(Semaphore::new(bounds.connections));
    loop {
        let place = places.clone().acquire_owned().await.expect("it is never closed");
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let mut http = http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(bounds.head_time);
            // A client that disconnects, or is too slow, is not an error of the server.
            let _ = http.serve_connection(TokioIo::new(stream), service).await;
            drop::<OwnedSemaphorePermit>(place);
        });
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
    /// The base URL for clients.
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
        refusal(StatusCode::NOT_FOUND, "unknown_url", "there is POST /v1/chat/completions and GET /v1/models")
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
        .with_state(Arc::new(Serving {
            player,
            bounds,
            body_memory: Arc::new(Semaphore::new(bounds.bodies / UNIT)),
        }))
}

/// The state needed for an answer.
struct Serving {
    player: PromptPlayer,
    bounds: Bounds,
    /// The memory left for bodies that are being read or answered, in permits.
    body_memory: Arc<Semaphore>,
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

async fn complete(State(serving): State<Arc<Serving>>, body: Body) -> Response {
    let (body, taken) = match read(&serving, body).await {
        Ok(read) => read,
        Err(refusal) => return *refusal,
    };
    let answered = tokio::task::spawn_blocking(move || {
        let answered = completion(&serving.player, &body);
        drop((body, taken));
        answered
    });
    match answered.await {
        Ok(Ok(document)) => Json(document).into_response(),
        Ok(Err(refusal)) => *refusal,
        Err(_) => refusal(StatusCode::INTERNAL_SERVER_ERROR, "player_failed", "the player has failed"),
    }
}

/// Reads a body within the bounds. Room for its stated size, or else for the maximum, is reserved first.
async fn read(serving: &Serving, body: Body) -> Result<(Bytes, OwnedSemaphorePermit), Box<Response>> {
    let Bounds { body: most, bodies, body_time, .. } = serving.bounds;
    let most = most.min(bodies);
    let too_large = || {
        let message = format!("a request has at most {most} bytes");
        Box::new(refusal(StatusCode::PAYLOAD_TOO_LARGE, "unreadable_body", &message))
    };
    // The stated length is reliable: the body has no more bytes than that.
    let stated = HttpBody::size_hint(&body).upper();
    let size = match stated.map(usize::try_from) {
        Some(Ok(size)) if size <= most => size,
        Some(_) => {
            // A client that is still sending could not read the answer.
            let _ = tokio::time::timeout(body_time, discard(body, 2 * most)).await;
            return Err(too_large());
        }
        None => most,
    };
    let read = async {
        let units = u32::try_from(size.div_ceil(UNIT)).expect("no body is that large");
        let memory = serving.body_memory.clone();
        let taken = memory.acquire_many_owned(units).await.expect("it is never closed");
        (axum::body::to_bytes(body, size).await, taken)
    };
    match tokio::time::timeout(body_time, read).await {
        Ok((Ok(bytes), taken)) => Ok((bytes, taken)),
        Ok((Err(_), _)) if stated.is_none() => Err(too_large()),
        Ok((Err(error), _)) => {
            let message = format!("the request was cut off: {error}");
            Err(Box::new(refusal(StatusCode::BAD_REQUEST, "unreadable_body", &message)))
        }
        Err(_) => {
            let message =
                "the request was not received in time, or too many others are in progress; try again";
            Err(Box::new(refusal(StatusCode::REQUEST_TIMEOUT, "request_timeout", message)))
        }
    }
}

/// Reads and discards up to `most` bytes of a body.
async fn discard(body: Body, most: usize) {
    let (mut body, mut left) = (std::pin::pin!(body), most);
    while let Some(Ok(frame)) = std::future::poll_fn(|context| body.as_mut().poll_frame(context)).await {
        left = left.saturating_sub(frame.data_ref().map_or(0, Bytes::len));
        if left == 0 {
            return;
        }
    }
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
    // No player can see pictures.
    Ok(ChatMessage { role, text: message.content.text(), image: None })
}

/// Returns an error in the format of the real APIs.
pub(super) fn refusal(status: StatusCode, code: &str, message: &str) -> Response {
    let kind = if status.is_server_error() { "server_error" } else { "invalid_request_error" };
    let error = json!({"error": {"message": message, "type": kind, "param": null, "code": code}});
    (status, Json(error)).into_response()
}
