//! Handling of requests. Bodies are read within limits, and a bounded number of threads does the work.

use crate::lines::{Ended, Lines};
use crate::refusal::Refusal;
use crate::studio::Studio;
use axum::body::Body;
use axum::extract::{Path, Request, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{MethodFilter, MethodRouter, get, on, post};
use loopback::{Bodies, Bounds, Unread};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tokio::sync::Semaphore;

/// The number of threads for short responses.
const SHORT: usize = 6;
/// The number of threads for responses sent line by line.
const LONG: usize = 6;
/// The number of threads that work on responses.
pub(crate) const THREADS: usize = SHORT + LONG;

/// The shared state of the server.
#[derive(Clone)]
pub(crate) struct Serving {
    studio: Arc<Studio>,
    bodies: Bodies,
    short: Arc<Semaphore>,
    long: Arc<Semaphore>,
}

impl Serving {
    pub(crate) fn new(studio: Studio, bounds: Bounds) -> Serving {
        Serving {
            studio: Arc::new(studio),
            bodies: Bodies::new(bounds),
            short: Arc::new(Semaphore::new(SHORT)),
            long: Arc::new(Semaphore::new(LONG)),
        }
    }

    /// Runs work on one of the threads for short responses.
    async fn answer<O: Serialize>(
        self,
        work: impl FnOnce(&Studio) -> Result<O, Refusal> + Send + 'static,
    ) -> Response {
        let short = self.short.clone();
        self.answer_in(short, work).await
    }

    /// Runs work on one of `threads` as soon as a thread is free.
    async fn answer_in<O: Serialize>(
        self,
        threads: Arc<Semaphore>,
        work: impl FnOnce(&Studio) -> Result<O, Refusal> + Send + 'static,
    ) -> Response {
        let Ok(place) = threads.acquire_owned().await else { return broken() };
        let studio = self.studio;
        let done = tokio::task::spawn_blocking(move || {
            // The JSON is also written on this thread, because that may take as much work as the rest.
            let answer = work(&studio).map(|answer| serde_json::to_vec(&answer));
            drop(place);
            answer
        });
        match done.await {
            Ok(Ok(Ok(document))) => ([(header::CONTENT_TYPE, "application/json")], document).into_response(),
            Ok(Err(refusal)) => refusal.into_response(),
            Ok(Ok(Err(_))) | Err(_) => broken(),
        }
    }

    async fn read<I: DeserializeOwned>(&self, body: Body) -> Result<I, Refusal> {
        let (bytes, _taken) = self.bodies.read(body).await.map_err(|why| {
            let status = match why {
                Unread::TooLarge(_) => StatusCode::PAYLOAD_TOO_LARGE,
                Unread::CutOff(_) => StatusCode::BAD_REQUEST,
                Unread::Late => StatusCode::REQUEST_TIMEOUT,
            };
            Refusal::new(status, why)
        })?;
        let bytes: &[u8] = if bytes.is_empty() { b"{}" } else { &bytes };
        serde_json::from_slice(bytes)
            .map_err(|error| Refusal::bad(format_args!("the request is malformed: {error}")))
    }
}

/// Returns the response for work that panicked because of a bug in this program.
fn broken() -> Response {
    Refusal::failed("the studio failed because of a bug")
        .help("please report the bug, and include the game")
        .into_response()
}

/// Returns the route for a request without a body.
pub(crate) fn told<O: Serialize + 'static>(work: fn(&Studio) -> Result<O, Refusal>) -> MethodRouter<Serving> {
    get(move |State(serving): State<Serving>| serving.answer(work))
}

/// Returns the route for a request about a game.
pub(crate) fn of_game<O: Serialize + 'static>(
    work: fn(&Studio, &str) -> Result<O, Refusal>,
) -> MethodRouter<Serving> {
    get(move |State(serving): State<Serving>, Path(id): Path<String>| {
        serving.answer(move |studio| work(studio, &id))
    })
}

/// Returns the route for a request about part of a game.
pub(crate) fn of_part<O: Serialize + 'static>(
    work: fn(&Studio, &str, &str) -> Result<O, Refusal>,
) -> MethodRouter<Serving> {
    get(move |State(serving): State<Serving>, Path((id, part)): Path<(String, String)>| {
        serving.answer(move |studio| work(studio, &id, &part))
    })
}

/// Returns the route for a request with the given method that changes part of a game.
pub(crate) fn change_part<I: DeserializeOwned + Send + 'static, O: Serialize + 'static>(
    method: MethodFilter,
    work: fn(&Studio, &str, &str, I) -> Result<O, Refusal>,
) -> MethodRouter<Serving> {
    let answer = move |State(serving): State<Serving>,
                       Path((id, part)): Path<(String, String)>,
                       body: Body| async move {
        match serving.read(body).await {
            Ok(asked) => serving.answer(move |studio| work(studio, &id, &part, asked)).await,
            Err(refusal) => refusal.into_response(),
        }
    };
    on(method, answer)
}

/// Returns the route for a request with a body.
pub(crate) fn asked<I: DeserializeOwned + Send + 'static, O: Serialize + 'static>(
    work: fn(&Studio, I) -> Result<O, Refusal>,
) -> MethodRouter<Serving> {
    let answer = move |State(serving): State<Serving>, body: Body| async move {
        match serving.read(body).await {
            Ok(asked) => serving.answer(move |studio| work(studio, asked)).await,
            Err(refusal) => refusal.into_response(),
        }
    };
    post(answer)
}

/// A flag that is set once the client is no longer waiting for the response.
pub(crate) struct Asker(Arc<AtomicBool>);

impl Asker {
    /// Returns `true` if the client has left, so that the work can end.
    pub(crate) fn is_gone(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A waiting client. The server drops this value when the connection closes, which sets the flag.
struct Waiting(Arc<AtomicBool>);

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Returns the route for a request with a body and a slow response. The work ends early if the client leaves.
pub(crate) fn awaited<I: DeserializeOwned + Send + 'static, O: Serialize + 'static>(
    work: fn(&Studio, I, &Asker) -> Result<O, Refusal>,
) -> MethodRouter<Serving> {
    let answer = move |State(serving): State<Serving>, body: Body| async move {
        let asked = match serving.read(body).await {
            Ok(asked) => asked,
            Err(refusal) => return refusal.into_response(),
        };
        let gone = Arc::<AtomicBool>::default();
        let _waiting = Waiting(gone.clone());
        let long = serving.long.clone();
        serving.answer_in(long, move |studio| work(studio, asked, &Asker(gone))).await
    };
    post(answer)
}

/// A request whose response is sent line by line. `page` identifies the page that sent the request, if the request
/// states it.
pub(crate) struct Asked<I> {
    pub(crate) body: I,
    pub(crate) page: Option<String>,
}

/// Returns the route for a request with a body whose response is sent line by line.
pub(crate) fn streamed<I: DeserializeOwned + Send + 'static>(
    work: fn(&Studio, Asked<I>, &Lines) -> Result<(), Ended>,
) -> MethodRouter<Serving> {
    let answer = move |State(serving): State<Serving>, request: Request| async move {
        let page =
            request.headers().get("x-arcade-page").and_then(|page| page.to_str().ok()).map(str::to_owned);
        let body = match serving.read(request.into_body()).await {
            Ok(body) => body,
            Err(refusal) => return refusal.into_response(),
        };
        let Ok(place) = serving.long.clone().try_acquire_owned() else {
            return Refusal::new(StatusCode::TOO_MANY_REQUESTS, "too many computations are running at once")
                .help("wait until some of them are done")
                .into_response();
        };
        let (lines, response) = Lines::new();
        tokio::task::spawn_blocking(move || {
            lines.finish(|lines| work(&serving.studio, Asked { body, page }, lines));
            drop(place);
        });
        response
    };
    post(answer)
}
